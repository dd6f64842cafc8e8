#include "rift/odometry/calibration.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/odometry/readings_during.hpp"

namespace rift::odometry {
namespace {

using geometry::Pose2;

/// ln of left radius, right radius and track over those of the start; the tag on the robot: ahead
/// and left of the axle in m, its yaw in rad.
constexpr int kParameters = 6;
enum Index { kLeft, kRight, kTrack, kAhead, kAside, kYaw };
using Vector = Eigen::Matrix<double, kParameters, 1>;
using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

// Wide: they only keep what the runs do not tell from running away.
const Vector kPriorSigma = (Vector() << 0.5, 0.5, 0.5, 0.1, 0.1, 0.3).finished();
constexpr double kTold = 0.05;  // of a value, or of a decimetre
constexpr double kOutlier = 4.0;
constexpr int kMostSteps = 50;
constexpr std::size_t kFewestWindows = kParameters + 2;

/// What the camera saw in one window, and the counts since the one before each sighting.
struct Window {
  struct Rolled {
    double left;  ///< counts
    double right;
  };
  std::vector<Pose2> seen;                  ///< world_from_tag
  std::vector<std::vector<Rolled>> rolled;  ///< readings passed before each sighting
};

/// The counts between two moments, in steps from reading to reading.
std::vector<Window::Rolled> RolledBetween(const std::vector<EncoderReading>& encoders,
                                          double from_s, double to_s) {
  std::vector<Window::Rolled> steps;
  auto last = *CountsAt(encoders, from_s);
  const auto add = [&](double left, double right) {
    steps.push_back({left - last.first, right - last.second});
    last = {left, right};
  };
  auto reading =
      std::upper_bound(encoders.begin(), encoders.end(), from_s,
                       [](double t, const EncoderReading& other) { return t < other.t_s; });
  for (; reading != encoders.end() && reading->t_s < to_s; ++reading) {
    add(static_cast<double>(reading->counts.left), static_cast<double>(reading->counts.right));
  }
  const auto end = *CountsAt(encoders, to_s);
  add(end.first, end.second);
  return steps;
}

bool HasRolled(const Window& window) {
  double counts = 0.0;
  for (const auto& steps : window.rolled) {
    for (const Window::Rolled& step : steps) counts += std::abs(step.left) + std::abs(step.right);
  }
  return counts > 20.0;
}

void AddWindows(const RunLog& run, double window_s, std::vector<Window>& windows) {
  std::vector<const trajectory::StampedPose*> poses;
  for (const trajectory::StampedPose& pose : run.camera.poses) {
    if (std::isfinite(pose.yaw_rad) && CountsAt(run.encoders, pose.t_s)) poses.push_back(&pose);
  }
  for (std::size_t first = 0; first < poses.size();) {
    Window window;
    std::size_t i = first;
    for (; i < poses.size() && poses[i]->t_s < poses[first]->t_s + window_s; ++i) {
      window.seen.push_back(poses[i]->Planar());
      window.rolled.push_back(i == first
                                  ? std::vector<Window::Rolled>()
                                  : RolledBetween(run.encoders, poses[i - 1]->t_s, poses[i]->t_s));
    }
    if (window.seen.size() >= 4 && HasRolled(window)) windows.push_back(std::move(window));
    first = i;
  }
}

/// start_from_tag at each sighting of a window.
std::vector<Pose2> PathOf(const Window& window, const Vector& p, const OdometryOptions& start) {
  const double left_m = std::exp(p[kLeft]) * LeftMetresPerCount(start);
  const double right_m = std::exp(p[kRight]) * RightMetresPerCount(start);
  const double track_m = std::exp(p[kTrack]) * start.drive.track_m;
  const Pose2 robot_from_tag{p[kAhead], p[kAside], p[kYaw]};
  std::vector<Pose2> path;
  Pose2 start_from_robot;
  for (const auto& steps : window.rolled) {
    for (const Window::Rolled& step : steps) {
      const double a_m = left_m * step.left, b_m = right_m * step.right;
      start_from_robot =
          start_from_robot * control::ArcMotion(0.5 * (a_m + b_m), (b_m - a_m) / track_m);
    }
    path.push_back(start_from_robot * robot_from_tag);
  }
  return path;
}

struct Noise {
  double m = 0.002;
  double yaw_rad = 0.02;
};

/// Normal equations of a window with its start taken out, and the step of the start that goes with
/// a step of the parameters.
struct Normal {
  Matrix information = Matrix::Zero();
  Vector score = Vector::Zero();
  Eigen::Matrix<double, 3, kParameters> start_from_p;
  Eigen::Vector3d start_alone = Eigen::Vector3d::Zero();
};

using Residuals = Eigen::VectorXd;  ///< x, y, yaw of each sighting, seen minus explained

Residuals ResidualsOf(const Window& window, const std::vector<Pose2>& path, const Pose2& start) {
  Residuals residuals(3 * static_cast<Eigen::Index>(path.size()));
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Pose2 at = start * path[i];
    const Pose2& seen = window.seen[i];
    residuals.segment<3>(3 * static_cast<Eigen::Index>(i)) << seen.x_m - at.x_m, seen.y_m - at.y_m,
        geometry::WrapToPi(seen.yaw_rad - at.yaw_rad);
  }
  return residuals;
}

/// One over the variance of each residual, less for outliers.
Eigen::VectorXd WeightsOf(const Residuals& residuals, const Noise& noise) {
  Eigen::VectorXd weights(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    const double sigma = i % 3 == 2 ? noise.yaw_rad : noise.m;
    const double off = std::abs(residuals[i]) / sigma;
    weights[i] = (off > kOutlier ? kOutlier / off : 1.0) / (sigma * sigma);
  }
  return weights;
}

Normal NormalOf(const Window& window, const Vector& p, const Pose2& start, const Noise& noise,
                const OdometryOptions& options) {
  constexpr double kStep = 1e-5;
  const std::vector<Pose2> path = PathOf(window, p, options);
  const Residuals residuals = ResidualsOf(window, path, start);
  Eigen::MatrixXd by_p(residuals.size(), kParameters);
  for (int k = 0; k < kParameters; ++k) {
    Vector up = p, down = p;
    up[k] += kStep;
    down[k] -= kStep;
    by_p.col(k) = (ResidualsOf(window, PathOf(window, down, options), start) -
                   ResidualsOf(window, PathOf(window, up, options), start)) /
                  (2.0 * kStep);
  }
  Eigen::MatrixXd by_start = Eigen::MatrixXd::Zero(residuals.size(), 3);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Eigen::Vector2d arm = (start * path[i]).Position() - start.Position();
    const auto row = 3 * static_cast<Eigen::Index>(i);
    by_start.block<3, 3>(row, 0) << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x(), 0.0, 0.0, 1.0;
  }
  const Eigen::VectorXd weights = WeightsOf(residuals, noise);
  const Eigen::Matrix3d ss = by_start.transpose() * weights.asDiagonal() * by_start;
  const Eigen::Matrix<double, 3, kParameters> sp =
      by_start.transpose() * weights.asDiagonal() * by_p;
  const Eigen::Vector3d s = by_start.transpose() * weights.asDiagonal() * residuals;
  const Eigen::LDLT<Eigen::Matrix3d> solver(ss);
  Normal normal;
  normal.start_from_p = solver.solve(sp);
  normal.start_alone = solver.solve(s);
  normal.information =
      by_p.transpose() * weights.asDiagonal() * by_p - sp.transpose() * normal.start_from_p;
  normal.score =
      by_p.transpose() * weights.asDiagonal() * residuals - sp.transpose() * normal.start_alone;
  return normal;
}

