// What is said of a camera's calibration and of tags that are in the picture instead.

#include <catch2/catch.hpp>

#include "rift/report/json/json.hpp"
#include "rift/report/json/precision.hpp"

namespace rift::report {
namespace {

TEST_CASE("Tags that are in the picture instead are named with the flags that take them") {
  using vision::TagFamily;
  using Lines = std::vector<std::string>;
  vision::InsteadOfTag instead{.others = {{TagFamily::k36h11, 7}}};
  CHECK(UnseenLines(instead, TagFamily::k36h11, "--id ") ==
        Lines{"the picture shows tag36h11 id 7 (--id 7)"});
  CHECK(UnseenLines(instead, TagFamily::k36h11, "--set track.tag.id=") ==
        Lines{"the picture shows tag36h11 id 7 (--set track.tag.id=7)"});
  instead.others = {
      {TagFamily::k36h11, 7}, {TagFamily::k25h9, 3}, {TagFamily::k16h5, 1}, {TagFamily::k25h9, 4}};
  CHECK(UnseenLines(instead, TagFamily::k25h9, "--id ") ==
        Lines{"the picture shows tag36h11 id 7 (--set track.tag.family=tag36h11 --id 7), tag25h9 "
              "id 3 (--id 3), tag16h5 id 1 (--set track.tag.family=tag16h5 --id 1), tag25h9 id 4 "
              "(--id 4)"});
  instead.others.resize(6);
  CHECK_THAT(UnseenLines(instead, TagFamily::k25h9, "--id ").at(0),
             Catch::Matchers::EndsWith("id 4 (--id 4) and 2 more"));
}

TEST_CASE("Why a tag that shows was never seen is said with what to do, before other tags") {
  vision::InsteadOfTag instead;
  CHECK(UnseenLines(instead, vision::TagFamily::k36h11, "--id ").empty());
  instead.is_mirrored = true;
  instead.others = {{vision::TagFamily::k36h11, 7}};
  std::vector<std::string> lines = UnseenLines(instead, vision::TagFamily::k36h11, "--id ");
  REQUIRE(lines.size() == 2);
  CHECK_THAT(lines[0], Catch::Contains("as in a mirror: switch off"));
  CHECK_THAT(lines[1], Catch::Contains("id 7"));
  lines = UnseenLines({.is_unmeasured = true}, vision::TagFamily::k36h11, "--id ");
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0], Catch::Contains("could not be measured") && Catch::Contains("overexposed") &&
                           Catch::Contains("track.tag.size_m"));
}

TEST_CASE("Rows that are not on the floor are said, and none otherwise") {
  vision::TrackRun run;
  run.rows = 30;
  CHECK_THAT(TrackText(run, 30), !Catch::Contains("on the floor"));
  run.off_floor = 7;
  CHECK_THAT(TrackText(run, 30),
             Catch::Contains("\n7 of 30 rows are not on the floor (on_floor 0)"));
}

vision::Calibration Calibrated() {
  vision::Calibration c;
  c.verdict = vision::CalibrationVerdict::kUsable;
  c.reasons = {"few views", "little tilt"};
  c.board = {11, 7, 0.03};
  c.camera.width_px = 640;
  c.camera.height_px = 480;
  c.rms_px = 0.1234;
  c.plumb_bob_px = 0.2345;
  c.equidistant_px = 0.3456;
  c.floor_error_m = 0.00123;
  c.cross_check_m = 0.00234;
  c.coverage = {0.51, 0.62, 0.73, 0.84};
  c.parameters = {{"fx", 512.25, 0.75}};
  vision::ViewResult used, copy, dropped;
  used.view.name = "a.png";
  used.used = true;
  used.rms_px = 0.321;
  copy.view.name = "b.png";
  copy.is_copy = true;
  copy.dropped = "shows the same as a.png";
  dropped.view.name = "c.png";
  dropped.dropped = "no board";
  c.views = {used, copy, dropped};
  c.next.text = "to the left";
  return c;
}

TEST_CASE("Of a tag that is found nowhere no error is told") {
  vision::PrecisionPlace place;
  place.floor_m = Eigen::Vector2d(0.1, 0.2);
  place.views = 8;
  const vision::PrecisionMap map{.columns = 1, .rows = 1, .places = {place}};
  const std::string text = PrecisionText(map, {});
  CHECK_THAT(text, Catch::Contains("\nfound in 0 of 8 views\n") && !Catch::Contains("nan"));
  CHECK_THAT(text, Catch::Contains("at 1 of 1 places the tag is missed in some views"));
}

