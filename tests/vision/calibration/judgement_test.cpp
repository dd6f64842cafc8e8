// What makes a calibration good, usable or refused, and what is said of it.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>

#include "vision/calibration/lens_fit.hpp"
#include "vision/synthetic_views.hpp"

namespace rift::vision {
namespace {

using synthetic::Views;
using synthetic::WideCamera;

constexpr auto kGood = CalibrationVerdict::kGood, kUsable = CalibrationVerdict::kUsable,
               kRefuse = CalibrationVerdict::kRefuse;
const Board kBoard{.columns = 6, .rows = 4, .square_m = 0.05};

/// Nothing that a fit can be blamed for.
CalibrationOptions Lenient() {
  return {.outlier_px = 100.0,
          .good_views = 6,
          .good_px = 100.0,
          .refuse_px = 100.0,
          .good_floor_m = 1.0,
          .refuse_floor_m = 1.0,
          .good_coverage = 0.0,
          .bent_gain = 0.1};
}

std::vector<BoardView> SixViews() { return Views(WideCamera(), kBoard, 6, 21); }

TEST_CASE("A calibration is good up to each limit, and just beyond it is not for a reason") {
  const std::vector<BoardView> views = SixViews();
  const Calibration found = Calibrate(views, kBoard, Lenient());
  REQUIRE(found.reasons.empty());
  REQUIRE(found.verdict == kGood);
  const std::string error = fmt::format("the error of the corners is {:.2f} px RMS", found.rms_px);
  const std::string floor = fmt::format(
      "it implies {:.1f} mm on a floor 0.87 m away (odd views against even ones: {:.1f} mm)",
      1e3 * found.floor_error_m, 1e3 * found.cross_check_m);
  struct Limit {
    double CalibrationOptions::*key;
    double value;
    CalibrationVerdict beyond;
    std::string says;
  };
  for (const Limit& limit :
       {Limit{&CalibrationOptions::good_px, found.rms_px, kUsable,
              fmt::format("{}, good is {:g}", error, found.rms_px)},
        Limit{&CalibrationOptions::refuse_px, found.rms_px, kRefuse, error + ", good is 100"},
        Limit{&CalibrationOptions::good_floor_m, found.floor_error_m, kUsable,
              fmt::format("{}, good is {:g} mm", floor, 1e3 * found.floor_error_m)},
        Limit{&CalibrationOptions::refuse_floor_m, found.floor_error_m, kRefuse,
              floor + ", good is 1000 mm"}}) {
    CalibrationOptions options = Lenient();
    options.*limit.key = limit.value;
    CHECK(Calibrate(views, kBoard, options).verdict == kGood);
    options.*limit.key = std::nextafter(limit.value, 0.0);
    const Calibration beyond = Calibrate(views, kBoard, options);
    CHECK(beyond.verdict == limit.beyond);
    CHECK(beyond.reasons == std::vector<std::string>{limit.says});
  }
}

TEST_CASE("What coverage lacks is said side by side, each with what to do") {
  CalibrationOptions options = Lenient();
  options.good_coverage = 1.25;  // more than there is
  const Calibration found = Calibrate(SixViews(), kBoard, options);
  const Coverage& covered = found.coverage;
  const auto line = [](const char* name, double share, const char* advice) {
    return fmt::format("coverage in {} is {:.0f} %, good is 125 %: {}", name, 100.0 * share,
                       advice);
  };
  CHECK(found.verdict == kUsable);
  CHECK(found.reasons ==
        std::vector<std::string>{
            line("x", covered.x, "hold the board at the left and right edges too"),
            line("y", covered.y, "hold the board at the upper and lower edges too"),
            line("size", covered.size, "bring the board nearer, until it fills the picture"),
            line("skew", covered.skew,
                 "tilt the board by 40 degrees, one corner nearer than the opposite one")});
  CHECK_FALSE(found.next.text.empty());
  options.good_coverage = std::min({covered.x, covered.y, covered.size, covered.skew});
  const Calibration enough = Calibrate(SixViews(), kBoard, options);
  CHECK(enough.reasons.empty());
  CHECK(enough.next.text.empty());
}

TEST_CASE(
    "The floor error is that of the corners seen from there, and half of what halves differ by") {
  const std::vector<BoardView> views = SixViews();
  CalibrationOptions options = Lenient();
  options.camera_height_m = 2.5;
  const Calibration found = Calibrate(views, kBoard, options);
  const auto odd = FitLens({{&views[0], &views[2], &views[4]}, kBoard}, Lens::kPlumbBob);
  const auto even = FitLens({{&views[1], &views[3], &views[5]}, kBoard}, Lens::kPlumbBob);
  REQUIRE((odd && even));
  CHECK(found.cross_check_m == Approx(FloorDifference_m(odd->camera, even->camera, 2.5)));
  CHECK(found.cross_check_m > 1e-5);
  CHECK(found.floor_error_m ==
        Approx(std::hypot(found.rms_px * 2.5 / found.camera.k(0, 0), 0.5 * found.cross_check_m)));
  // Halves of two views are too few to be fitted.
  const std::vector<BoardView> five(views.begin(), views.end() - 1);
  const Calibration few = Calibrate(five, kBoard, {.good_views = 5, .good_coverage = 0.0});
  CHECK(std::isnan(few.floor_error_m));
  CHECK(few.verdict == kUsable);
  CHECK(few.reasons == std::vector<std::string>{
                           "odd and even views could not be held against each other: too few"});
}

TEST_CASE("As many views as are asked for are enough, and one fewer is said") {
  const std::vector<BoardView> views = SixViews();
  CalibrationOptions options = Lenient();
  options.good_views = 7;
  const Calibration few = Calibrate(views, kBoard, options);
  CHECK(few.verdict == kUsable);
  CHECK(few.reasons == std::vector<std::string>{"only 6 views are used, good ones have 7 or more"});
  options.good_views = options.least_views = 6;
  CHECK(Calibrate(views, kBoard, options).verdict == kGood);
  options.least_views = 7;
  const Calibration none = Calibrate(views, kBoard, options);
  CHECK(none.verdict == kRefuse);
  CHECK(none.camera.width_px == 0);
  CHECK(std::isnan(none.rms_px));
  CHECK(none.reasons ==
        std::vector<std::string>{"only 6 of 6 views can be used, at least 7 are needed",
                                 "no lens model fits the views"});
}

TEST_CASE("Boards that were drawn over are named where their colour is more than the limit") {
  std::vector<BoardView> views = SixViews();
  views[0].coloured = 0.004;
  views[1].coloured = 0.0041;
  views[4].coloured = 1.0;
  const Calibration found = Calibrate(views, kBoard, Lenient());
  CHECK(found.verdict == kUsable);
  CHECK(found.reasons ==
        std::vector<std::string>{"something coloured is drawn over the board's corners in view1, "
                                 "view4: save pictures before drawing on them"});
}

TEST_CASE("A board is called bent where bending explains as much of the error as is asked for") {
  const auto views = Views(WideCamera(), kBoard, 6, 5, {.corner_px = 0.2, .bend_m = 0.002});
  const Calibration found = Calibrate(views, kBoard, Lenient());
  const double gain = found.bent_px / found.flat_px;
  INFO(found.bent_px << " " << found.flat_px);
  REQUIRE((gain > 0.11 && gain < 0.6));
  CalibrationOptions options = Lenient();
  options.bent_gain = 0.999 * gain;
  CHECK(Calibrate(views, kBoard, options).verdict == kGood);
  options.bent_gain = 1.001 * gain;
  const Calibration bent = Calibrate(views, kBoard, options);
  CHECK(bent.verdict == kUsable);
  CHECK(bent.reasons ==
        std::vector<std::string>{fmt::format(
            "the board is not flat: the error falls from {:.2f} to {:.2f} px when it may bend, by "
            "{:.1f} mm: glue it to glass or a plate",
            found.flat_px, found.bent_px, 1e3 * found.bend_m)});
}

/// The first view with six of its 24 corners moved by `by_px`, to the right or down: half of that
/// is the RMS distance.
BoardView Moved(BoardView view, double by_px, const std::string& name) {
  for (std::size_t i = 0; i < 6; ++i) view.corners[4 * i][i % 2] += by_px;
  view.name = name;
  return view;
}

TEST_CASE("A view is a copy of the first one whose corners lie as near as is asked for") {
  std::vector<BoardView> views = Views(WideCamera(), kBoard, 2, 21);
  views.push_back(Moved(views[1], 3.0, "near"));
  views.push_back(Moved(views[0], -4.0, "nearer"));
  const auto copies = [&](double same_px) {
    std::vector<std::string> of;
    for (const ViewResult& result : Calibrate(views, kBoard, {.same_px = same_px}).views) {
      CHECK(result.is_copy == !result.dropped.empty());
      CHECK(result.used == !result.is_copy);
      of.push_back(result.dropped);
    }
    return of;
  };
  using Names = std::vector<std::string>;
  CHECK(copies(1.49) == Names{"", "", "", ""});
  CHECK(copies(1.51) == Names{"", "", "it shows the same as view1", ""});
  CHECK(copies(1.99) == Names{"", "", "it shows the same as view1", ""});
  CHECK(copies(2.01) == Names{"", "", "it shows the same as view1", "it shows the same as view0"});
  views = {views[0], views[0], views[0]};
  CHECK(copies(0.0) == Names{"", "it shows the same as view0", "it shows the same as view0"});
  CHECK(Calibrate(views, kBoard).reasons.front() ==
        "only 1 of 3 views can be used (2 show the same as another), at least 4 are needed");
}

TEST_CASE("Views are of the size that most views with a board have") {
  std::vector<BoardView> views = Views(WideCamera(), kBoard, 5, 21);
  for (const std::size_t i : {1U, 3U}) std::swap(views[i].width_px, views[i].height_px);
  for (int i = 0; i < 4; ++i) {
    views.push_back({"empty", 1080, 1920, BoardMethod::kNone, {}, 0.0, "no chessboard"});
  }
  const Calibration found = Calibrate(views, kBoard);
  for (std::size_t i = 0; i < views.size(); ++i) {
    INFO(i);
    CHECK(found.views[i].used == (i == 0 || i == 2 || i == 4));
    CHECK_FALSE(found.views[i].is_copy);
  }
  CHECK(found.views[1].dropped == "it is 1080x1920, the others 1920x1080");
  CHECK(found.views[5].dropped == "no chessboard");
  CHECK(found.reasons[0] == "view1 is left out: it is 1080x1920, the others 1920x1080");
}

/// Eight views, of which two are off: the sixth by more than the third.
std::vector<BoardView> WithOutliers() {
  std::vector<BoardView> views = Views(WideCamera(), kBoard, 8, 21);
  std::mt19937_64 random(2);
  for (const auto& [view, sigma_px] : {std::pair{2U, 1.5}, {5U, 4.0}}) {
    std::normal_distribution<double> scatter(0.0, sigma_px);
    for (Eigen::Vector2d& corner : views[view].corners) {
      corner += Eigen::Vector2d(scatter(random), scatter(random));
    }
  }
  return views;
}

TEST_CASE(
    "Views far off the others are dropped one by one, the worst first, while enough are left") {
  const std::vector<BoardView> views = WithOutliers();
  const auto dropped = [&](const CalibrationOptions& options) {
    std::vector<std::string> names;
    for (const ViewResult& result : Calibrate(views, kBoard, options).views) {
      CHECK(result.residuals_px.size() == 24);
      if (!result.used) names.push_back(result.view.name);
    }
    return names;
  };
  using Names = std::vector<std::string>;
  CHECK(dropped({}) == Names{"view2", "view5"});
  CHECK(dropped({.least_views = 6}) == Names{"view2", "view5"});
  CHECK(dropped({.least_views = 7}) == Names{"view5"});
  CHECK(dropped({.least_views = 8}) == Names{});
  CHECK(dropped({.outlier_px = 3.0}) == Names{"view5"});
  CHECK(dropped({.outlier_px = 10.0}) == Names{});
  CHECK(dropped({.outlier_factor = 100.0}) == Names{});
  const Calibration found = Calibrate(views, kBoard);
  // The errors of the fit that dropped it: of all eight views.
  const auto all = FitLens(
      {{&views[0], &views[1], &views[2], &views[3], &views[4], &views[5], &views[6], &views[7]},
       kBoard},
      Lens::kPlumbBob);
  REQUIRE(all);
  std::vector<double> errors_px;
  for (std::size_t i = 0; i < 8; ++i) errors_px.push_back(all->ViewRms_px(i));
  std::sort(errors_px.begin(), errors_px.end());
  CHECK(found.views[5].dropped ==
        fmt::format("outlier: its error is {:.2f} px, the median {:.2f} px", errors_px[7],
                    0.5 * (errors_px[3] + errors_px[4])));
  CHECK(found.views[5].rms_px > found.views[2].rms_px);
  CHECK(found.views[2].rms_px > 5.0 * found.views[0].rms_px);
}

TEST_CASE(
    "The fisheye is taken where its error is so many times less, with its own views' errors") {
  CameraModel truth = WideCamera();
  truth.lens = Lens::kEquidistant;
  truth.k << 620.0, 0.0, 955.0, 0.0, 622.0, 545.0, 0.0, 0.0, 1.0;
  truth.distortion = {0.02, -0.01, 0.004, -0.001};
  const auto views = Views(truth, kBoard, 7, 11, {.corner_px = 0.02});
  CalibrationOptions options = Lenient();
  const Calibration fisheye = Calibrate(views, kBoard, options);
  const double gain = fisheye.equidistant_px / fisheye.plumb_bob_px;
  REQUIRE((gain > 0.1 && gain < 0.9));
  for (const bool takes_fisheye : {true, false}) {
    options.fisheye_gain = (takes_fisheye ? 1.001 : 0.999) * gain;
    const Calibration found = Calibrate(views, kBoard, options);
    CHECK(found.camera.lens == (takes_fisheye ? Lens::kEquidistant : Lens::kPlumbBob));
    CHECK(found.rms_px == (takes_fisheye ? found.equidistant_px : found.plumb_bob_px));
    double squares = 0.0;
    for (const ViewResult& result : found.views) squares += std::pow(result.rms_px, 2) / 7.0;
    CHECK(std::sqrt(squares) == Approx(found.rms_px).epsilon(1e-3));
  }
}

TEST_CASE("The fisheye is not taken where it fits fewer views") {
  CameraModel truth = WideCamera();
  truth.lens = Lens::kEquidistant;
  truth.k << 620.0, 0.0, 955.0, 0.0, 622.0, 545.0, 0.0, 0.0, 1.0;
  truth.distortion = {0.02, -0.01, 0.004, -0.001};
  auto views = Views(truth, kBoard, 7, 11, {.corner_px = 0.001});
  std::mt19937_64 random(2);
  std::normal_distribution<double> scatter(0.0, 0.018);
  for (Eigen::Vector2d& corner : views[3].corners) {
    corner += Eigen::Vector2d(scatter(random), scatter(random));
  }
  CalibrationOptions options = Lenient();
  options.outlier_px = 0.02;
  options.fisheye_gain = 1.0;
  const Calibration found = Calibrate(views, kBoard, options);
  // Beside the errors that the plumb bob makes of all views the noise of one does not stand out.
  CHECK(found.equidistant_px < 0.01);
  CHECK(found.plumb_bob_px > 0.01);
  CHECK(found.camera.lens == Lens::kPlumbBob);
  for (const ViewResult& result : found.views) CHECK(result.used);
  options.outlier_px = 100.0;
  CHECK(Calibrate(views, kBoard, options).camera.lens == Lens::kEquidistant);
}

TEST_CASE("Boards that are seen as a single point fit no lens, and are refused for that") {
  std::vector<BoardView> views = SixViews();
  for (BoardView& view : views) view.corners.assign(view.corners.size(), view.corners.front());
  const Calibration found = Calibrate(views, kBoard, Lenient());
  CHECK(found.verdict == kRefuse);
  CHECK(found.reasons == std::vector<std::string>{"no lens model fits the views"});
  CHECK(found.camera.width_px == 0);
  CHECK(std::isnan(found.rms_px));
  CHECK((std::isnan(found.plumb_bob_px) && std::isnan(found.equidistant_px)));
}

}  // namespace
}  // namespace rift::vision