class Fit {
 public:
  Fit(std::vector<Window> windows, const OdometryOptions& options)
      : windows_(std::move(windows)), options_(options) {
    for (const Window& window : windows_) starts_.push_back(window.seen.front());
  }

  void Run() {
    for (int step = 0; step < kMostSteps; ++step) {
      const Vector before = p_;
      Improve();
      MeasureNoise();
      if ((p_ - before).norm() < 1e-10 && step > 5) return;
    }
  }

  const Vector& p() const { return p_; }
  const Noise& noise() const { return noise_; }
  std::size_t windows() const { return windows_.size(); }

  /// Of the parameters, by leaving out one window at a time, to first order.
  Matrix Covariance() const {
    Matrix information = Prior();
    std::vector<Normal> normals;
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      normals.push_back(NormalOf(windows_[i], p_, starts_[i], noise_, options_));
      information += normals.back().information;
    }
    Matrix covariance = Matrix::Zero();
    for (const Normal& normal : normals) {
      const Vector moved = (information - normal.information).ldlt().solve(normal.score);
      covariance += moved * moved.transpose();
    }
    const auto n = static_cast<double>(windows_.size());
    return (n - 1.0) / n * covariance;
  }

 private:
  static Matrix Prior() { return kPriorSigma.array().square().inverse().matrix().asDiagonal(); }

  void Improve() {
    Matrix information = Prior();
    Vector score = -Prior() * p_;
    std::vector<Normal> normals;
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      normals.push_back(NormalOf(windows_[i], p_, starts_[i], noise_, options_));
      information += normals.back().information;
      score += normals.back().score;
    }
    const Vector step = information.ldlt().solve(score);
    p_ += step;
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      const Eigen::Vector3d by = normals[i].start_alone - normals[i].start_from_p * step;
      starts_[i] = {starts_[i].x_m + by.x(), starts_[i].y_m + by.y(),
                    geometry::WrapToPi(starts_[i].yaw_rad + by.z())};
    }
  }

  // Medians: outliers must not widen what they are judged by.
  void MeasureNoise() {
    std::vector<double> places_m, yaws_rad;
    for (std::size_t i = 0; i < windows_.size(); ++i) {
      const Residuals residuals =
          ResidualsOf(windows_[i], PathOf(windows_[i], p_, options_), starts_[i]);
      for (Eigen::Index k = 0; k < residuals.size(); ++k) {
        (k % 3 == 2 ? yaws_rad : places_m).push_back(std::abs(residuals[k]));
      }
    }
    constexpr double kLeast_m = 1e-6, kLeast_rad = 1e-6;
    noise_.m =
        std::max(kLeast_m, statistics::kSigmaOfMedianDeviation * statistics::Median(places_m));
    noise_.yaw_rad =
        std::max(kLeast_rad, statistics::kSigmaOfMedianDeviation * statistics::Median(yaws_rad));
  }

  std::vector<Window> windows_;
  const OdometryOptions& options_;
  std::vector<Pose2> starts_;  ///< world_from_start of each window
  Vector p_ = Vector::Zero();
  Noise noise_;
};

}  // namespace

