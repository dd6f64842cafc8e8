#include "lens_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "rift/vision/camera/camera_model.hpp"

namespace rift::vision {
namespace {

constexpr std::array<const char*, 9> kPlumbBob{"fx", "fy", "cx", "cy", "k1",
                                               "k2", "p1", "p2", "k3"};
constexpr std::array<const char*, 8> kEquidistant{"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};

struct Poses {
  std::vector<cv::Mat> rotations, translations;
};

CameraModel ModelOf(const FitInput& input, Lens lens, const cv::Mat& k, const cv::Mat& distortion,
                    double rms_px) {
  CameraModel camera;
  camera.width_px = input.Size().width;
  camera.height_px = input.Size().height;
  camera.lens = lens;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) camera.k(row, column) = k.at<double>(row, column);
  }
  camera.distortion.assign(distortion.begin<double>(), distortion.end<double>());
  camera.rms_px = rms_px;
  return camera;
}

LensFit FitOf(const FitInput& input, const CameraModel& camera, const cv::Mat& k,
              const cv::Mat& distortion, const Poses& poses) {
  LensFit fit{.camera = camera};
  const auto board = input.BoardPoints();
  const auto pixels = input.Pixels();
  for (std::size_t view = 0; view < pixels.size(); ++view) {
    std::vector<cv::Point2f> predicted;
    const cv::Mat &r = poses.rotations[view], &t = poses.translations[view];
    if (camera.lens == Lens::kPlumbBob) {
      cv::projectPoints(board[view], r, t, k, distortion, predicted);
    } else {
      cv::fisheye::projectPoints(board[view], predicted, r, t, k, distortion);
    }
    auto& residuals = fit.residuals_px.emplace_back();
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      const cv::Point2f difference = pixels[view][i] - predicted[i];
      residuals.emplace_back(difference.x, difference.y);
    }
  }
  return fit;
}

template <std::size_t N>
void Name(LensFit& fit, const std::array<const char*, N>& names, const cv::Mat& deviations) {
  const CameraModel& c = fit.camera;
  std::vector<double> values{c.k(0, 0), c.k(1, 1), c.k(0, 2), c.k(1, 2)};
  values.insert(values.end(), c.distortion.begin(), c.distortion.end());
  for (std::size_t i = 0; i < N && i < values.size(); ++i) {
    const double deviation =
        deviations.empty() ? kNotComputed : deviations.at<double>(static_cast<int>(i));
    fit.parameters.push_back({names[i], values[i], deviation});
  }
}

/// Of the eight parameters of the fisheye, since cv::fisheye::calibrate states none: the inverse of
/// the normal equations, the poses of the board eliminated (Schur complement), times the variance
/// of what is left of a corner's coordinate. Eight rows; empty when they cannot be told apart.
cv::Mat FisheyeDeviations(const FitInput& input, const LensFit& fit, const cv::Mat& k,
                          const cv::Mat& distortion, const Poses& poses) {
  constexpr int kLens = 8, kPose = 6;
  const auto board = input.BoardPoints();
  cv::Mat information = cv::Mat::zeros(kLens, kLens, CV_64F);
  double squares = 0.0;
  int numbers = 0;
  for (std::size_t view = 0; view < board.size(); ++view) {
    std::vector<cv::Point2f> predicted;
    cv::Mat jacobian;  // columns: fx fy, cx cy, k1 to k4, rotation, translation, skew
    cv::fisheye::projectPoints(board[view], predicted, poses.rotations[view],
                               poses.translations[view], k, distortion, 0.0, jacobian);
    const cv::Mat of_lens = jacobian.colRange(0, kLens);
    const cv::Mat of_pose = jacobian.colRange(kLens, kLens + kPose);
    const cv::Mat both = of_lens.t() * of_pose;
    information += of_lens.t() * of_lens -
                   both * cv::Mat(of_pose.t() * of_pose).inv(cv::DECOMP_SVD) * both.t();
    for (const Eigen::Vector2d& residual : fit.residuals_px[view])
      squares += residual.squaredNorm();
    numbers += jacobian.rows - kPose;
  }
  cv::Mat covariance;
  if (numbers <= kLens || cv::invert(information, covariance, cv::DECOMP_CHOLESKY) == 0.0) {
    return {};
  }
  cv::Mat deviations;
  cv::sqrt(covariance.diag() * (squares / (numbers - kLens)), deviations);
  return deviations;
}

LensFit FitPlumbBob(const FitInput& input) {
  cv::Mat k, distortion, intrinsic, extrinsic, errors;
  Poses poses;
  const double rms_px =
      cv::calibrateCamera(input.BoardPoints(), input.Pixels(), input.Size(), k, distortion,
                          poses.rotations, poses.translations, intrinsic, extrinsic, errors);
  LensFit fit = FitOf(input, ModelOf(input, Lens::kPlumbBob, k, distortion.reshape(1, 1), rms_px),
                      k, distortion, poses);
  Name(fit, kPlumbBob, intrinsic);
  return fit;
}

LensFit FitEquidistant(const FitInput& input) {
  cv::Mat k, distortion;
  Poses poses;
  const double rms_px = cv::fisheye::calibrate(
      input.BoardPoints(), input.Pixels(), input.Size(), k, distortion, poses.rotations,
      poses.translations, cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW,
      {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 200, 1e-10});
  LensFit fit =
      FitOf(input, ModelOf(input, Lens::kEquidistant, k, distortion.reshape(1, 1), rms_px), k,
            distortion, poses);
  Name(fit, kEquidistant, FisheyeDeviations(input, fit, k, distortion, poses));
  return fit;
}

