#include "vision/calibration/lens_fit.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>

#include "vision/synthetic_views.hpp"

namespace rift::vision {
namespace {

using synthetic::Views;
using synthetic::WideCamera;

FitInput InputOf(const std::vector<BoardView>& views, const Board& board) {
  FitInput input{.board = board};
  for (const BoardView& view : views) input.views.push_back(&view);
  return input;
}

TEST_CASE("A fit is given the corners row by row, on the board and in the picture") {
  BoardView view{.width_px = 640, .height_px = 480};
  for (int i = 0; i < 12; ++i) view.corners.emplace_back(10.0 * i, 7.0 * i);
  const FitInput input{{&view, &view}, {.columns = 4, .rows = 3, .square_m = 0.5}};
  CHECK(input.Size() == cv::Size(640, 480));
  const auto board = input.BoardPoints();
  const auto pixels = input.Pixels();
  REQUIRE((board.size() == 2 && pixels.size() == 2));
  REQUIRE((board[1].size() == 12 && pixels[1].size() == 12));
  CHECK(board[1][3] == cv::Point3f(1.5F, 0.0F, 0.0F));
  CHECK(board[1][4] == cv::Point3f(0.0F, 0.5F, 0.0F));
  CHECK(board[1][11] == cv::Point3f(1.5F, 1.0F, 0.0F));
  CHECK(pixels[1][11] == cv::Point2f(110.0F, 77.0F));
}

TEST_CASE("The error of a view is the root of its mean squared distance") {
  const LensFit fit{
      .residuals_px = {{{9.0, 9.0}}, {{3.0, 4.0}, {0.0, 1.0}, {-2.0, 0.0}, {0.0, 0.0}}}};
  CHECK(fit.ViewRms_px(1) == Approx(std::sqrt(30.0 / 4.0)));
}

TEST_CASE("What is left of a corner is where it was seen less where it should be") {
  const Lens lens = GENERATE(Lens::kPlumbBob, Lens::kEquidistant);
  const Board board{.columns = 6, .rows = 5, .square_m = 0.04};
  CameraModel truth = WideCamera();
  truth.lens = lens;
  truth.distortion = lens == Lens::kPlumbBob ? std::vector<double>{-0.1, 0.02, 0.0, 0.0, 0.0}
                                             : std::vector<double>{0.02, -0.01, 0.0, 0.0};
  std::vector<BoardView> views = Views(truth, board, 6, 3, {.corner_px = 0.0});
  views[2].corners[13] += Eigen::Vector2d(3.0, -1.0);
  const auto fit = FitLens(InputOf(views, board), lens);
  REQUIRE(fit);
  CHECK(fit->camera.lens == lens);
  CHECK((fit->camera.width_px == 1920 && fit->camera.height_px == 1080));
  REQUIRE((fit->residuals_px.size() == 6 && fit->residuals_px[2].size() == 30));
  CHECK((fit->residuals_px[2][13] - Eigen::Vector2d(3.0, -1.0)).norm() < 0.8);
  CHECK(fit->residuals_px[1][13].norm() < 0.3);
  double squares = 0.0;
  for (std::size_t i = 0; i < 6; ++i) squares += std::pow(fit->ViewRms_px(i), 2) / 6.0;
  CHECK(fit->camera.rms_px == Approx(std::sqrt(squares)).epsilon(1e-3));
}

/// Of the board's middle in a view; the board turned about it.
struct Posed {
  std::array<double, 6> numbers;  ///< turn about x, y, z, then place

  std::vector<Eigen::Vector3d> Points(const Board& board) const {
    const Eigen::Matrix3d turn = (Eigen::AngleAxisd(numbers[2], Eigen::Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(numbers[1], Eigen::Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(numbers[0], Eigen::Vector3d::UnitX()))
                                     .toRotationMatrix();
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < board.Corners(); ++i) {
      const Eigen::Vector3d p(i % board.columns - 0.5 * (board.columns - 1),
                              i / board.columns - 0.5 * (board.rows - 1), 0.0);
      points.push_back(turn * p * board.square_m +
                       Eigen::Vector3d(numbers[3], numbers[4], numbers[5]));
    }
    return points;
  }
};

/// A camera and the boards before it, and what its lens is known to.
struct Experiment {
  CameraModel camera;
  Board board{.columns = 7, .rows = 6, .square_m = 0.04};
  std::vector<Posed> poses;

