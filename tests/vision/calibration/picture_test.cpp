#include <catch2/catch.hpp>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "rift/vision/calibration/calibration.hpp"
#include "support/pinned_picture.hpp"
#include "support/processes/process.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

/// Four by three corners from `at` along a slanted grid, each with an error of its own.
ViewResult Seen(const std::string& name, const Eigen::Vector2d& at, double rms_px) {
  ViewResult result{.view = {.name = name, .width_px = 1920, .height_px = 1080}, .used = true};
  for (int i = 0; i < 12; ++i) {
    const int row = i / 4, column = i % 4;
    result.view.corners.emplace_back(at.x() + 90.0 * column + 10.0 * row, at.y() + 80.0 * row);
    result.residuals_px.emplace_back(rms_px * std::cos(i), rms_px * std::sin(2.0 * i));
  }
  result.rms_px = rms_px;
  return result;
}

std::string DifferenceOf(const Calibration& calibration, const std::string& name) {
  const test::TemporaryFolder folder;
  DrawCalibration(calibration, folder / "drawn.png");
  return test::DifferenceFromPinnedPicture("vision/" + name, cv::imread(folder / "drawn.png"));
}

TEST_CASE("The picture of a calibration is the pinned one") {
  Calibration calibration;
  calibration.verdict = CalibrationVerdict::kGood;
  calibration.camera.lens = Lens::kEquidistant;
  calibration.rms_px = 0.42;
  calibration.floor_error_m = 0.00123;
  calibration.coverage = {.x = 0.3, .y = 0.95, .size = 0.05, .skew = 0.6, .picture = 0.5};
  calibration.views = {Seen("a.jpg", {100.0, 80.0}, 0.2),
                       Seen("a name of more than twenty-two letters", {1300.0, 700.0}, 0.5),
                       Seen("left out", {900.0, 300.0}, 1.5),
                       {.view = {.name = "black", .width_px = 1920, .height_px = 1080}}};
  calibration.views[2].used = false;
  CHECK(DifferenceOf(calibration, "calibration.png") == "");
}

TEST_CASE("Without a fit every corner is drawn, without errors, and 26 views have a bar") {
  Calibration refused;
  refused.coverage.picture = 1.4;
  for (int i = 0; i < 30; ++i) {
    ViewResult& result = refused.views.emplace_back(
        Seen("view" + std::to_string(i), {25.0 + 10.0 * i, 20.0 * i}, 0.0));
    result.view.width_px = result.view.height_px = 800;  // taller than the map has room for
    result.rms_px = kNotComputed;
    if (i % 2 == 0) result.residuals_px.clear();
    result.used = i % 3 != 0;
  }
  CHECK(DifferenceOf(refused, "calibration_refused.png") == "");
  CHECK(DifferenceOf({}, "calibration_empty.png") == "");
}

TEST_CASE("A picture that cannot be written is refused with its name and what it must be") {
  const test::TemporaryFolder folder;
  for (const char* name : {"drawn.txt", "none/drawn.png"}) {
    CHECK_THROWS_WITH(DrawCalibration({}, folder / name),
                      Contains(name) && Contains("it must end in .png or .jpg"));
  }
}

TEST_CASE("A picture says whether the error on the floor is known") {
  Calibration calibration;
  calibration.rms_px = 0.42;
  const test::TemporaryFolder folder;
  DrawCalibration(calibration, folder / "drawn.png");
  const cv::Rect words(0, 40, 760, 24);
  const cv::Mat drawn = cv::imread(folder / "drawn.png")(words);
  cv::Mat expected(drawn.size(), drawn.type(), drawn.at<cv::Vec3b>(0, 0));
  cv::putText(expected, "plumb_bob lens, 0.42 px RMS, error on the floor not known", {20, 15},
              cv::FONT_HERSHEY_SIMPLEX, 0.45, {40, 36, 32}, 1, cv::LINE_AA);
  CHECK(cv::norm(drawn, expected, cv::NORM_INF) == 0.0);
}

TEST_CASE("A picture of a calibration has the colours of its legend, to the last grey value") {
  Calibration calibration;
  calibration.coverage.x = 1.0;
  calibration.views = {Seen("left out", {900.0, 300.0}, 1.5)};
  calibration.views[0].used = false;
  const test::TemporaryFolder folder;
  DrawCalibration(calibration, folder / "drawn.png");
  const cv::Mat drawn = cv::imread(folder / "drawn.png");
  const auto at = [&](int x, int y) { return drawn.at<cv::Vec3b>(y, x); };
  CHECK(at(5, 5) == cv::Vec3b(252, 252, 252));    // paper
  CHECK(at(20, 70) == cv::Vec3b(170, 165, 160));  // the frame of the map, and what is in it
  CHECK(at(25, 75) == cv::Vec3b(240, 238, 236));
  CHECK(at(1002, 80) == cv::Vec3b(90, 160, 60));   // the bar of x
  CHECK(at(1002, 234) == cv::Vec3b(50, 60, 210));  // of the view that is left out
}

}  // namespace
}  // namespace rift::vision
