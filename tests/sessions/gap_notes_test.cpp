// What a comparison of logs says of them: where they look exchanged, mended or doubtful.
#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/sessions/gap/measure.hpp"
#include "rift/trajectory/log.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

using Catch::Matchers::Contains;
using trajectory::Format;

/// Two metres along a gentle curve, `noise_m` to and fro at each row and every third row
/// `late_s` late.
std::string Log(double noise_m, double late_s, double off_m = 0.0) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double x_m = 0.02 * i;
    path.poses.push_back({.t_s = 0.05 * i + (i % 3 == 0 ? late_s : 0.0),
                          .x_m = x_m,
                          .y_m = off_m + 0.1 * x_m * x_m + (i % 2 == 0 ? noise_m : -noise_m),
                          .yaw_rad = std::atan(0.2 * x_m)});
  }
  return trajectory::WriteRift(path);
}

/// Columns of the authors, whose angles nobody knows the unit of.
std::string AuthorsLog() {
  return "t,x,y,z,roll,pitch,yaw\n0,0,0,0,0,0,0\n1,0.5,0.02,0,0,0,4\n2,1,0.06,0,0,0,8\n";
}

std::vector<std::string> TellOf(const GapJob& job) {
  std::vector<std::string> lines;
  MeasureGap(job, [&lines](const std::string& line) { lines.push_back(line); });
  return lines;
}

std::string TextOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// By what the two logs are said to be swapped; empty where they are not.
std::string SwappedBy(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) {
    const size_t by = line.find("by their ");
    if (by != line.npos) return line.substr(by + 9, line.find(" the two") - by - 9);
  }
  return "";
}

TEST_CASE("Every word for a simulator and for a robot tells by the name of a log which it is") {
  const test::TemporaryFolder folder;
  const auto swapped_by = [&](const std::string& sim, const std::string& real) {
    test::WriteText(folder / sim, Log(0.0, 0.0));
    test::WriteText(folder / real, Log(0.0, 0.0, 0.01));
    return SwappedBy(TellOf({.sim = folder / sim, .reals = {folder / real}}));
  };
  for (const std::string simulated : {"sim", "webots", "gazebo", "mujoco"}) {
    for (const std::string real : {"real", "robot", "tracker", "mocap"}) {
      INFO(simulated << " " << real);
      CHECK(swapped_by(real + ".csv", simulated + ".csv") == "names");
      CHECK(swapped_by(simulated + ".csv", real + ".csv").empty());
    }
  }
  SECTION("a name with a word of each kind tells nothing, on either side") {
    CHECK(swapped_by("sim_of_robot.csv", "sim.csv").empty());
    CHECK(swapped_by("robot.csv", "sim_as_tracker.csv").empty());
  }
  SECTION("the folder is no part of the name") {
    std::filesystem::create_directories(folder / "robot");
    std::filesystem::create_directories(folder / "sim");
    CHECK(swapped_by("robot/a.csv", "sim/b.csv").empty());
  }
}

TEST_CASE("The warning of swapped logs names both of them, the simulator's first") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "robot.csv", Log(0.0, 0.0));
  test::WriteText(folder / "sim.csv", Log(0.0, 0.0, 0.01));
  const std::vector<std::string> lines =
      TellOf({.sim = folder / "robot.csv", .reals = {folder / "sim.csv"}});
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "warning: " + (folder / "robot.csv") + " and " + (folder / "sim.csv") +
                        ": by their names the two are swapped: the simulator's log comes first");
}

TEST_CASE(
    "The tracker's format of SIM and the simulator's of REAL each tell that they are swapped") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "authors.csv", AuthorsLog());
  test::WriteText(folder / "own.csv", Log(0.0, 0.0));
  const auto swapped_by = [&](Format sim, Format real) {
    GapJob job{.sim = folder / (sim == Format::kAuto ? "own.csv" : "authors.csv"),
               .reals = {folder / (real == Format::kAuto ? "own.csv" : "authors.csv")}};
    job.sides.sim_format = sim;
    job.sides.real_format = real;
    return SwappedBy(TellOf(job));
  };
  CHECK(swapped_by(Format::kTracker, Format::kAuto) == "formats");
  CHECK(swapped_by(Format::kAuto, Format::kWebots) == "formats");
  CHECK(swapped_by(Format::kWebots, Format::kAuto).empty());
  CHECK(swapped_by(Format::kAuto, Format::kTracker).empty());
}