/// A lens of which a camera file would be refused is none.
bool IsPlausible(const LensFit& fit) {
  return fit.camera.k.allFinite() && std::isfinite(fit.camera.rms_px) && !WhyNoLens(fit.camera);
}

/// Every corner of a bent board is an unknown: all of them and 24 views take a minute, these do
/// not.
struct Thinned {
  explicit Thinned(const FitInput& input) {
    const auto all_points = input.BoardPoints();
    const auto all_pixels = input.Pixels();
    const auto views = Spread(static_cast<int>(all_pixels.size()), 12);
    for (const int view : views) {
      points.emplace_back();
      pixels.emplace_back();
      for (const int row : Spread(input.board.rows, 5)) {
        for (const int column : Spread(input.board.columns, columns)) {
          const std::size_t corner = static_cast<std::size_t>(row) * input.board.columns + column;
          points.back().push_back(all_points[view][corner]);
          pixels.back().push_back(all_pixels[view][corner]);
        }
      }
    }
    columns = std::min(columns, input.board.columns);
  }

  std::vector<std::vector<cv::Point3f>> points;
  std::vector<std::vector<cv::Point2f>> pixels;
  int columns = 7;

 private:
  // At most `most` of `count` indices, the first and the last among them.
  static std::vector<int> Spread(int count, int most) {
    const int kept = std::min(count, most);
    std::vector<int> indices;
    for (int i = 0; i < kept; ++i) indices.push_back(i * (count - 1) / std::max(1, kept - 1));
    return indices;
  }
};

// Pixel middles on an even grid, half a cell from the edge.
std::vector<Eigen::Vector2d> PixelGrid(const CameraModel& camera) {
  constexpr int kColumns = 12, kRows = 8;
  std::vector<Eigen::Vector2d> pixels;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      pixels.emplace_back((column + 0.5) / kColumns * camera.width_px - 0.5,
                          (row + 0.5) / kRows * camera.height_px - 0.5);
    }
  }
  return pixels;
}

}  // namespace

std::vector<std::vector<cv::Point3f>> FitInput::BoardPoints() const {
  std::vector<cv::Point3f> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(static_cast<float>(column * board.square_m),
                          static_cast<float>(row * board.square_m), 0.0F);
    }
  }
  return std::vector<std::vector<cv::Point3f>>(views.size(), points);
}

std::vector<std::vector<cv::Point2f>> FitInput::Pixels() const {
  std::vector<std::vector<cv::Point2f>> all;
  for (const BoardView* view : views) {
    auto& pixels = all.emplace_back();
    for (const Eigen::Vector2d& corner : view->corners) {
      pixels.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
    }
  }
  return all;
}

double LensFit::ViewRms_px(std::size_t view) const {
  double sum = 0.0;
  for (const Eigen::Vector2d& residual : residuals_px[view]) sum += residual.squaredNorm();
  return std::sqrt(sum / static_cast<double>(residuals_px[view].size()));
}

std::optional<LensFit> FitLens(const FitInput& input, Lens lens) {
  try {
    LensFit fit = lens == Lens::kPlumbBob ? FitPlumbBob(input) : FitEquidistant(input);
    if (IsPlausible(fit)) return fit;
  } catch (const cv::Exception&) {  // its way to say that the fit broke down; the caller says so
  }
  return {};
}

BentFit FitBentBoard(const FitInput& input) {
  const Thinned thin(input);
  cv::Mat k, distortion, bent;
  Poses poses;
  BentFit fit;
  try {
    const int fixed = thin.columns - 1, lu = cv::CALIB_USE_LU;
    fit.flat_px = cv::calibrateCamera(thin.points, thin.pixels, input.Size(), k, distortion,
                                      poses.rotations, poses.translations, lu);
    fit.rms_px = cv::calibrateCameraRO(thin.points, thin.pixels, input.Size(), fixed, k, distortion,
                                       poses.rotations, poses.translations, bent, lu);
  } catch (const cv::Exception&) {  // as above: NaN, and nothing is said about the board
    return fit;
  }
  const cv::Mat points = bent.reshape(1, static_cast<int>(bent.total()));
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(points.col(2), &low, &high);
  fit.bend_m = high - low;
  return fit;
}

double FloorDifference_m(const CameraModel& a, const CameraModel& b, double height_m) {
  const std::vector<Eigen::Vector2d> pixels = PixelGrid(a);
  const std::vector<Eigen::Vector2d> rays_a = RaysFromPixels(a, pixels);
  const std::vector<Eigen::Vector2d> rays_b = RaysFromPixels(b, pixels);
  std::vector<cv::Point3d> floor;
  std::vector<cv::Point2d> seen;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!rays_a[i].allFinite() || !rays_b[i].allFinite()) return kNotComputed;
    floor.emplace_back(rays_a[i].x() * height_m, rays_a[i].y() * height_m, height_m);
    seen.emplace_back(rays_b[i].x(), rays_b[i].y());
  }
  cv::Vec3d turn(0.0, 0.0, 0.0), shift(0.0, 0.0, 0.0);
  if (!cv::solvePnP(floor, seen, cv::Mat::eye(3, 3, CV_64F), cv::noArray(), turn, shift, true)) {
    return kNotComputed;
  }
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  const cv::Vec3d eye = -(rotation.t() * shift);
  double sum = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const cv::Vec3d ray = rotation.t() * cv::Vec3d(seen[i].x, seen[i].y, 1.0);
    const cv::Vec3d hit = eye + ray * ((height_m - eye[2]) / ray[2]);
    sum += std::pow(hit[0] - floor[i].x, 2) + std::pow(hit[1] - floor[i].y, 2);
  }
  return std::sqrt(sum / static_cast<double>(seen.size()));
}

}  // namespace rift::vision