  std::vector<double*> Unknowns() {
    std::vector<double*> all{&camera.k(0, 0), &camera.k(1, 1), &camera.k(0, 2), &camera.k(1, 2)};
    for (double& d : camera.distortion) all.push_back(&d);
    for (Posed& pose : poses) {
      for (double& number : pose.numbers) all.push_back(&number);
    }
    return all;
  }
  /// Its views, each corner scattered by `sigma_px` along x and y.
  std::vector<BoardView> Seen(double sigma_px, std::mt19937_64& random) const {
    std::normal_distribution<double> scatter(0.0, sigma_px);
    std::vector<BoardView> views;
    for (const Posed& pose : poses) {
      BoardView& view = views.emplace_back(BoardView{.width_px = 1920, .height_px = 1080});
      view.corners = PixelsFromPoints(camera, pose.Points(board));
      for (Eigen::Vector2d& p : view.corners) {
        p += Eigen::Vector2d(scatter(random), scatter(random));
      }
    }
    return views;
  }
  Eigen::VectorXd Pixels() const {
    Eigen::VectorXd all(2 * board.Corners() * static_cast<Eigen::Index>(poses.size()));
    Eigen::Index at = 0;
    for (const Posed& pose : poses) {
      for (const Eigen::Vector2d& p : PixelsFromPoints(camera, pose.Points(board))) {
        all.segment<2>(2 * at++) = p;
      }
    }
    return all;
  }
  /// Deviations of the lens's numbers for corners that scatter by `sigma_px`: the inverse of the
  /// whole normal equations, by differences.
  std::vector<double> Deviations(double sigma_px) {
    const std::vector<double*> unknowns = Unknowns();
    Eigen::MatrixXd jacobian(Pixels().size(), unknowns.size());
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const double was = *unknowns[i], step = 1e-5 * std::max(1.0, std::abs(was));
      *unknowns[i] = was + step;
      const Eigen::VectorXd more = Pixels();
      *unknowns[i] = was - step;
      jacobian.col(static_cast<Eigen::Index>(i)) = (more - Pixels()) / (2.0 * step);
      *unknowns[i] = was;
    }
    const Eigen::MatrixXd covariance = (jacobian.transpose() * jacobian).inverse();
    std::vector<double> deviations;
    for (Eigen::Index i = 0; i < 4 + static_cast<Eigen::Index>(camera.distortion.size()); ++i) {
      deviations.push_back(sigma_px * std::sqrt(covariance(i, i)));
    }
    return deviations;
  }
};

TEST_CASE("The numbers of a lens are named and known as well as the corners' scatter says") {
  const Lens lens = GENERATE(Lens::kPlumbBob, Lens::kEquidistant);
  constexpr double kSigma_px = 0.05;
  Experiment truth{.camera = WideCamera()};
  truth.camera.lens = lens;
  truth.camera.k << 620.0, 0.0, 955.0, 0.0, 640.0, 545.0, 0.0, 0.0, 1.0;
  if (lens == Lens::kEquidistant) truth.camera.distortion = {0.02, -0.01, 0.004, -0.001};
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 9; ++i) {
    truth.poses.push_back({{0.6 * u(random), 0.6 * u(random), 0.4 * u(random), 0.2 * u(random),
                            0.1 * u(random), 0.3 + 0.05 * u(random)}});
  }
  const std::vector<BoardView> views = truth.Seen(kSigma_px, random);
  const auto fit = FitLens(InputOf(views, truth.board), lens);
  REQUIRE(fit);
  const std::vector<double> expected = truth.Deviations(kSigma_px);
  const std::vector<std::string> names =
      lens == Lens::kPlumbBob
          ? std::vector<std::string>{"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"}
          : std::vector<std::string>{"fx", "fy", "cx", "cy", "k1", "k2", "k3", "k4"};
  const std::vector<double*> exact = truth.Unknowns();
  REQUIRE(fit->parameters.size() == names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    const ParameterEstimate& found = fit->parameters[i];
    INFO(found.name << " " << found.value << " +- " << found.deviation << ", expected +- "
                    << expected[i]);
    CHECK(found.name == names[i]);
    CHECK(std::abs(found.value - *exact[i]) < 4.0 * expected[i]);
    // OpenCV takes a corner for one number and so finds the scatter of two in it.
    const double as_stated = lens == Lens::kPlumbBob ? std::sqrt(2.0) : 1.0;
    CHECK(found.deviation == Approx(as_stated * expected[i]).epsilon(0.1));
  }
}

TEST_CASE("Of few corners the scatter is told from what the unknowns have left of it") {
  const Lens lens = GENERATE(Lens::kPlumbBob, Lens::kEquidistant);
  Experiment truth{.camera = WideCamera(), .board = {.columns = 5, .rows = 4, .square_m = 0.06}};
  truth.camera.lens = lens;
  if (lens == Lens::kEquidistant) truth.camera.distortion = {0.02, -0.01, 0.004, -0.001};
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (int i = 0; i < 5; ++i) {
    truth.poses.push_back({{0.6 * u(random), 0.6 * u(random), 0.4 * u(random), 0.1 * u(random),
                            0.05 * u(random), 0.3 + 0.05 * u(random)}});
  }
  const std::vector<BoardView> views = truth.Seen(0.01, random);
  const auto fit = FitLens(InputOf(views, truth.board), lens);
  REQUIRE(fit);
  double squares = 0.0;
  for (const auto& of_view : fit->residuals_px) {
    for (const Eigen::Vector2d& residual : of_view) squares += residual.squaredNorm();
  }
  // Of 100 corners; OpenCV takes each for one number, cv::fisheye's scatter is ours.
  const double numbers = lens == Lens::kPlumbBob ? 100.0 : 200.0;
  const double unknowns = 5.0 * 6.0 + static_cast<double>(fit->parameters.size());
  const std::vector<double> of_one_px = truth.Deviations(1.0);
  for (std::size_t i = 0; i < fit->parameters.size(); ++i) {
    INFO(fit->parameters[i].name);
    CHECK(fit->parameters[i].deviation ==
          Approx(std::sqrt(squares / (numbers - unknowns)) * of_one_px[i]).epsilon(0.015));
  }
}

TEST_CASE("Views that no camera sees are no fit") {
  const Board board{.columns = 5, .rows = 4, .square_m = 0.04};
  std::vector<BoardView> views(4, BoardView{.width_px = 640, .height_px = 480});
  for (BoardView& view : views) {
    for (int i = 0; i < board.Corners(); ++i) view.corners.emplace_back(100.0, 100.0);
  }
  CHECK_FALSE(FitLens(InputOf(views, board), Lens::kPlumbBob));
  CHECK_FALSE(FitLens(InputOf(views, board), Lens::kEquidistant));
}

TEST_CASE("A lens whose file would be refused for either focal length is no fit") {
  const Board board{.columns = 6, .rows = 5, .square_m = 0.04};
  const auto is_fit = [&](double fx, double fy) {
    CameraModel truth{.width_px = 640, .height_px = 480};
    truth.k << fx, 0.0, 320.0, 0.0, fy, 240.0, 0.0, 0.0, 1.0;
    truth.distortion.assign(4, 0.0);
    std::vector<BoardView> views;
    for (const auto& [tilt, lean] : {std::pair{0.5, 0.1}, {-0.5, 0.2}, {0.1, 0.5}, {-0.2, -0.5}}) {
      // About its middle some 300 px wide.
      const Posed pose{{tilt, lean, 0.1, 0.0, 0.0, 0.2 * fx / 300.0}};
      BoardView& view = views.emplace_back(BoardView{.width_px = 640, .height_px = 480});
      view.corners = PixelsFromPoints(truth, pose.Points(board));
    }
    const bool is_found = FitLens(InputOf(views, board), Lens::kPlumbBob).has_value();
    CHECK(is_found == !WhyNoLens(truth));
    return is_found;
  };
  CHECK(is_fit(66.0, 66.0));
  CHECK_FALSE(is_fit(62.0, 66.0));
  CHECK_FALSE(is_fit(66.0, 62.0));
  CHECK(is_fit(60e3, 60e3));
  CHECK_FALSE(is_fit(70e3, 60e3));
  CHECK_FALSE(is_fit(60e3, 70e3));
}

TEST_CASE("A board that bends is measured with how far its corners leave their plane") {
  const Board board{.columns = 7, .rows = 5, .square_m = 0.04};
  const auto views = Views(WideCamera(), board, 8, 6, {.corner_px = 0.0, .bend_m = 0.004});
  const BentFit fit = FitBentBoard(InputOf(views, board));
  CHECK(fit.bend_m == Approx(0.004).epsilon(0.01));
  CHECK(fit.rms_px < 0.01);
  // Of so few corners none is left out: the flat fit is that of the lens.
  const auto flat = FitLens(InputOf(views, board), Lens::kPlumbBob);
  REQUIRE(flat);
  CHECK(flat->camera.rms_px > 0.1);
  CHECK(fit.flat_px == Approx(flat->camera.rms_px).epsilon(0.01));
}

TEST_CASE("A board of few columns bends as far as one of many") {
  const Board board{.columns = 5, .rows = 4, .square_m = 0.06};
  const auto views = Views(WideCamera(), board, 8, 6, {.corner_px = 0.0, .bend_m = 0.004});
  const BentFit fit = FitBentBoard(InputOf(views, board));
  CHECK(fit.bend_m == Approx(0.004).epsilon(0.01));
  CHECK(fit.rms_px < 0.01);
}

TEST_CASE("Of many views and corners every part is still looked at, their ends among them") {
  const Board board{.columns = 13, .rows = 9, .square_m = 0.025};
  const std::vector<BoardView> exact = Views(WideCamera(), board, 14, 6, {.corner_px = 0.0});
  // Twelve of fourteen views, five of nine rows and seven of thirteen columns, evenly.
  const auto is_looked_at = [](std::size_t view, int corner) {
    return view != 6 && view != 12 && (corner / 13) % 2 == 0 && (corner % 13) % 2 == 0;
  };
  std::vector<BoardView> elsewhere = exact;
  for (std::size_t view = 0; view < exact.size(); ++view) {
    for (int i = 0; i < board.Corners(); ++i) {
      if (!is_looked_at(view, i)) elsewhere[view].corners[static_cast<std::size_t>(i)].x() += 20.0;
    }
  }
  CHECK(FitBentBoard(InputOf(elsewhere, board)).flat_px < 0.02);
  for (const auto& [view, corner] :
       {std::pair<std::size_t, std::size_t>{0, 12}, {13, 0}, {7, 116}, {5, 4 * 13 + 6}}) {
    std::vector<BoardView> off = exact;
    off[view].corners[corner].y() += 5.0;
    INFO(view << " " << corner);
    // One of 12 * 5 * 7 corners.
    CHECK(FitBentBoard(InputOf(off, board)).flat_px ==
          Approx(5.0 / std::sqrt(12.0 * 35.0)).epsilon(0.15));
  }
}

TEST_CASE("Two lenses differ on the floor by what no other height takes away") {
  CameraModel a{.width_px = 600, .height_px = 400};
  a.k << 500.0, 0.0, 299.5, 0.0, 500.0, 199.5, 0.0, 0.0, 1.0;
  CameraModel b = a;
  CHECK(FloorDifference_m(a, b, 0.8) == Approx(0.0).margin(1e-9));
  b.k.topLeftCorner<2, 2>() *= 1.1;  // as one that hangs a tenth higher
  CHECK(FloorDifference_m(a, b, 0.8) == Approx(0.0).margin(1e-6));
  b = a;
  b.distortion = {0.05, 0.0, 0.0, 0.0};
  // On 12 by 8 pixels half a cell from the edge; about the middle no turn or shift helps either.
  std::vector<Eigen::Vector2d> rays_a, rays_b;
  for (int row = 0; row < 8; ++row) {
    for (int column = 0; column < 12; ++column) {
      const Eigen::Vector2d pixel(50.0 * column + 24.5, 50.0 * row + 24.5);
      rays_a.push_back((pixel - Eigen::Vector2d(299.5, 199.5)) / 500.0);
      rays_b.push_back(RaysFromPixels(b, {pixel}).front());
    }
  }
  double ab = 0.0, aa = 0.0;
  for (std::size_t i = 0; i < rays_a.size(); ++i) {
    ab += rays_a[i].dot(rays_b[i]);
    aa += rays_a[i].squaredNorm();
  }
  double squares = 0.0;
  for (std::size_t i = 0; i < rays_a.size(); ++i) {
    squares += (rays_b[i] / (ab / aa) - rays_a[i]).squaredNorm() / 96.0;
  }
  CHECK(FloorDifference_m(a, b, 0.8) == Approx(0.8 * std::sqrt(squares)).epsilon(1e-3));
  CHECK(FloorDifference_m(a, b, 0.4) == Approx(0.4 * std::sqrt(squares)).epsilon(1e-3));
  // Turned by a hundredth of a radian one sees the floor elsewhere; another pose takes that away.
  b = a;
  for (const auto& [x_px, y_px] : {std::pair{5.0, 0.0}, {-5.0, 0.0}, {0.0, 5.0}, {4.0, -3.0}}) {
    b.k(0, 2) = a.k(0, 2) + x_px;
    b.k(1, 2) = a.k(1, 2) + y_px;
    CHECK(FloorDifference_m(a, b, 0.8) < 0.2 * 0.01 * 0.8);
  }
  // A decentred lens bends squares as a camera does that leans: another pose takes more than two
  // thirds of it away, in the longer direction of the picture five sixths.
  for (const auto& [p1, p2, left] :
       {std::tuple{0.02, 0.0, 0.33}, {-0.02, 0.0, 0.33}, {0.0, 0.02, 0.17}, {0.0, -0.02, 0.17}}) {
    b = a;
    b.distortion = {0.0, 0.0, p1, p2};
    double plain = 0.0;
    for (std::size_t i = 0; i < rays_a.size(); ++i) {
      const Eigen::Vector2d pixel = 500.0 * rays_a[i] + Eigen::Vector2d(299.5, 199.5);
      plain += (RaysFromPixels(b, {pixel}).front() - rays_a[i]).squaredNorm() / 96.0;
    }
    CHECK(FloorDifference_m(a, b, 0.8) < left * 0.8 * std::sqrt(plain));
  }
  b.k(0, 0) = std::nan("");
  CHECK(std::isnan(FloorDifference_m(a, b, 0.8)));
}

}  // namespace
}  // namespace rift::vision