TEST_CASE(
    "Noise on the simulator's side alone tells that the logs are swapped, but not of a truth") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "rough.csv", Log(0.002, 0.01));
  test::WriteText(folder / "smooth.csv", Log(0.0, 0.0));
  test::WriteText(folder / "truth.csv", Log(0.0, 0.0));
  const auto swapped_by = [&](const std::string& sim, const std::string& real) {
    return SwappedBy(TellOf({.sim = folder / sim, .reals = {folder / real}}));
  };
  CHECK(swapped_by("rough.csv", "smooth.csv") == "noise");
  CHECK(swapped_by("smooth.csv", "rough.csv").empty());
  CHECK(swapped_by("smooth.csv", "truth.csv").empty());
  CHECK(swapped_by("rough.csv", "truth.csv").empty());
  // Of several repeats the one that the warning names tells.
  test::WriteText(folder / "rough2.csv", Log(0.002, 0.01, 0.01));
  const auto first_of = [&](const std::string& first, const std::string& second) {
    return SwappedBy(
        TellOf({.sim = folder / "rough.csv", .reals = {folder / first, folder / second}}));
  };
  CHECK(first_of("smooth.csv", "rough2.csv") == "noise");
  CHECK(first_of("rough2.csv", "smooth.csv").empty());
}

TEST_CASE("A pair that is doubtful is named, with the threshold where its gap is above it") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "one.csv", Log(0.0, 0.0));
  test::WriteText(folder / "near.csv", Log(0.0, 0.0, 0.05));
  test::WriteText(folder / "far.csv", Log(0.0, 0.0, 1.0));
  std::string copy = Log(0.0, 0.0);
  test::WriteText(folder / "same.csv", copy);
  GapJob job{.sim = folder / "one.csv", .reals = {folder / "near.csv", folder / "same.csv"}};
  const std::vector<std::string> lines = TellOf(job);
  REQUIRE(lines.size() == 1);
  CHECK(lines[0] == "warning: SIM " + (folder / "one.csv") + " and REAL " + (folder / "same.csv") +
                        ": SIM and REAL are the same log: name the robot's own");
  // A copy of a real log.
  test::WriteText(folder / "again.csv", Log(0.0, 0.0, 0.05));
  job.reals = {folder / "near.csv", folder / "again.csv"};
  CHECK(TellOf(job) ==
        std::vector<std::string>{"warning: " + (folder / "again.csv") + " has the positions of " +
                                 (folder / "near.csv") + ": they count as one repeat"});
  // Minutes for seconds, and a gap of a metre.
  trajectory::Trajectory slow = trajectory::ReadLog(Log(0.0, 0.0, 1.0), "far").trajectory;
  for (trajectory::StampedPose& pose : slow.poses) pose.t_s *= 60.0;
  test::WriteText(folder / "far.csv", trajectory::WriteRift(slow));
  job.reals = {folder / "far.csv"};
  job.options.threshold_m = 0.25;
  CHECK_THAT(TextOf(TellOf(job)), Contains("and REAL " + (folder / "far.csv") +
                                           ", whose gap is above 0.25 m: their clocks differ"));
  job.options.threshold_m = 2.0;
  CHECK_THAT(TextOf(TellOf(job)),
             Contains("and REAL " + (folder / "far.csv") + ": their clocks differ"));
}

