// What a log is once it is read: its order in time, its notes, heights in space, paths and text.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>

#include "rift/trajectory/csv.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/trajectory/read_options.hpp"
#include "trajectory/plausibility.hpp"

namespace rift::trajectory {
namespace {

using Catch::Matchers::Contains;

const std::string kHeader = "t_s,x_m,y_m,z_m,roll_rad,pitch_rad,yaw_rad,power\n";
std::string Row(double t_s, double x_m, const std::string& rest = "0,0,0,0,0,1") {
  return std::to_string(t_s) + "," + std::to_string(x_m) + "," + rest + "\n";
}

TEST_CASE("Each step back in time is counted, the last one too, and channels go with their rows") {
  const Log log =
      ReadLog(kHeader + Row(1, 1, "0,0,0,0,0,10") + Row(3, 3, "0,0,0,0,0,30") +
                  Row(2, 2, "0,0,0,0,0,20") + Row(4, 4, "0,0,0,0,0,40") + Row(0, 0, "0,0,0,0,0,0"),
              "log");
  CHECK(log.notes == std::vector<std::string>{"time runs backwards 2 times: rows sorted"});
  REQUIRE(log.trajectory.poses.size() == 5);
  for (size_t i = 0; i < 5; ++i) {
    CHECK(log.trajectory.poses[i].t_s == static_cast<double>(i));
    CHECK(log.trajectory.poses[i].x_m == static_cast<double>(i));
    CHECK(log.trajectory.channels.at(0).values[i] == 10.0 * static_cast<double>(i));
  }
  const Log twice =
      ReadLog(kHeader + Row(0, 0) + Row(1, 5) + Row(1, 6) + Row(1, 7) + Row(2, 8), "log");
  CHECK(twice.notes ==
        std::vector<std::string>{"2 rows share the time of another: the last is kept"});
  REQUIRE(twice.trajectory.poses.size() == 3);
  CHECK(twice.trajectory.poses[1].x_m == 7.0);
}

TEST_CASE("A log needs two poses and a way, in the plane or in space") {
  CHECK_THROWS_WITH(ReadLog(kHeader + Row(0, 0), "log"),
                    "log: 1 pose, and a trajectory needs at least 2");
  CHECK_THROWS_WITH(ReadLog(kHeader, "log"), "log: 0 poses, and a trajectory needs at least 2");
  const std::string lift = kHeader + Row(0, 1) + Row(1, 1, "0,0.5,0,0,0,1");
  CHECK_THROWS_WITH(ReadLog(lift, "log"), "log: the path has zero length: the robot never moved");
  CHECK(ReadLog(lift, "log", ReadOptions{.in_space = true}).trajectory.poses.size() == 2);
  CHECK_THROWS_WITH(
      ReadLog(kHeader + Row(0, 1) + Row(1, 2, "0,,0,0,0,1"), "log", ReadOptions{.in_space = true}),
      Contains("log: the pose at 1 s has no height z") &&
          Contains("log z_m, or name its column: "
                   "--columns t=...,x=...,y=...,z"));
  CHECK_THROWS_WITH(ReadLog("t,x,y,z,roll,pitch,yaw\n0,0,0,1,0,0,0\n1,1,0,1,0,0,0\n", "log",
                            ReadOptions{.in_space = true}),
                    Contains("name its format, tracker or webots"));
}

TEST_CASE("Only a log of which some rows have a yaw says where the first one lacks it") {
  const auto line_of = [](const std::string& first, const std::string& second) {
    return ReadLog(kHeader + Row(0, 0, "0,0,0,0," + first + ",1") +
                       Row(1, 1, "0,0,0,0," + second + ",1"),
                   "log")
        .line_without_yaw;
  };
  CHECK_FALSE(line_of("0", "0"));
  CHECK_FALSE(line_of("", ""));
  CHECK(line_of("", "0") == 2);
  CHECK(line_of("0", "") == 3);
}

TEST_CASE("A row that tracking has not measured is left out and counted") {
  const Log log = ReadLog(
      "t_s,x_m,y_m,track_state\n0,0,0,0\n1,9,9,1\n2,1,0,0\n3,9,9,2\n4,9,9,3\n5,2,0,0\n", "log");
  CHECK(log.trajectory.poses.size() == 3);
  REQUIRE(log.notes.size() == 1);
  const std::string why = "left out: track_state is predicted, ambiguous or lost";
  CHECK(log.notes[0] == "3 rows are " + why);
  CHECK(ReadLog("t_s,x_m,y_m,track_state\n0,0,0,0\n1,9,9,3\n2,1,0,0\n", "log").notes ==
        std::vector<std::string>{"1 row is " + why});
}

TEST_CASE("What has become of the rows stands beside the refusal of a log with too few") {
  CHECK_THROWS_WITH(ReadLog("t_s,x_m,y_m,track_state\n0,0,0,2\n1,1,0,3\n", "log"),
                    "log: 0 poses, and a trajectory needs at least 2: 2 rows are left out: "
                    "track_state is predicted, ambiguous or lost");
  CHECK_THROWS_WITH(ReadLog("t_s,x_m,y_m\n1,0,0\n1,1,0\n", "log"),
                    "log: 1 pose, and a trajectory needs at least 2: 1 rows share the time of "
                    "another: the last is kept");
}

TEST_CASE("A dialect's log with a column of text is refused with the flag that reads past it") {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      ReadLog(text, "log", ReadOptions{.columns_flag = "--sim-columns "});
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("t_s,x_m,y_m,state\n0,0,0,idle\n1,1,0,go\n") ==
        "log:2: column state is 'idle': a finite number is expected; where the columns to be read "
        "are named, others may hold text: --sim-columns 't=t_s,x=x_m,y=y_m'");
  CHECK_THAT(refusal("t,x,y,state\n0,0,0,idle\n1,1,0,go\n"),
             Contains("--sim-columns 't=t,x=x,y=y'"));
  CHECK(refusal("t_s,x_m,y_m,state\n0,0,zero,1\n1,1,0,1\n") ==
        "log:2: column y_m is 'zero': a finite number is expected");
}

TEST_CASE("A doubt about units offers what changes them in a log of that header") {
  const auto doubt = [](const std::string& header, const ReadOptions& options) {
    std::string text = header + "\n";
    for (int i = 0; i < 40; ++i) {
      text += std::to_string(0.1 * i) + "," + std::to_string(30 * i) + "," + std::to_string(i * i) +
              "\n";
    }
    const Log log = ReadLog(text, "log", options);
    REQUIRE(log.doubts.size() == 1);
    return log.doubts[0];
  };
  const std::string as_in = "name the unit, as in ";
  const std::string of_columns = as_in + "--sim-columns 't=...,x=...:mm,y=...:mm'";
  const ReadOptions bare{.columns_flag = "--sim-columns "};
  CHECK_THAT(doubt("t_s,x_m,y_m", bare), Catch::EndsWith(of_columns));
  CHECK_THAT(doubt("t,x,y", bare), Catch::EndsWith(as_in + "--sim-units mm"));
  CHECK_THAT(doubt("t,x,y", {}), Catch::EndsWith(as_in + "--units mm"));
  ReadOptions named{.columns = "t=t,x=x,y=y", .own_columns_flag = "--sim-columns "};
  CHECK_THAT(doubt("t,x,y", named), Catch::EndsWith(as_in + "--sim-units mm"));
  CHECK_THAT(doubt("t (s),X (m),Y (m)", {.units = "s", .columns_flag = "--sim-columns "}),
             Catch::EndsWith(of_columns));
  named = {.columns = "t=t,x=x,y=y", .columns_flag = "--set candidate.columns="};
  CHECK_THAT(doubt("t,x,y", named), Catch::EndsWith(as_in + "--set candidate.units=mm"));
}

TEST_CASE("Files of other kinds are refused with what they are") {
  const auto says = [](const std::string& text, const std::string& what) {
    CHECK_THROWS_WITH(ReadLog(text, "log"), Contains("log: ") && Contains(what));
  };
  says("", "the file is empty");
  says(" \t\r\n\n", "the file is empty");
  says("\xEF\xBB\xBF\n", "the file is empty");
  says(std::string("\xFF\xFEt\0", 4), "is UTF-16");
  says(std::string("\xFE\xFF\0t", 4), "is UTF-16");
  says(std::string("t_s,x_m\0,y_m\n0,0,0\n", 19), "is not text");
  says("t_s,x_m,y_m\r0,0,0\r1,1,0", "its lines end with CR alone");
}

TEST_CASE("Cells are what stands between separators, quotes closed or not, without blanks") {
  using csv::SplitHeader;
  using Cells = std::vector<std::string>;
  CHECK(SplitHeader("a,b , c") == Cells{"a", "b", "c"});
  CHECK(SplitHeader("") == Cells{""});
  CHECK(SplitHeader("a,") == Cells{"a", ""});
  CHECK(SplitHeader(",a") == Cells{"", "a"});
  CHECK(SplitHeader("\"a,b\",c") == Cells{"a,b", "c"});
  CHECK(SplitHeader("\"a\"\"b\",c") == Cells{"a\"b", "c"});
  CHECK(SplitHeader("\"a,b") == Cells{"a,b"});
  CHECK(SplitHeader("a b\tc", ' ') == Cells{"a", "b", "c"});
  CHECK(SplitHeader("a;b", ';') == Cells{"a", "b"});
}

TEST_CASE("A log has ten thousand columns at most, in whatever dialect and separator") {
  const auto read = [](int columns, const std::string& separator, const ReadOptions& options) {
    std::string header = "t_s" + separator + "x_m" + separator + "y_m";
    std::string rows[] = {"0" + separator + "0" + separator + "0",
                          "1" + separator + "1" + separator + "1"};
    for (int i = 3; i < columns; ++i) {
      header += separator + "c" + std::to_string(i);
      for (std::string& row : rows) row += separator + "7";
    }
    return ReadLog("\n" + header + "\n" + rows[0] + "\n" + rows[1] + "\n", "wide.csv", options);
  };
  const ReadOptions own{.columns = "t=t_s,x=x_m,y=y_m"};
  CHECK(read(10'000, ",", {}).trajectory.channels.size() == 9'997);
  for (const char* separator : {",", ";", "\t", " "}) {
    CHECK(read(10'000, separator, own).trajectory.poses.size() == 2);
    CHECK_THROWS_WITH(read(10'001, separator, own),
                      Catch::StartsWith("wide.csv:2: 10001 columns: at most 10000 are taken"));
  }
  CHECK_THROWS_WITH(read(10'001, ",", {}),
                    Catch::StartsWith("wide.csv:2: 10001 columns: at most 10000 are taken"));
  const std::string blanks = "t_s,x_m,y_m\n0,0," + std::string(20'000, ' ') + "0\n1,1,1\n";
  CHECK(ReadLog(blanks, "wide.csv", ReadOptions{}).trajectory.poses.size() == 2);
}

TEST_CASE("Two columns of one name are found among many") {
  std::vector<std::string> columns{"", ""};  // columns without a name may be several
  for (int i = 0; i < 1'000; ++i) columns.push_back("c" + std::to_string(i));
  CHECK_NOTHROW(csv::RefuseRepeatedColumns(columns, "a.csv:1"));
  columns.push_back("c999");
  CHECK_THROWS_WITH(csv::RefuseRepeatedColumns(columns, "a.csv:1"),
                    Catch::StartsWith("a.csv:1: the header has two columns 'c999'"));
}

TEST_CASE("A number is finite, may have a plus and an exponent, and an empty cell is none") {
  using csv::NumberOf;
  CHECK(NumberOf("1.5") == 1.5);
  CHECK(NumberOf("+1.5") == 1.5);
  CHECK(NumberOf("-2e3") == -2000.0);
  CHECK(std::isnan(NumberOf("").value()));
  for (const char* wrong : {"+", "-", "+-1", "++1", "1.5 ", "1,5", "nan", "inf", "-inf", "0x1",
                            "one", "1.5m", "1e999"}) {
    INFO(wrong);
    CHECK_FALSE(NumberOf(wrong));
  }
}

TEST_CASE("Bytes that no terminal shows are shown as hexadecimal, and long texts are cut") {
  CHECK(csv::Shown(std::string("a\x01\x7f\x1f z", 6)) == "a\\x01\\x7f\\x1f z");
  CHECK(csv::Shown("\xFF") == "\\xff");
  CHECK(csv::Shown("ü") == "ü");
  CHECK(csv::Shown("abcdef", 3) == "abc");
}

TEST_CASE("Lines end with LF or CRLF, however many CR, and the last needs no end") {
  std::string_view rest = "a\r\r\nb\n\nc";
  CHECK(csv::TakeLine(rest) == "a");
  CHECK(csv::TakeLine(rest) == "b");
  CHECK(csv::TakeLine(rest).empty());
  CHECK(csv::TakeLine(rest) == "c");
  CHECK(rest.empty());
}

TEST_CASE("Every value beyond what a robot logs is named with its bound, and the bound is taken") {
  struct Limit {
    double StampedPose::*member;
    double limit;
    std::string name, question;
  };
  const std::string metres = "is the log in metres and seconds?", angle = "is it an angle?";
  const std::vector<Limit> limits{
      {&StampedPose::t_s, 1e12, "t", metres},       {&StampedPose::x_m, 1e6, "x", metres},
      {&StampedPose::y_m, 1e6, "y", metres},        {&StampedPose::z_m, 1e6, "z", metres},
      {&StampedPose::roll_rad, 1e6, "roll", angle}, {&StampedPose::pitch_rad, 1e6, "pitch", angle},
      {&StampedPose::yaw_rad, 1e6, "yaw", angle}};
  for (const Limit& one : limits) {
    for (const double sign : {1.0, -1.0}) {
      INFO(one.name << " " << sign);
      StampedPose pose;
      pose.*one.member = sign * one.limit;
      CHECK_NOTHROW(CheckMagnitudes(pose, "log", 7));
      pose.*one.member = sign * one.limit * 1.001;
      CHECK_THROWS_WITH(CheckMagnitudes(pose, "log", 7),
                        Catch::StartsWith("log:7: " + one.name + " is ") && Contains(one.question));
    }
  }
}

TEST_CASE("A trajectory's yaw, duration and length are those of its poses") {
  Trajectory log;
  CHECK_FALSE(log.HasYaw());
  CHECK(log.Duration_s() == 0.0);
  CHECK(log.ArcLength_m() == 0.0);
  log.poses = {{.t_s = 2.0, .x_m = 1.0, .y_m = 1.0, .yaw_rad = 0.0},
               {.t_s = 3.0, .x_m = 4.0, .y_m = 5.0, .yaw_rad = 0.1},
               {.t_s = 7.0, .x_m = 4.0, .y_m = 3.0, .yaw_rad = 0.2}};
  CHECK(log.HasYaw());
  CHECK(log.Duration_s() == 5.0);
  CHECK(log.ArcLength_m() == 7.0);
  log.poses[2].yaw_rad = StampedPose::kNotLogged;
  CHECK_FALSE(log.HasYaw());
  CHECK_THROWS_WITH(OffsetAlongHeading(log, 0.1), Contains("the yaw is not known"));
  CHECK_NOTHROW(OffsetAlongHeading(log, 0.0));
  CHECK_THROWS_WITH(StandingPose(log), Contains("which is not known"));
}

TEST_CASE("A robot stands as long as it is within the radius, turned the short way round") {
  Trajectory log;
  for (const double x_m : {0.0, 0.004, 0.008, 0.5, 0.001}) {
    log.poses.push_back({.t_s = static_cast<double>(log.poses.size()),
                         .x_m = 1.0 + x_m,
                         .y_m = 2.0 - x_m / 2.0,
                         .yaw_rad = log.poses.size() == 1 ? -3.1 : 3.1});
  }
  const geometry::Pose2 standing = StandingPose(log);
  CHECK(standing.x_m == Approx(1.004));
  CHECK(standing.y_m == Approx(1.998));
  CHECK(standing.yaw_rad == Approx(3.1));
  CHECK(StandingPose(log, 0.005).x_m == Approx(1.002));
  const Trajectory apart{.poses = {{.t_s = 0.0, .x_m = 0.0, .y_m = 0.0, .yaw_rad = 0.0},
                                   {.t_s = 1.0, .x_m = 0.5, .y_m = 0.0, .yaw_rad = 0.0}}};
  CHECK(StandingPose(apart, 0.5).x_m == 0.25);  // the radius itself is within it
}

TEST_CASE("A robot turned away from the median of its first five rows by a tenth of a radian") {
  const auto yaw_rad = [](const std::vector<double>& first_rad, double then_rad) {
    Trajectory log;
    const auto add = [&](double at_rad) {
      log.poses.push_back({.t_s = static_cast<double>(log.poses.size()), .yaw_rad = at_rad});
    };
    for (const double one_rad : first_rad) add(one_rad);
    for (int i = 0; i < 20; ++i) add(then_rad);
    return StandingPose(log).yaw_rad;
  };
  for (const double side : {1.0, -1.0}) {
    const std::vector<double> five(5, 0.2);
    CHECK(yaw_rad(five, 0.2 + side * 0.095) == Approx(0.2 + side * 0.095));  // of most rows
    CHECK(yaw_rad(five, 0.2 + side * 0.105) == Approx(0.2));
    CHECK(yaw_rad({0.2, 0.2, 0.2}, 0.2 + side) == Approx(0.2));  // of the first five most stand
    CHECK(yaw_rad({0.2, 0.2}, 0.2 + side) == Approx(0.2 + side));
    // The first row may be away from the median, and no row that is turned away counts.
    CHECK(yaw_rad({0.2 + side * 0.06, 0.2, 0.2, 0.2, 0.2}, 0.2 - side * 0.07) ==
          Approx(0.2 - side * 0.07));
    CHECK(yaw_rad({0.18, 0.19, 0.2, 0.21, 0.22}, 0.2 + side) == Approx(0.2));
  }
}

TEST_CASE(
    "Angles of unknown unit are forgotten with the height, and look like degrees beyond a turn") {
  const auto log = [](const std::string& angles) {
    return ReadLog("t,x,y,z,roll,pitch,yaw\n0,0,0,1," + angles + "\n1,1,0,1," + angles + "\n",
                   "log");
  };
  for (const char* angles : {"6.2,0,0", "0,-6.2,0", "0,0,6.2"}) {
    const Log read = log(angles);
    CHECK(read.unknown_angles ==
          "its header does not tell degrees (tracker) from radians (webots)");
    for (const StampedPose& pose : read.trajectory.poses) {
      for (const double value : {pose.z_m, pose.roll_rad, pose.pitch_rad, pose.yaw_rad}) {
        CHECK(std::isnan(value));
      }
    }
  }
  for (const char* angles : {"6.3,0,0", "0,-6.3,0", "0,0,6.3"}) {
    CHECK_THAT(log(angles).unknown_angles, Contains("; an angle of 6.3 looks like degrees"));
  }
}

TEST_CASE("A format is refused where the header is another one's, whichever is asked for") {
  const std::string authors = "t,x,y\n0,0,0\n1,1,0\n", rift = "t_s,x_m,y_m\n0,0,0\n1,1,0\n",
                    tum = "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n";
  const auto refusal = [](const std::string& text, Format format) -> std::string {
    try {
      ReadLog(text, "log", format);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  for (const Format format : {Format::kTracker, Format::kWebots}) {
    CHECK(refusal(authors, format).empty());
    CHECK_THAT(refusal(rift, format), Contains("is of dialect rift, and the format asked for is"));
    CHECK_THAT(refusal(tum, format), Contains("is of dialect tum, and the format asked for is"));
  }
  CHECK(refusal(rift, Format::kRift).empty());
  CHECK(refusal(tum, Format::kTum).empty());
  CHECK_THAT(refusal(authors, Format::kRift),
             Contains("is of dialect tracker or webots, and the format asked for is rift"));
  CHECK_THAT(refusal(rift, Format::kTum), Contains("rift, and the format asked for is tum"));
}

TEST_CASE(
    "Cells without a header are told by their number, and small numbers that are zero refused") {
  CHECK_THROWS_WITH(ReadLog("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 o 1\n", "log", Format::kTum),
                    "log:2: column 7 is 'o': a finite number is expected");
  CHECK_THROWS_WITH(ReadLog("t_s,x_m,y_m\n0,0,0\n1,1e-400,0\n", "log"),
                    "log:3: column x_m is '1e-400': a finite number is expected");
  CHECK(csv::Shown("\xF7\xF8") == "\xF7\\xf8");
  CHECK_THROWS_WITH(ReadLog("t_s,x_m,y_m\r", "log"),
                    "log: 0 poses, and a trajectory needs at least 2");
  std::string header = "c0";
  for (int i = 1; i < 200; ++i) header += ", c" + std::to_string(i);
  try {
    ReadLog(header + "\n", "log", ReadOptions{.columns = "t=c0,x=c1,y=nowhere"});
    FAIL("read");
  } catch (const std::invalid_argument& error) {
    CHECK(std::string(error.what()) ==
          "log:1: columns: y is to be 'nowhere', and there is no such "
          "column: there are " +
              header.substr(0, 400));
  }
}

}  // namespace
}  // namespace rift::trajectory