OdometryCalibration CalibrateOdometry(std::span<const RunLog> runs, const OdometryOptions& start,
                                      const CalibrationOptions& options) {
  std::vector<Window> windows;
  for (const RunLog& run : runs) AddWindows(run, options.window_s, windows);
  if (windows.size() < kFewestWindows) {
    throw std::invalid_argument(fmt::format(
        "{} window(s) of {:g} s in which the wheels turned under the camera, and {} are needed: "
        "give longer runs, or a smaller window_s",
        windows.size(), options.window_s, kFewestWindows));
  }
  Fit fit(std::move(windows), start);
  fit.Run();
  const Matrix covariance = fit.Covariance();
  const double t = statistics::StudentQuantile(static_cast<double>(fit.windows() - kParameters),
                                               0.5 * (1.0 + options.confidence));
  const double left_m = std::exp(fit.p()[kLeft]) * LeftMetresPerCount(start);
  const double right_m = std::exp(fit.p()[kRight]) * RightMetresPerCount(start);

  // Of the logarithm of a value, by how it changes with the parameters.
  const auto estimate = [&](double value, const Vector& by_p) {
    const double sigma = std::sqrt(by_p.dot(covariance * by_p));
    return Estimate{
        value, {value * std::exp(-t * sigma), value * std::exp(t * sigma)}, sigma < kTold};
  };
  Vector mean = Vector::Zero(), ratio = Vector::Zero(), track = Vector::Zero();
  mean[kLeft] = left_m / (left_m + right_m);
  mean[kRight] = right_m / (left_m + right_m);
  ratio[kLeft] = -1.0;
  ratio[kRight] = track[kTrack] = 1.0;
  OdometryCalibration found{
      .wheel_radius_m = estimate(
          start.drive.wheel_radius_m * 0.5 * (left_m + right_m) / MetresPerCount(start), mean),
      .right_over_left = estimate(right_m / left_m, ratio),
      .track_m = estimate(std::exp(fit.p()[kTrack]) * start.drive.track_m, track),
      .noise_m = fit.noise().m,
      .noise_yaw_rad = fit.noise().yaw_rad,
      .runs = runs.size(),
      .windows = fit.windows()};
  const double sigma_m = std::sqrt(covariance(kAhead, kAhead));
  const double ahead_m = fit.p()[kAhead];
  found.tag_ahead_m = {
      ahead_m, {ahead_m - t * sigma_m, ahead_m + t * sigma_m}, sigma_m < 0.1 * kTold};
  return found;
}

OdometryOptions OdometryCalibration::Applied(OdometryOptions options) const {
  options.drive.wheel_radius_m = wheel_radius_m.value;
  options.right_over_left = right_over_left.value;
  if (track_m.is_told) options.drive.track_m = track_m.value;
  return options;
}

}  // namespace rift::odometry
