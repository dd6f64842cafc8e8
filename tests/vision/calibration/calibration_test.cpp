#include "rift/vision/calibration/calibration.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "support/processes/process.hpp"
#include "support/tree.hpp"
#include "vision/synthetic_views.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;
using synthetic::Views;
using synthetic::WideCamera;

const Board kBoard{13, 9, 0.025};

std::string All(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST_CASE("A camera is recovered from its views and called good") {
  const CameraModel truth = WideCamera();
  const Calibration found = Calibrate(Views(truth, kBoard, 24, 7), kBoard);
  INFO(All(found.reasons));
  CHECK(found.verdict == CalibrationVerdict::kGood);
  CHECK(found.reasons.empty());
  CHECK(found.camera.lens == Lens::kPlumbBob);
  CHECK(found.rms_px == Approx(0.1 * std::sqrt(2.0)).epsilon(0.1));
  CHECK(found.camera.k(0, 0) == Approx(truth.k(0, 0)).epsilon(1e-3));
  CHECK(found.floor_error_m < 0.3e-3);
  REQUIRE(found.parameters.size() == 9);
  const std::vector<double> exact{1100.0, 1105.0, 940.0, 560.0, -0.12, 0.05, 0.001, -0.0005, 0.0};
  for (std::size_t i = 0; i < exact.size(); ++i) {
    INFO(found.parameters[i].name);
    CHECK(std::abs(found.parameters[i].value - exact[i]) < 4.0 * found.parameters[i].deviation);
  }
}

TEST_CASE("A view far off the others is dropped and named") {
  std::vector<BoardView> views = Views(WideCamera(), kBoard, 14, 3);
  std::mt19937_64 random(1);
  std::normal_distribution<double> scatter(0.0, 6.0);
  for (Eigen::Vector2d& corner : views[5].corners) {
    corner += Eigen::Vector2d(scatter(random), scatter(random));
  }
  const Calibration found = Calibrate(views, kBoard);
  CHECK_FALSE(found.views[5].used);
  CHECK_THAT(found.views[5].dropped, Contains("outlier"));
  CHECK(found.verdict == CalibrationVerdict::kUsable);
  CHECK_THAT(All(found.reasons), Contains("view5 is left out"));
  CHECK(found.rms_px < 0.2);
}

TEST_CASE("A picture without a board says why, where no other has one either") {
  const BoardView black{.name = "a", .problem = "the picture is black"};
  for (const int with_board : {0, 1}) {
    std::vector<BoardView> views = Views(WideCamera(), kBoard, with_board, 2);
    views.push_back(black);
    CHECK_THAT(All(Calibrate(views, kBoard).reasons),
               Contains("a is left out: the picture is black\n"));
  }
}

TEST_CASE("One to three views are refused with what to do next, and drawn all the same") {
  const int count = GENERATE(0, 1, 2, 3);
  const Calibration found = Calibrate(Views(WideCamera(), kBoard, count, 2), kBoard);
  CHECK(found.verdict == CalibrationVerdict::kRefuse);
  CHECK_THAT(All(found.reasons), Contains("at least 4 are needed"));
  CHECK_THAT(found.next.text, Contains("hold the board"));
  const test::TemporaryFolder folder;
  DrawCalibration(found, folder / "few.png");
  CHECK(std::filesystem::file_size(folder / "few.png") > 1000);
}

TEST_CASE("Copies of one picture count as one") {
  const std::vector<BoardView> views(13, Views(WideCamera(), kBoard, 1, 2).front());
  const Calibration found = Calibrate(views, kBoard);
  CHECK(found.verdict == CalibrationVerdict::kRefuse);
  CHECK_THAT(All(found.reasons), Contains("only 1 of 13 views") && Contains("12 show the same"));
  // Beside enough others a copy is no blemish.
  std::vector<BoardView> good = Views(WideCamera(), kBoard, 24, 7);
  good.push_back(good.front());
  CHECK(Calibrate(good, kBoard).verdict == CalibrationVerdict::kGood);
}

TEST_CASE("The next view is where the board is missing") {
  std::vector<ViewResult> left;
  for (BoardView& view : Views(WideCamera(), kBoard, 24, 7)) {
    if (PlaceOf(view, kBoard).x < 0.5) left.push_back({.view = view, .used = true});
  }
  REQUIRE(left.size() > 3);
  const NextView next = NextViewFor(left, kBoard, 0.75);
  CHECK(next.place.x > 0.9);
  CHECK_THAT(next.text, Contains("right"));
}

TEST_CASE("A fisheye lens is told from an ordinary one") {
  CameraModel truth = WideCamera();
  truth.lens = Lens::kEquidistant;
  truth.k << 620.0, 0.0, 955.0, 0.0, 622.0, 545.0, 0.0, 0.0, 1.0;
  truth.distortion = {0.02, -0.01, 0.004, -0.001};
  const Calibration found = Calibrate(Views(truth, kBoard, 20, 11), kBoard);
  INFO(All(found.reasons));
  CHECK(found.camera.lens == Lens::kEquidistant);
  CHECK(found.equidistant_px < 0.2);
  CHECK(found.plumb_bob_px > found.equidistant_px / 0.9);
  CHECK(found.camera.k(0, 0) == Approx(620.0).epsilon(2e-3));
  const std::vector<double> exact{620.0, 622.0, 955.0, 545.0, 0.02, -0.01, 0.004, -0.001};
  REQUIRE(found.parameters.size() == exact.size());
  for (std::size_t i = 0; i < exact.size(); ++i) {
    INFO(found.parameters[i].name << " " << found.parameters[i].deviation);
    CHECK(found.parameters[i].deviation > 0.0);
    CHECK(std::abs(found.parameters[i].value - exact[i]) < 4.0 * found.parameters[i].deviation);
  }
}

TEST_CASE("A board that is not flat is named with how far it bends") {
  const Calibration found = Calibrate(Views(WideCamera(), kBoard, 16, 5, {0.1, 0.003}), kBoard);
  CHECK(found.verdict != CalibrationVerdict::kGood);
  CHECK_THAT(All(found.reasons), Contains("not flat"));
  CHECK(found.bend_m == Approx(0.003).epsilon(0.2));
}

TEST_CASE("Too few views and views of another size are refused by name") {
  std::vector<BoardView> views = Views(WideCamera(), kBoard, 4, 2);
  views[3].width_px = 640;
  views.push_back({"dark.jpg", 1920, 1080, BoardMethod::kNone, {}, 0.0, "the picture is black"});
  const Calibration found = Calibrate(views, kBoard);
  CHECK(found.verdict == CalibrationVerdict::kRefuse);
  CHECK(found.camera.width_px == 0);
  CHECK_THAT(All(found.reasons), Contains("view3 is left out: it is 640x1080") &&
                                     Contains("dark.jpg is left out: the picture is black") &&
                                     Contains("only 3 of 5 views"));
}

TEST_CASE("Views from one side alone lack coverage and say which") {
  const CameraModel camera = WideCamera();
  std::vector<BoardView> views;
  for (const BoardView& view : Views(camera, kBoard, 200, 9)) {
    if (PlaceOf(view, kBoard).x < 0.3 && views.size() < 14) views.push_back(view);
  }
  const Calibration found = Calibrate(views, kBoard);
  CHECK(found.coverage.x < 0.5);
  CHECK(found.coverage.y > 0.75);
  CHECK_THAT(All(found.reasons), Contains("coverage in x"));
  CHECK(found.verdict == CalibrationVerdict::kUsable);
}

TEST_CASE("A board without squares is refused with the rule") {
  CHECK_THROWS_WITH(Calibrate({}, Board{2, 9, 0.025}), Contains("3 to 100"));
  CHECK_THROWS_WITH(Calibrate({}, Board{13, 9, 0.0}), Contains("metres"));
}

TEST_CASE("The photographs of the paper's camera are not called good and the reasons are named") {
  const auto folder = std::filesystem::path(test::SourceDir()) / "../shared/calibration/victure";
  if (!std::filesystem::exists(folder)) {
    WARN("SKIPPED: the photographs are not beside this clone (../shared/calibration)");
    return;
  }
  std::vector<BoardView> views;  // of eleven those that do not take seconds, one of each kind
  for (const char* number : {"00", "01", "07", "08", "09", "10"}) {
    const auto file = folder / fmt::format("calibration_{}.jpg", number);
    views.push_back(FindBoard(file.string(), kBoard));
  }
  const Calibration found = Calibrate(views, kBoard);
  const std::string reasons = All(found.reasons);
  INFO(reasons << "rms " << found.rms_px << " fisheye " << found.equidistant_px << " bent "
               << found.bent_px << " fx " << found.camera.k(0, 0) << " floor "
               << found.floor_error_m);
  CHECK(found.verdict != CalibrationVerdict::kGood);
  CHECK_THAT(reasons, Contains("calibration_00.jpg is left out: the picture is black"));
  CHECK_THAT(reasons, Contains("calibration_10.jpg is left out: no chessboard"));
  CHECK_THAT(reasons, Contains("drawn over") && Contains("px RMS") && Contains("not flat"));
  const test::TemporaryFolder out;
  DrawCalibration(found, out / "calibration.png");
  CHECK(std::filesystem::file_size(out / "calibration.png") > 20'000);
}

}  // namespace
}  // namespace rift::vision
