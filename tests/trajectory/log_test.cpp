#include "rift/trajectory/log.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "rift/geometry/pose2.hpp"
#include "support/inputs/paths.hpp"

namespace rift::trajectory {
namespace {

using geometry::kPi;

const std::string kAuthorsHeader = "t,x,y,z,roll,pitch,yaw,desired_x,desired_y\n";

/// What a reader says about a text it refuses.
std::string Refusal(const std::string& text, Format format = Format::kAuto) {
  try {
    ReadLog(text, "log.csv", format);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

Trajectory RandomTrajectory(std::mt19937_64& generator, bool with_angles) {
  std::uniform_real_distribution<double> value(-1.4, 1.4);
  Trajectory trajectory;
  trajectory.channels.push_back({"power_left", {}});
  for (int i = 0; i < 30; ++i) {
    StampedPose pose{.t_s = 0.05 * i + 0.001 * value(generator)};
    pose.x_m = value(generator);
    pose.y_m = value(generator);
    if (with_angles) {
      pose.z_m = value(generator);
      pose.roll_rad = value(generator);
      pose.pitch_rad = value(generator);
      pose.yaw_rad = 2.0 * value(generator);
    }
    trajectory.poses.push_back(pose);
    trajectory.channels[0].values.push_back(value(generator));
  }
  return trajectory;
}

TEST_CASE("A trajectory written in the rift dialect reads back to the same bits") {
  std::mt19937_64 generator(7);
  for (const bool with_angles : {true, false}) {
    const Trajectory written = RandomTrajectory(generator, with_angles);
    const Log log = ReadLog(WriteRift(written), "log.csv");
    CHECK(log.format == Format::kRift);
    CHECK(log.trajectory.HasYaw() == with_angles);
    CHECK(WriteRift(log.trajectory) == WriteRift(written));
    REQUIRE(log.trajectory.channels.size() == 1);
    CHECK(log.trajectory.channels[0].name == "power_left");
    CHECK(log.trajectory.channels[0].values == written.channels[0].values);
  }
}

TEST_CASE("A column of another log that is named as one of poses is written under its own name") {
  const Log log = ReadLog(
      "t,x,y,z,roll,pitch,x_m,x_m_2,desired_x,desired_y\n0,1,2,3,0,0,4,5,0,0\n1,2,2,3,0,0,6,7,0,"
      "0\n",
      "log.csv", Format::kWebots);
  const std::string written = WriteRift(log.trajectory);
  const Log again = ReadLog(written, "log.csv", Format::kRift);
  REQUIRE(again.trajectory.channels.size() == 2);
  CHECK(again.trajectory.channels[0].name == "x_m_2_2");
  CHECK(again.trajectory.channels[0].values == std::vector<double>{4.0, 6.0});
  CHECK(again.trajectory.channels[1].values == std::vector<double>{5.0, 7.0});
  CHECK(again.trajectory.poses[1].x_m == log.trajectory.poses[1].x_m);
  CHECK(WriteRift(again.trajectory) == written);
}

TEST_CASE("A trajectory written for evo reads back to the same pose") {
  std::mt19937_64 generator(8);
  const Trajectory written = RandomTrajectory(generator, true);
  const Log log = ReadLog(WriteTum(written), "log.tum");
  CHECK(log.format == Format::kTum);
  for (size_t i = 0; i < written.poses.size(); ++i) {
    const StampedPose &a = written.poses[i], &b = log.trajectory.poses[i];
    CHECK(b.t_s == a.t_s);
    CHECK(b.x_m == a.x_m);
    CHECK(b.z_m == a.z_m);
    CHECK(b.roll_rad == Approx(a.roll_rad).margin(1e-12));
    CHECK(b.pitch_rad == Approx(a.pitch_rad).margin(1e-12));
    CHECK(geometry::WrapToPi(b.yaw_rad - a.yaw_rad) == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("The tracker logs degrees and height below the camera") {
  const Log log = ReadLog(kAuthorsHeader + "3.0,1,2,0.87,10,-20,90,5,6\n3.1,2,2,0.87,0,0,0,5,6\n",
                          "log.csv", Format::kTracker);
  const StampedPose& pose = log.trajectory.poses[0];
  CHECK(pose.x_m == 1.0);
  CHECK(pose.y_m == 2.0);
  CHECK(pose.z_m == -0.87);
  CHECK(pose.roll_rad == Approx(kPi / 18.0));
  CHECK(pose.pitch_rad == Approx(-kPi / 9.0));
  CHECK(pose.yaw_rad == Approx(kPi / 2.0));
  CHECK(pose.target_x_m == 5.0);
}

TEST_CASE("Webots logs radians and a yaw turned by a quarter") {
  const Log log =
      ReadLog(kAuthorsHeader + "0,1,2,0,0,0,1.5707963267948966,5,6\n1,2,2,0,0,0,3,5,6\n", "log.csv",
              Format::kWebots);
  CHECK(log.trajectory.poses[0].yaw_rad == Approx(0.0).margin(1e-12));
}

TEST_CASE("The authors' header alone gives positions and leaves the angles unknown") {
  const Log log =
      ReadLog(kAuthorsHeader + "0,1,2,0.8,0,-33,1,5,6\n1,2,2,0.8,0,0,3,5,6\n", "log.csv");
  CHECK(log.format == Format::kAuto);
  CHECK_FALSE(log.trajectory.HasYaw());
  CHECK(log.unknown_angles.find("degrees") != std::string::npos);
  CHECK(log.unknown_angles.find("33.0 looks like degrees") != std::string::npos);
}

TEST_CASE("A log without angles has none to be unsure about") {
  const Log log = ReadLog("t,x,y\n0,0,0\n1,1,0\n", "log.csv");
  CHECK(log.unknown_angles.empty());
  CHECK_FALSE(log.trajectory.HasYaw());
}

TEST_CASE("A byte order mark and CRLF and blank lines change nothing") {
  const Log log = ReadLog("\xEF\xBB\xBFt_s,x_m,y_m\r\n0,0,0\r\n\r\n1,1,0\r\n", "log.csv");
  CHECK(log.trajectory.poses.size() == 2);
  const Log twice = ReadLog("t_s,x_m,y_m,a\r\r\n0,0,0,5\r\r\n1,1,0,6\r\r\n", "log.csv");
  REQUIRE(twice.trajectory.channels.size() == 1);
  CHECK(twice.trajectory.channels[0].name == "a");
  CHECK(twice.trajectory.channels[0].values == std::vector<double>{5.0, 6.0});
}

TEST_CASE("A column whose name ends with a CR keeps it in a copy") {
  const Log log = ReadLog("t_s,x_m,a\r,y_m\n0,0,1,0\n1,1,2,0\n", "log.csv");
  REQUIRE(log.trajectory.channels.size() == 1);
  CHECK(log.trajectory.channels[0].name == "a\r");
  CHECK(ReadLog(WriteRift(log.trajectory), "log.csv").trajectory.channels[0].name == "a\r");
}

TEST_CASE("A column whose name holds what no text does is written with it spelled out") {
  const Log log = ReadLog(
      "\nt_s,x_m,y_m,yaw_rad,a\x01"
      "b\n0,0,0,0,7\n1,1,0,0,8\n",
      "log");
  const std::string written = WriteRift(log.trajectory);
  CHECK(written.find(",a\\x01b\n") != std::string::npos);
  CHECK(WriteRift(ReadLog(written, "log").trajectory) == written);
}

TEST_CASE("Cells that repeat the ones above them are read right after any kind of row") {
  const Log log = ReadLog(
      "t_s,x_m,y_m,z_m\n0,1.5,2,0.25\n1,1.5,3,0.25\n2,+7,4,\n3,1.5,5,0.25\r\n\n4,1.50,5,0.25",
      "log");
  const std::vector<StampedPose>& poses = log.trajectory.poses;
  REQUIRE(poses.size() == 5);
  for (const size_t row : {0, 1, 3, 4}) {
    CHECK(poses[row].x_m == 1.5);
    CHECK(poses[row].z_m == 0.25);
  }
  CHECK(poses[2].x_m == 7.0);
  CHECK(std::isnan(poses[2].z_m));
  CHECK(poses[4].y_m == 5.0);
}

TEST_CASE("Header cells in double quotes and numbers with a plus are read") {
  const Log log =
      ReadLog("\"t_s\", \"x_m\" ,y_m,\"a, \"\"b\"\"\"\n0,0,0,1\n+1,+1.5,+.5,+2e0\n", "log.csv");
  CHECK(log.format == Format::kRift);
  CHECK(log.trajectory.poses[1].x_m == 1.5);
  CHECK(log.trajectory.poses[1].y_m == 0.5);
  REQUIRE(log.trajectory.channels.size() == 1);
  CHECK(log.trajectory.channels[0].name == "a, \"b\"");
  CHECK(ReadLog(WriteRift(log.trajectory), "log.csv").trajectory.channels[0].name == "a, \"b\"");
  for (const std::string cell : {"+", "+-1", "++1", "-+1", "+inf", "+ 1"}) {
    CHECK(
        Refusal("t_s,x_m,y_m\n0,0,0\n1," + cell + ",0\n").ends_with("a finite number is expected"));
  }
}

TEST_CASE("A comment before a log for evo may hold commas") {
  const std::string rows = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n";
  CHECK(ReadLog("# t, x, y of a robot\n\n# more\n" + rows, "log.tum").format == Format::kTum);
  CHECK(Refusal("# t, x, y\n1,2,3\n").find("belongs to no dialect") != std::string::npos);
  CHECK(Refusal("# nothing, else\n") == "log.csv: 0 poses, and a trajectory needs at least 2");
}

TEST_CASE("The line of the first missing yaw is known") {
  const std::string header = "t_s,x_m,y_m,yaw_rad\n";
  CHECK(ReadLog(header + "0,0,0,1\n\n1,1,0,\n2,2,0,\n", "log.csv").line_without_yaw == 4);
  CHECK(ReadLog(header + "2,0,0,1\n1,1,0,\n0,2,0,\n", "log.csv").line_without_yaw == 3);
  CHECK(ReadLog(header + "0,0,0,\n1,1,0,1\n", "log.csv").line_without_yaw == 2);
  CHECK_FALSE(ReadLog(header + "0,0,0,\n0,0,0,1\n1,1,0,1\n", "log.csv").line_without_yaw);
  CHECK_FALSE(ReadLog(header + "0,0,0,\n1,1,0,\n", "log.csv").line_without_yaw);
  CHECK_FALSE(ReadLog(header + "0,0,0,1\n1,1,0,1\n", "log.csv").line_without_yaw);
}

TEST_CASE("A file that is no text of lines is refused with what to do") {
  CHECK(Refusal("") == "log.csv: the file is empty");
  CHECK(Refusal("\xEF\xBB\xBF\r\n \n") == "log.csv: the file is empty");
  CHECK(Refusal("\xFF\xFEt") == "log.csv: is UTF-16: save it as UTF-8 text");
  CHECK(Refusal("t_s,x_m,y_m\r0,0,0\r1,1,0\r") ==
        "log.csv: its lines end with CR alone: save it with LF or CRLF");
}

TEST_CASE("A message shows bytes that no terminal does and the line of a late header") {
  using namespace std::string_literals;
  CHECK(Refusal("t_s,x_m,y_m\n0,0,0\n1,1,0\0 5\n"s) ==
        "log.csv:3: column y_m is '0\\x00 5': a finite number is expected");
  CHECK(Refusal("t_s,x_m,y_m\n0,0,\x1b[31m\n") ==
        "log.csv:2: column y_m is '\\x1b[31m': a finite number is expected");
  CHECK(Refusal("\n\nt_s,x_m,foo\n0,0,0\n").starts_with("log.csv:3: the header"));
}

TEST_CASE("The size of a quaternion does not matter") {
  const auto yaw_rad = [](const std::string& zw) {
    return ReadLog("0 0 0 0 0 0 " + zw + "\n1 1 0 0 0 0 " + zw + "\n", "log.tum")
        .trajectory.poses[0]
        .yaw_rad;
  };
  const double right_angle_rad = geometry::kPi / 2.0;
  CHECK(yaw_rad("1 1") == Approx(right_angle_rad));
  CHECK(yaw_rad("1e200 1e200") == Approx(right_angle_rad));
  CHECK(yaw_rad("1e-200 1e-200") == Approx(right_angle_rad));
}

TEST_CASE("Rows out of order are sorted and of equal times the last is kept and both are said") {
  const Log log = ReadLog("t_s,x_m,y_m,n\n2,2,0,20\n0,0,0,0\n1,1,0,10\n1,1.5,0,11\n", "log.csv");
  REQUIRE(log.trajectory.poses.size() == 3);
  CHECK(log.trajectory.poses[1].x_m == 1.5);
  CHECK(log.trajectory.channels[0].values == std::vector<double>{0.0, 11.0, 20.0});
  REQUIRE(log.notes.size() == 2);
  CHECK(log.notes[0] == "time runs backwards 1 times: rows sorted");
  CHECK(log.notes[1] == "1 rows share the time of another: the last is kept");
}

TEST_CASE("A bad log is refused with its row and its rule") {
  const std::string good = "t_s,x_m,y_m\n0,0,0\n";
  CHECK(Refusal(good + "1,nan,0\n") ==
        "log.csv:3: column x_m is 'nan': a finite number is expected");
  CHECK(Refusal(good + "1,inf,0\n") ==
        "log.csv:3: column x_m is 'inf': a finite number is expected");
  CHECK(Refusal(good + "1,1e999,0\n") ==
        "log.csv:3: column x_m is '1e999': a finite number is expected");
  CHECK(Refusal(good + "1,1.2.3,0\n") ==
        "log.csv:3: column x_m is '1.2.3': a finite number is expected");
  CHECK(Refusal(good + ",1,0\n") == "log.csv:3: column t_s is empty");
  CHECK(Refusal(good + "1,,0\n") == "log.csv:3: column x_m is empty");
  CHECK(Refusal(good + "1,0,\n") == "log.csv:3: column y_m is empty");
  CHECK(Refusal(good + "1,2\n") == "log.csv:3: the row has 2 cells where 3 are expected");
  CHECK(Refusal(good + "1,2,3,4\n") == "log.csv:3: the row has 4 cells where 3 are expected");
  CHECK(Refusal(good + "1,2,3,\n") == "log.csv:3: the row has 4 cells where 3 are expected");
  CHECK(Refusal(good) == "log.csv: 1 pose, and a trajectory needs at least 2");
  CHECK(Refusal(good + "1,0,0\n") == "log.csv: the path has zero length: the robot never moved");
  CHECK(Refusal("a,b\n1,2\n").find("log.csv:1: the header 'a,b' belongs to no dialect") == 0);
  CHECK(Refusal("t_s,x_m,y_m,x_m\n") ==
        "log.csv:1: the header has two columns 'x_m': rename or remove one of them");
  CHECK(Refusal("t_s,x_m,y_m,,\n0,0,0,,\n1,1,0,,\n") == "accepted");
  CHECK(Refusal(good, Format::kTracker) ==
        "log.csv: its header is of dialect rift, and the format asked for is tracker: leave it at "
        "auto, or name another log");
  CHECK_THAT(Refusal("0 1 2 3\n1 2 3 4\n"),
             Catch::Contains("eight columns without header (tum)") &&
                 Catch::Contains("--columns 't=1,x=2,y=3,yaw=4:deg'"));
  CHECK(Refusal("0 1 2 3 0 0 0 0\n") == "log.csv:1: the quaternion has zero length");
}

TEST_CASE("Rows without a tag id hide no second robot and are none themselves") {
  const auto log = [](const std::vector<std::string>& ids) {
    std::string text = "t_s,x_m,y_m,yaw_rad,tag_id\n";
    for (size_t i = 0; i < ids.size(); ++i) {
      text += std::to_string(i) + "," + std::to_string(i) + ",0,0," + ids[i] + "\n";
    }
    return text;
  };
  for (const auto& ids : std::vector<std::vector<std::string>>{
           {"", "3", "3"}, {"3", "", "3"}, {"3", "3", ""}, {"", "", ""}}) {
    CHECK(Refusal(log(ids)) == "accepted");
  }
  for (const auto& ids : std::vector<std::vector<std::string>>{
           {"", "3", "4"}, {"4", "", "3"}, {"3", "4", ""}, {"3", "", "", "4", ""}}) {
    CHECK(Refusal(log(ids)) ==
          "log.csv: it holds several robots, tags 3 to 4: keep the rows of one tag_id");
  }
}

TEST_CASE("A last row that was cut short is left out, or kept where it may be whole, with a note") {
  const std::string whole = "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,1,-1,0.5\n";
  const auto poses_of = [](const std::string& text, size_t notes) {
    const Log log = ReadLog(text, "log.csv");
    INFO(text);
    CHECK(log.notes.size() == notes);
    return log.trajectory.poses.size();
  };
  const std::string row = "2,-2e-05,0.25,1e-05";
  for (size_t bytes = 1; bytes < row.size(); ++bytes) {
    // In the last cell 1e-0 is a number as well, and kept; all before it are known to be whole.
    const bool is_whole = bytes == 15 || bytes == 14 || row.substr(0, bytes).ends_with("e-0");
    CHECK(poses_of(whole + row.substr(0, bytes), 1) == (bytes > 13 && is_whole ? 3 : 2));
  }
  CHECK(poses_of(whole + std::string(20, '\0'), 1) == 2);
  CHECK(poses_of(whole + row, 1) == 3);
  CHECK(ReadLog(whole + "2,2,0,0.123", "log.csv").notes ==
        std::vector<std::string>{"the last row has no line end: its last number may be cut"});
  CHECK(poses_of(whole + row + "\n", 0) == 3);
  CHECK(poses_of(whole + "  ", 0) == 2);
  CHECK(poses_of("t_s,x_m,y_m,\"a,b\"\n0,0,0,1\n1,1,-1,2", 1) == 2);
  CHECK_THROWS_WITH(ReadLog(whole + "2,-2e-05\n", "log.csv"), Catch::Contains("2 cells"));
  CHECK_THROWS_WITH(ReadLog("t,x,y\n0,0,0\n1,1,1\n2,2", "log.csv"), Catch::Contains("2 cells"));
}

TEST_CASE("A position or a time that no robot logs is refused with its row") {
  const std::string good = "t_s,x_m,y_m,z_m\n0,0,0,0\n";
  CHECK(Refusal(good + "1,1e308,0,0\n") ==
        "log.csv:3: x is 1e+308, beyond +-1e+06: is the log in metres and seconds?");
  CHECK(Refusal(good + "1,0,-1.1e6,0\n").starts_with("log.csv:3: y is -1.1e+06, beyond"));
  CHECK(Refusal(good + "1,1,0,-2e6\n").starts_with("log.csv:3: z is -2e+06, beyond"));
  CHECK(Refusal(good + "1.7e18,1,0,0\n").starts_with("log.csv:3: t is 1.7e+18, beyond"));
  CHECK(Refusal(good + "1e12,1e6,-1e6,1e6\n") == "accepted");
  CHECK(Refusal("0 0 0 0 0 0 0 1\n\n1 0 -1e7 0 0 0 0 1\n").starts_with("log.csv:3: y is -1e+07"));
}

/// True when it was read.
bool ReadsOrIsRefused(const std::string& text, Format format) {
  try {
    const Log log = ReadLog(text, "log.csv", format);
    for (const StampedPose& pose : log.trajectory.poses) {
      REQUIRE(std::isfinite(pose.x_m + pose.y_m + pose.t_s));
    }
    REQUIRE(log.trajectory.poses.size() >= 2);
    return true;
  } catch (const std::invalid_argument& error) {
    REQUIRE(std::string(error.what()).starts_with("log.csv:"));
    return false;
  }
}

TEST_CASE("No damaged log of any dialect does anything but read or be refused") {
  std::mt19937_64 generator(9);
  Trajectory written = RandomTrajectory(generator, true);
  const std::string rift = WriteRift(written);
  written.channels.clear();
  const std::string rows = WriteRift(written);
  const std::string authors = kAuthorsHeader + rows.substr(rows.find('\n') + 1);
  const std::vector<std::pair<std::string, Format>> logs{{rift, Format::kAuto},
                                                         {rift, Format::kRift},
                                                         {WriteTum(written), Format::kTum},
                                                         {WriteTum(written), Format::kAuto},
                                                         {authors, Format::kTracker},
                                                         {authors, Format::kWebots},
                                                         {authors, Format::kAuto}};
  for (const auto& [text, format] : logs) {
    int read = 0;
    for (int i = 0; i < 1000; ++i) read += ReadsOrIsRefused(test::Damaged(text, generator), format);
    CHECK(read > 50);
    CHECK(read < 950);
  }
}

TEST_CASE("A million rows are read whole") {
  std::string text = "t_s,x_m,y_m\n";
  for (int i = 0; i < 1'000'000; ++i) {
    text += std::to_string(i) + "," + std::to_string(i % 1000) + ",0.5\n";
  }
  CHECK(ReadLog(text, "log.csv").trajectory.poses.size() == 1'000'000);
}

TEST_CASE("A tag offset moves each point along its own heading") {
  Trajectory trajectory;
  trajectory.poses = {{.t_s = 0.0, .x_m = 1.0, .yaw_rad = kPi / 2.0}, {.t_s = 1.0, .yaw_rad = 0.0}};
  const Trajectory moved = OffsetAlongHeading(trajectory, 0.03);
  CHECK(moved.poses[0].x_m == Approx(1.0));
  CHECK(moved.poses[0].y_m == Approx(0.03));
  CHECK(moved.poses[1].x_m == Approx(0.03));
  trajectory.poses[0].yaw_rad = StampedPose::kNotLogged;
  CHECK_THROWS_AS(OffsetAlongHeading(trajectory, 0.03), std::invalid_argument);
  CHECK_NOTHROW(OffsetAlongHeading(trajectory, 0.0));
}

TEST_CASE("The standing pose is the median of the first rows and shrugs off a jump") {
  Trajectory trajectory;
  for (int i = 0; i < 9; ++i) {
    trajectory.poses.push_back({.t_s = 0.1 * i,
                                .x_m = 1.0 + 0.001 * (i % 3),
                                .y_m = 2.0 - 0.001 * (i % 3),
                                .yaw_rad = kPi - 0.01 + 0.01 * (i % 3)});
  }
  trajectory.poses[1].x_m += 0.006;  // within the radius, and far from the rest
  trajectory.poses[1].yaw_rad = 0.5;
  for (int i = 0; i < 20; ++i) {
    trajectory.poses.push_back({.t_s = 1.0 + i, .x_m = 1.1 + i, .y_m = 5.0, .yaw_rad = 0.0});
  }
  trajectory.poses.push_back({.t_s = 30.0, .x_m = 1.0, .y_m = 2.0, .yaw_rad = 0.0});
  const geometry::Pose2 pose = StandingPose(trajectory);
  CHECK(pose.x_m == Approx(1.001));
  CHECK(pose.y_m == Approx(1.999));
  CHECK(std::abs(geometry::WrapToPi(pose.yaw_rad - kPi)) < 1e-12);
  trajectory.poses[4].yaw_rad = StampedPose::kNotLogged;
  CHECK_THROWS_AS(StandingPose(trajectory), std::invalid_argument);
}

TEST_CASE("A standing tag that is seen in two tilts lies in the lower one") {
  // A tracker took it for its mirrored pose in 7 of 10 rows, 30 deg further and turned by 3 deg.
  const auto standing = [](double lower_rad, double higher_rad) {
    Trajectory log;
    for (int i = 0; i < 10; ++i) {
      const bool is_mirrored = i % 3 != 1;
      log.poses.push_back({.t_s = 0.1 * i,
                           .x_m = is_mirrored ? 0.502 : 0.5,
                           .y_m = is_mirrored ? 0.201 : 0.2,
                           .roll_rad = 0.02,
                           .pitch_rad = is_mirrored ? higher_rad : lower_rad,
                           .yaw_rad = is_mirrored ? 0.05 : 0.1});
    }
    return log;
  };
  for (const auto& [lower_rad, higher_rad] :
       {std::pair(-0.03, -0.55), {0.1, 0.5}, {-0.255, 0.5}, {0.0, 0.23}}) {
    CAPTURE(lower_rad, higher_rad);
    const Trajectory log = standing(lower_rad, higher_rad);
    const geometry::Pose2 pose = StandingPose(log);
    CHECK(StandingTilt_rad(log) == Approx(std::hypot(lower_rad, 0.02)).epsilon(0.01));
    CHECK(pose.x_m == 0.5);
    CHECK(pose.y_m == 0.2);
    CHECK(pose.yaw_rad == Approx(0.1));
  }
  // What jitters is one tilt, and so is one that is not logged: the median of all rows.
  CHECK(StandingPose(standing(0.0, 0.18)).yaw_rad == Approx(0.05));
  const Trajectory without_tilt = standing(StampedPose::kNotLogged, StampedPose::kNotLogged);
  CHECK(StandingPose(without_tilt).yaw_rad == Approx(0.05));
  CHECK(std::isnan(StandingTilt_rad(without_tilt)));
}

TEST_CASE("What a leaving robot shows of its tag is not where it stood") {
  // The authors' logs: a standing tag and its mirrored pose lie up to 5 mm apart, and the rows of a
  // robot that leaves are within a centimetre of where it stood too.
  const auto row = [](int i, double x_m, double pitch_rad, double yaw_rad) {
    return StampedPose{.t_s = 0.1 * i,
                       .x_m = x_m,
                       .y_m = 0.0,
                       .roll_rad = 0.0,
                       .pitch_rad = pitch_rad,
                       .yaw_rad = yaw_rad};
  };
  Trajectory log;
  log.poses = {row(0, 0.0, 0.6, 0.0),    row(1, 0.0045, 0.1, 0.05), row(2, 0.0, 0.6, 0.0),
               row(3, 0.0, 0.6, 0.0),    row(4, 0.0, 0.6, 0.0),     row(5, 0.0085, 0.1, 0.09),
               row(6, 0.0095, 0.1, 0.09)};
  CHECK(StandingPose(log).x_m == 0.0045);
  CHECK(StandingPose(log).yaw_rad == Approx(0.05));
  CHECK(StandingTilt_rad(log) == Approx(0.1));
  // A row without a tilt is of neither kind.
  log.poses[3].pitch_rad = StampedPose::kNotLogged;
  CHECK(StandingPose(log).yaw_rad == Approx(0.05));
  CHECK(StandingTilt_rad(log) == Approx(0.1));
  // Upright only when it leaves: it stood mirrored.
  log.poses[1] = row(1, 0.0, 0.6, 0.0);
  CHECK(StandingPose(log).yaw_rad == Approx(0.0).margin(1e-12));
  CHECK(StandingTilt_rad(log) == Approx(0.6));
}

TEST_CASE("A robot that turns on the spot under its tag does not stand any more") {
  const auto yaw_rad = [](const std::vector<double>& turns_rad, double standing_rad) {
    Trajectory log;
    const auto add = [&](double turned_rad) {
      log.poses.push_back({.t_s = 0.05 * static_cast<double>(log.poses.size()),
                           .x_m = 0.5,
                           .y_m = -0.5,
                           .yaw_rad = geometry::WrapToPi(standing_rad + turned_rad)});
    };
    for (const double turned_rad : turns_rad) add(turned_rad);
    for (int i = 1; i <= 20; ++i) add(kPi / 40.0 * i);  // a quarter of a turn, and it holds there
    for (int i = 0; i < 60; ++i) add(kPi / 2.0);
    return StandingPose(log).yaw_rad;
  };
  for (const double standing_rad : {0.3, kPi - 0.01, -kPi + 0.01}) {
    INFO(standing_rad);
    const auto off_rad = [&](const std::vector<double>& turns_rad) {
      return std::abs(geometry::WrapToPi(yaw_rad(turns_rad, standing_rad) - standing_rad));
    };
    CHECK(off_rad(std::vector<double>(20, 0.0)) < 1e-9);
    CHECK(off_rad({1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}) < 1e-9);  // first two jump
    CHECK(off_rad({0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01, 0.01}) ==
          Approx(0.01));  // and one of the others does
  }
}

}  // namespace
}  // namespace rift::trajectory