TEST_CASE("A simulated run that repeats another, or a real one, is said to") {
  const test::TemporaryFolder folder;
  const auto write = [&](const char* name, double off_m) {
    test::WriteText(folder / name, Log(0.0, 0.0, off_m));
    return folder / name;
  };
  const std::string sim = write("one.csv", 0.0), near = write("near.csv", 0.05),
                    far = write("far.csv", 0.02), again = write("again.csv", 2e-6),
                    near_again = write("near_again.csv", 0.05 + 2e-6);
  GapJob job{.sim = sim, .reals = {near}, .sim_repeats = {far}};
  CHECK(TellOf(job).empty());
  job.sim_repeats = {far, again};
  CHECK(TellOf(job) ==
        std::vector<std::string>{"warning: " + again + " has the positions of " + sim +
                                 ": a file that was copied, or a simulator without chance"});
  job.sim_repeats = {far, near_again};
  CHECK(TellOf(job) ==
        std::vector<std::string>{"warning: --sim-repeats " + near_again +
                                 " has the positions of REAL " + near + ": no simulated run"});
}

TEST_CASE("What was mended in a log of either side is a note with its path and what to set") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "authors.csv", AuthorsLog());
  test::WriteText(folder / "own.csv", Log(0.0, 0.0));
  // A row twice at one time, and one that has no yaw.
  test::WriteText(folder / "mended.csv",
                  "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n1,0.5,0.02,\n1,0.5,0.02,\n2,1,0.1,0.2\n");
  const auto told = [&](const std::string& sim, const std::string& real) {
    return TextOf(TellOf({.sim = folder / sim, .reals = {folder / real}}));
  };
  const std::string unknown = "note: " + (folder / "authors.csv") + ": yaw errors are left out: ";
  CHECK_THAT(told("authors.csv", "own.csv"), Contains(unknown) && Contains(": set --sim-format\n"));
  CHECK_THAT(told("own.csv", "authors.csv"),
             Contains(unknown) && Contains(": set --real-format\n"));
  CHECK_THAT(told("own.csv", "own.csv"), !Contains("yaw errors"));
  for (const bool is_sim : {true, false}) {
    const std::string text = is_sim ? told("mended.csv", "own.csv") : told("own.csv", "mended.csv");
    INFO(text);
    CHECK_THAT(text, Contains("note: " + (folder / "mended.csv") +
                              ":3: has no yaw: yaw errors are told where it is logged\n"));
    CHECK_THAT(text, Contains("note: " + (folder / "mended.csv") + ": "));
  }
}

TEST_CASE("Columns that were guessed are a note with the flag of their side") {
  const test::TemporaryFolder folder;
  std::string text = Log(0.0, 0.0, 0.01);
  text.replace(0, text.find('\n'), "time,x,y,z,roll,pitch,yaw,target_x,target_y");
  test::WriteText(folder / "own.csv", Log(0.0, 0.0));
  test::WriteText(folder / "other.csv", text);
  GapJob job{.sim = folder / "own.csv", .reals = {folder / "other.csv"}};
  job.sides.real_units = "m";
  const std::string columns = "t=time,x=x,y=y,yaw=yaw'";
  const std::string said =
      "note: " + (folder / "other.csv") + ": read as --real-columns '" + columns;
  CHECK(TellOf(job) == std::vector<std::string>{said});
  job.sides = {.units = "mm"};  // of both, each of which is read in columns of its own
  const std::vector<std::string> lines = TellOf(job);
  REQUIRE(lines.size() >= 2);
  CHECK(lines[0] == "note: " + (folder / "own.csv") +
                        ": read as --sim-columns 't=t_s,x=x_m:m,y=y_m:m,yaw=yaw_rad'");
  CHECK_THAT(TextOf(lines), Contains(said));
}

TEST_CASE("What makes a single log doubtful is a warning with its path") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "own.csv", Log(0.0, 0.0));
  trajectory::Trajectory fast = trajectory::ReadLog(Log(0.0, 0.0), "fast").trajectory;
  for (trajectory::StampedPose& pose : fast.poses) pose.t_s *= 1e-3;
  test::WriteText(folder / "fast.csv", trajectory::WriteRift(fast));
  for (const bool is_sim : {true, false}) {
    GapJob job{.sim = folder / (is_sim ? "fast.csv" : "own.csv"),
               .reals = {folder / (is_sim ? "own.csv" : "fast.csv")}};
    CHECK_THAT(TextOf(TellOf(job)), Contains("warning: " + (folder / "fast.csv") + ": "));
  }
}

}  // namespace
}  // namespace rift::sessions
