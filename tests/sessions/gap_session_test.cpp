#include <catch2/catch.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "rift/sessions/gap/measure.hpp"
#include "rift/sessions/gap/odometry.hpp"
#include "rift/trajectory/log.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

using Catch::Matchers::Contains;

/// A metre ahead in steps of 1 cm, `off_m` beside the x axis at its end.
std::string Log(double off_m) {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    const double x_m = 0.01 * i;
    path.poses.push_back(
        {.t_s = 0.05 * i, .x_m = x_m, .y_m = off_m * x_m * x_m, .yaw_rad = 2.0 * off_m * x_m});
  }
  return trajectory::WriteRift(path);
}

struct Told {
  std::vector<std::string> lines{};

  std::string Text() const {
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    return text;
  }
};

gap::GapResult Measure(const GapJob& job, Told& told) {
  return MeasureGap(job, [&told](const std::string& line) { told.lines.push_back(line); });
}

TEST_CASE("Logs whose names say that their sides are exchanged are said to be swapped") {
  const test::TemporaryFolder folder;
  for (const char* name : {"sim_run.csv", "robot_run.csv", "a.csv"}) {
    test::WriteText(folder / name, Log(0.02));
  }
  const auto is_swapped = [&](const std::string& sim, const std::string& real) {
    Told told;
    Measure({.sim = folder / sim, .reals = {folder / real}}, told);
    return told.Text().find("by their names the two are swapped") != std::string::npos;
  };
  CHECK(is_swapped("robot_run.csv", "sim_run.csv"));
  CHECK_FALSE(is_swapped("sim_run.csv", "robot_run.csv"));
  CHECK_FALSE(is_swapped("a.csv", "sim_run.csv"));
  CHECK_FALSE(is_swapped("robot_run.csv", "a.csv"));
}

TEST_CASE("A dialect of the other side says that the logs are swapped") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", "t,x,y,yaw\n0,0,0,0\n1,0.1,0,0\n2,0.2,0.01,0\n");
  test::WriteText(folder / "b.csv", Log(0.02));
  Told told;
  GapJob job{.sim = folder / "a.csv", .reals = {folder / "b.csv"}};
  job.sides.sim_format = trajectory::Format::kTracker;
  Measure(job, told);
  CHECK_THAT(told.Text(), Contains("by their formats the two are swapped"));
}

TEST_CASE("Each repeat is compared and further runs of the simulator add the likeness") {
  const test::TemporaryFolder folder;
  for (const double off_m : {0.00, 0.01, 0.03, 0.04}) {
    test::WriteText(folder / (std::to_string(static_cast<int>(100.0 * off_m + 0.5)) + ".csv"),
                    Log(off_m));
  }
  Told told;
  GapJob job{.sim = folder / "0.csv", .reals = {folder / "3.csv", folder / "4.csv"}};
  const gap::GapResult result = Measure(job, told);
  REQUIRE(result.trials.size() == 2);
  CHECK(result.trials[0].comparison.gap_m < result.trials[1].comparison.gap_m);
  CHECK_FALSE(result.likeness);
  job.sim_repeats = {folder / "1.csv"};
  const gap::GapResult repeated = Measure(job, told);
  REQUIRE(repeated.likeness);
  CHECK(repeated.likeness->sims == 2);
  CHECK(repeated.likeness->reals == 2);
}

TEST_CASE("A robot that stands throughout is refused where standstill is trimmed, on both sides") {
  const test::TemporaryFolder folder;
  trajectory::Trajectory stands;
  for (int i = 0; i < 60; ++i) {
    stands.poses.push_back({.t_s = 0.05 * i, .x_m = i % 2 == 0 ? 0.0005 : 0.0, .y_m = 0.0});
  }
  test::WriteText(folder / "stands.csv", trajectory::WriteRift(stands));
  test::WriteText(folder / "drives.csv", Log(0.02));
  Told told;
  GapJob job{.sim = folder / "drives.csv", .reals = {folder / "stands.csv"}};
  CHECK_NOTHROW(Measure(job, told));
  job.options.trim_standstill = true;
  const std::string refusal = (folder / "stands.csv") +
                              ": never leaves --standstill-radius, 0.01 m, so that all of it is "
                              "standstill: leave --trim-standstill out, or name a smaller radius";
  CHECK_THROWS_WITH(Measure(job, told), refusal);
  std::swap(job.sim, job.reals.front());
  CHECK_THROWS_WITH(Measure(job, told), refusal);
  GapJob repeats = job;
  test::WriteText(folder / "beside.csv", Log(0.04));
  repeats.sim = folder / "beside.csv";
  repeats.sim_repeats = {folder / "stands.csv"};
  CHECK_THROWS_WITH(Measure(repeats, told), refusal);
  job.options.standstill_radius_m = 0.0004;
  CHECK_NOTHROW(Measure(job, told));
}

TEST_CASE("A real log that was copied counts once in the likeness too") {
  const test::TemporaryFolder folder;
  for (const char* name : {"a.csv", "copy.csv"}) test::WriteText(folder / name, Log(0.03));
  test::WriteText(folder / "b.csv", Log(0.05));
  test::WriteText(folder / "sim.csv", Log(0.0));
  test::WriteText(folder / "sim2.csv", Log(0.01));
  Told told;
  GapJob job{.sim = folder / "sim.csv",
             .reals = {folder / "a.csv", folder / "b.csv"},
             .sim_repeats = {folder / "sim2.csv"}};
  const gap::GapResult alone = Measure(job, told);
  job.reals.push_back(folder / "copy.csv");
  const gap::GapResult with_copy = Measure(job, told);
  CHECK(with_copy.likeness->reals == 2);
  CHECK(with_copy.likeness->spread_m.real == alone.likeness->spread_m.real);
  CHECK(with_copy.likeness->mean_gap_m == alone.likeness->mean_gap_m);
}

TEST_CASE("A log that is named twice is refused under whatever name") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "a.csv", Log(0.0));
  test::WriteText(folder / "b.csv", Log(0.0));
  CHECK_NOTHROW(RefuseTwins({folder / "a.csv", folder / "b.csv"}));
  std::filesystem::create_symlink(folder / "a.csv", folder / "c.csv");
  CHECK_THROWS_WITH(RefuseTwins({folder / "a.csv", folder / "b.csv", folder / "c.csv"}),
                    Contains("c.csv are one log"));
}

TEST_CASE("A run is refused that has neither encoders nor a program to be held against") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "trajectory.csv", Log(0.0));
  CHECK_THROWS_WITH(LoadRun(folder.Path(), ""), Contains("has neither encoders"));
  test::WriteText(folder / "program.yaml",
                  "program: {segments: [{straight_m: 1.0, power: 0.3}]}\n");
  const LoadedRun run = LoadRun(folder.Path(), folder / "program.yaml");
  REQUIRE(run.run.program);
  CHECK(run.run.program->poses.back().x_m == Approx(1.0).margin(0.05));
  CHECK(run.files.front() == folder / "trajectory.csv");
  test::WriteText(folder / "task.yaml", "waypoints: [{x: 0, y: 0, heading: 0}, {x: 1, y: 0}]\n");
  CHECK_THROWS_WITH(LoadRun(folder.Path(), folder / "task.yaml"), Contains("has no program"));
}

}  // namespace
}  // namespace rift::sessions