TEST_CASE("A camera's calibration is told with its errors, its coverage and what would help") {
  vision::Calibration c = Calibrated();
  const std::string numbers =
      "plumb_bob 640x480, error 0.123 px RMS (plumb_bob 0.234, equidistant 0.346)\n"
      "on the floor: 1.23 mm; odd views against even ones: 2.34 mm\n"
      "coverage: x 51 %, y 62 %, size 73 %, skew 84 %\n"
      "  fx         512.25 +- 0.75\n"
      "  a.png: 0.321 px\n"
      "  b.png: ignored, shows the same as a.png\n";
  CHECK(CalibrationText(c) ==
        "verdict: usable\n  few views\n  little tilt\n" + numbers + "next picture: to the left\n");
  CHECK(CalibrationComment(c) ==
        "# rift track --calibrate, board 11x7 of 0.03 m squares: usable.\n"
        "# 0.12 px RMS, on the floor 1.2 mm; odd views against even ones 2.3 mm.\n"
        "# - few views\n# - little tilt\n");
  c.verdict = vision::CalibrationVerdict::kGood;
  c.reasons.clear();
  CHECK(CalibrationText(c) == "verdict: good\n" + numbers);
  vision::Calibration few = c;  // of four or five views
  few.floor_error_m = few.cross_check_m = std::nan("");
  CHECK_THAT(
      CalibrationText(few),
      Catch::Contains("\non the floor: not known; odd views against even ones: not known\n"));
  CHECK_THAT(
      CalibrationComment(few),
      Catch::Contains("RMS, on the floor not known; odd views against even ones not known.\n"));
  c.verdict = vision::CalibrationVerdict::kRefuse;
  c.camera.width_px = 0;
  CHECK(CalibrationText(c) == "verdict: refuse\nnext picture: to the left\n");
  c.next.text.clear();
  CHECK(CalibrationText(c) == "verdict: refuse\n");
}

TEST_CASE("Waypoints are written to the tenth of a millimetre, and a heading to that of a degree") {
  const std::vector<control::Waypoint> waypoints{
      {.name = "start", .x_m = 0.12344, .y_m = -0.5, .heading_deg = 12.34},
      {.name = "wp1", .x_m = -0.25006, .y_m = 1.0, .stop = false}};
  CHECK(WaypointsYaml(waypoints) ==
        "waypoints:\n"
        "  - name: start\n"
        "    x: 0.1234\n"
        "    y: -0.5000\n"
        "    heading: 12.3\n"
        "    stop: true\n"
        "  - name: wp1\n"
        "    x: -0.2501\n"
        "    y: 1.0000\n"
        "    stop: false\n");
}

TEST_CASE(
    "Rows have a rate where two or more span a time, and a camera its troubles where it had some") {
  vision::TrackRun run;
  run.frames = 9;
  run.states = {9, 0, 0, 0};
  run.first_t_s = 1.5;
  run.last_t_s = 2.0;
  const std::string end = "; 9 pictures, the tag in every one, 0 dropped\n";
  CHECK(TrackText(run, 1) == "1 rows" + end);
  CHECK(TrackText(run, 2) == "2 rows in 0.5 s, 2.0 a second" + end);
  CHECK(TrackText(run, 9) == "9 rows in 0.5 s, 16.0 a second" + end);
  run.last_t_s = 1.5;
  CHECK(TrackText(run, 9) == "9 rows" + end);
  const std::string over = " damaged, too large or odd-sized pictures passed over, ";
  run.status.skipped = 1;
  CHECK(TrackText(run, 1) == "1 rows" + end + "1" + over + "0 reconnections\n");
  run.status.skipped = 0;
  run.status.reconnects = 1;
  CHECK(TrackText(run, 1) == "1 rows" + end + "0" + over + "1 reconnections\n");
  run.status.reconnects = 0;
  run.states = {8, 0, 1, 0};
  run.most_tags_of_this_id = 2;
  CHECK(TrackText(run, 1) ==
        "1 rows" + end +
            "1 rows are ambiguous (track_state 2): another tag of this id may be the robot's\n"
            "2 tags of this id were in the picture: take the others away\n");
}

}  // namespace
}  // namespace rift::report
