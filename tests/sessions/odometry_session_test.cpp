// Runs with their encoders, as they lie in folders and beside logs.
#include <catch2/catch.hpp>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sessions/gap/odometry.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trajectory/log.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

constexpr const char* kProgram = "program: {segments: [{straight_m: 1.0, power: 0.3}]}\n";

/// A metre ahead in five seconds.
std::string Log() {
  trajectory::Trajectory path;
  for (int i = 0; i <= 100; ++i) {
    path.poses.push_back({.t_s = 0.05 * i, .x_m = 0.01 * i, .y_m = 0.0, .yaw_rad = 0.0});
  }
  return trajectory::WriteRift(path);
}

/// As many readings as 0.5 s apart make; the right wheel ahead of the left one.
std::string Encoders(int left_per_s) {
  std::vector<odometry::EncoderReading> readings;
  for (int i = 0; i <= 10; ++i) {
    readings.push_back({0.5 * i, {left_per_s * i / 2, left_per_s * i / 2 + i}});
  }
  return odometry::EncodersCsv(readings);
}

TEST_CASE("Runs with the positions of one before them are left out, and that is said") {
  std::vector<LoadedRun> runs(4);
  for (size_t i = 0; i < runs.size(); ++i) {
    runs[i].run.log.name = std::string(1, static_cast<char>('a' + i));
    const double y_m = i == 1 ? 0.01 : 0.0;
    runs[i].run.log.camera.poses = {{.t_s = 0.0, .x_m = 0.0, .y_m = y_m},
                                    {.t_s = 1.0, .x_m = 1.0, .y_m = y_m}};
  }
  runs[3].run.log.camera.poses.back().x_m += 1e-4;  // a drive of its own
  std::vector<std::string> said;
  LeaveOutCopies(runs, [&said](const std::string& line) { said.push_back(line); });
  CHECK(said == std::vector<std::string>{"warning: c has the positions of a: it is left out"});
  REQUIRE(runs.size() == 3);
  CHECK(runs[0].run.log.name == "a");
  CHECK(runs[1].run.log.name == "b");
  CHECK(runs[2].run.log.name == "d");
}

TEST_CASE("A run that cannot be looked up is refused as an input that cannot be read") {
  const test::TemporaryFolder folder;
  fs::create_symlink("loop", folder / "loop");
  CHECK_THROWS_AS(LoadRun(folder / "loop", ""), std::invalid_argument);
  CHECK_THROWS_AS(LoadRun(std::string(5000, 'x'), ""), std::invalid_argument);
  test::WriteText(folder / "trajectory.csv", Log());
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  fs::create_symlink("experiment.yaml", folder / "experiment.yaml");
  CHECK_THROWS_WITH(LoadRun(folder.Path(), ""), Contains("experiment.yaml"));
}

TEST_CASE("A folder of a run is read from the three files in it") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "trajectory.csv", Log());
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  test::WriteText(folder / "experiment.yaml", kProgram);
  const LoadedRun run = LoadRun(folder.Path(), "");
  CHECK(run.files == std::vector<fs::path>{folder / "trajectory.csv", folder / "encoders.csv",
                                           folder / "experiment.yaml"});
  CHECK(run.run.log.name == folder.Path());
  CHECK(run.run.log.camera.poses.size() == 101);
  REQUIRE(run.run.log.encoders.size() == 11);
  CHECK(run.run.log.encoders[2].counts.left == 1000);
  CHECK(run.run.log.encoders[2].counts.right == 1002);
  REQUIRE(run.experiment);
  REQUIRE(run.run.program);
}

TEST_CASE("What is noted and doubted of a run's files is told with their names") {
  const test::TemporaryFolder folder;
  const auto notes = [&] { return LoadRun(folder.Path(), "").notes; };
  test::WriteText(folder / "trajectory.csv", Log());
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  CHECK(notes().empty());
  test::WriteText(folder / "trajectory.csv", Log() + "6,2");
  test::WriteText(folder / "encoders.csv", Encoders(1000) + "6,2");
  const std::string left_out = ": the last row was cut short while it was written: it is left out";
  CHECK(notes() == std::vector<std::string>{"note: " + (folder / "trajectory.csv") + left_out,
                                            "note: " + (folder / "encoders.csv") + left_out});
  trajectory::Trajectory fast = trajectory::ReadLog(Log(), "log").trajectory;
  for (auto& pose : fast.poses) pose.x_m *= 100.0;  // centimetres
  test::WriteText(folder / "trajectory.csv", trajectory::WriteRift(fast));
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  REQUIRE(notes().size() == 1);
  CHECK_THAT(notes()[0],
             Catch::Matchers::StartsWith("warning: " + (folder / "trajectory.csv") + ": "));
}

TEST_CASE("Beside a log its own files come first, then those that any run has") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "sim.csv", Log());
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  test::WriteText(folder / "experiment.yaml", kProgram);
  const LoadedRun shared = LoadRun(folder / "sim.csv", "");
  CHECK(shared.files == std::vector<fs::path>{folder / "sim.csv", folder / "encoders.csv",
                                              folder / "experiment.yaml"});
  CHECK(shared.run.log.encoders[2].counts.left == 1000);
  test::WriteText(folder / "sim.encoders.csv", Encoders(2000));
  test::WriteText(folder / "sim.experiment.yaml",
                  "program: {segments: [{straight_m: 0.5, power: 0.3}]}\n");
  const LoadedRun own = LoadRun(folder / "sim.csv", "");
  CHECK(own.files == std::vector<fs::path>{folder / "sim.csv", folder / "sim.encoders.csv",
                                           folder / "sim.experiment.yaml"});
  CHECK(own.run.log.encoders[2].counts.left == 2000);
  REQUIRE(own.run.program);
  CHECK(own.run.program->poses.back().x_m == Approx(0.5).margin(0.05));
}

TEST_CASE("A program that was named stands in the place of the run's own experiment") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "trajectory.csv", Log());
  test::WriteText(folder / "experiment.yaml", kProgram);
  test::WriteText(folder / "other.yaml", "program: {segments: [{straight_m: 0.5, power: 0.3}]}\n");
  const LoadedRun run = LoadRun(folder.Path(), folder / "other.yaml");
  REQUIRE(run.run.program);
  CHECK(run.run.program->poses.back().x_m == Approx(0.5).margin(0.05));
}

TEST_CASE(
    "Encoders are enough for a run of waypoints, and without them it is refused by its files") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "trajectory.csv", Log());
  test::WriteText(folder / "experiment.yaml",
                  "waypoints: [{x: 0, y: 0, heading: 0}, {x: 1, y: 0}]\n");
  CHECK_THROWS_WITH(LoadRun(folder.Path(), ""),
                    Contains("has neither encoders (" + (folder / "encoders.csv") + ")"));
  test::WriteText(folder / "encoders.csv", Encoders(1000));
  const LoadedRun run = LoadRun(folder.Path(), "");
  CHECK(run.experiment);
  CHECK_FALSE(run.run.program);
}

/// A loaded run of a program ahead, `way_m` long, without encoders.
LoadedRun RunOf(const test::TemporaryFolder& folder, const std::string& name, double way_m) {
  const fs::path run = folder.Path() / name;
  fs::create_directories(run);
  test::WriteText(run / "trajectory.csv", Log());
  test::WriteText(run / "experiment.yaml", "program: {segments: [{straight_m: " +
                                               std::to_string(way_m) + ", power: 0.3}]}\n");
  return LoadRun(run, "");
}

TEST_CASE("Runs of one program are a cell, and runs of two are not, whichever differs") {
  const test::TemporaryFolder folder;
  const LoadedRun a = RunOf(folder, "a", 1.0), b = RunOf(folder, "b", 1.0);
  const LoadedRun other = RunOf(folder, "c", 0.8);
  LoadedRun turned = b, late = b, none = b, spun = b;
  spun.run.program->poses.back().yaw_rad += 0.1;  // as of two programs that turn on the spot
  turned.run.program->poses.back().y_m += 0.1;
  late.run.program->poses.back().t_s += 1.0;
  none.run.program.reset();
  none.run.log.encoders = odometry::ReadEncoders(Encoders(1000), "e");
  const auto has_cell = [&](const LoadedRun& one, const LoadedRun& two) {
    return MeasureOdometry({one, two}, {}).cell.has_value();
  };
  CHECK(has_cell(a, b));
  CHECK_FALSE(has_cell(a, other));
  CHECK_FALSE(has_cell(a, turned));
  CHECK_FALSE(has_cell(a, late));
  CHECK_FALSE(has_cell(a, spun));
  CHECK_FALSE(has_cell(a, none));
  CHECK_FALSE(has_cell(none, a));
  CHECK_FALSE(has_cell(none, none));
}

TEST_CASE("The tag's place is that of each run's own experiment unless it was said") {
  const test::TemporaryFolder folder;
  LoadedRun run = RunOf(folder, "a", 1.0);
  run.run.log.camera.poses.back().yaw_rad = 1.2;  // at its end the axle lies beside the program's
  const LoadedRun other = run;
  run.experiment->simulation.mocap.tag_ahead_m = 0.25;
  OdometryJob job;
  const auto end_error_m = [&job](const std::vector<LoadedRun>& runs, size_t of) {
    return MeasureOdometry(runs, job).runs[of].measures.end_error_m;
  };
  const double own = end_error_m({run}, 0), on_axle = end_error_m({other}, 0);
  CHECK(own != on_axle);
  CHECK(end_error_m({other, run}, 1) == own);
  CHECK(end_error_m({run, other}, 1) == on_axle);
  job.tag_ahead_m = 0.05;
  const double said = end_error_m({run}, 0);
  CHECK(end_error_m({other, run}, 1) == said);
  CHECK(own != said);
  job.tag_ahead_m = 0.0;  // also where it is said to be on the axle
  CHECK(end_error_m({run}, 0) == on_axle);
  job.tag_ahead_m.reset();
  run.experiment->simulation.mocap.tag_ahead_m = 0.05;
  CHECK(end_error_m({run}, 0) == said);
}

TEST_CASE("The tag of a simulated run is where the draw of its ensemble had it") {
  const test::TemporaryFolder folder;
  const std::string with_draws = std::string(kProgram) +
                                 "simulation: {mocap: {tag_ahead_m: 0.01}}\n"
                                 "ensemble: {keys: [simulation.mocap.tag_ahead_m], "
                                 "draws: [[0.02], [0.03], [0.04], [0.05]]}\n";
  const auto tag_ahead_m = [](const std::string& run, const std::string& program = "") {
    return LoadRun(run, program).experiment->simulation.mocap.tag_ahead_m;
  };
  const auto write = [&](const std::string& log, const std::string& task, int seed) {
    test::WriteText(folder / log, Log());
    test::WriteText(folder / task, with_draws + "seed: " + std::to_string(seed) + "\n");
  };
  std::set<double> drawn_m;
  for (int seed = 1; seed <= 12; ++seed) {
    write("trajectory.csv", "experiment.yaml", seed);
    std::filesystem::remove(folder / "truth.csv");
    CHECK(tag_ahead_m(folder.Path()) == 0.01);  // the robot's own drive
    test::WriteText(folder / "truth.csv", Log());
    const experiment::Experiment whole =
        experiment::LoadExperiment(folder / "experiment.yaml", {}, files::ReadFile);
    const sweep::SimulatedTrial trial = sweep::SimulatedTrialOf(
        whole, {}, whole.seed, "e.yaml", {[](const std::string&) { return std::nullopt; }, {}});
    drawn_m.insert(trial.simulation.mocap.tag_ahead_m);
    CHECK(tag_ahead_m(folder.Path()) == trial.simulation.mocap.tag_ahead_m);
    CHECK(tag_ahead_m(folder / "trajectory.csv") == trial.simulation.mocap.tag_ahead_m);
    CHECK(tag_ahead_m(folder.Path(), folder / "experiment.yaml") == 0.01);  // of all runs
    write("sim.csv", "sim.experiment.yaml", seed);
    test::WriteText(folder / "sim.truth.csv", Log());
    CHECK(tag_ahead_m(folder / "sim.csv") == trial.simulation.mocap.tag_ahead_m);
  }
  CHECK(drawn_m.size() > 2);
}

TEST_CASE("Wheels are calibrated where that is asked for, over the runs with encoders alone") {
  const test::TemporaryFolder folder;
  // Ahead with the wheels of the defaults, from which the log is made.
  const odometry::OdometryOptions wheels;
  const double per_count_m = odometry::MetresPerCount(wheels);
  LoadedRun run = RunOf(folder, "a", 1.0), blind = RunOf(folder, "b", 1.0);
  trajectory::Trajectory camera;
  for (int i = 0; i <= 1000; ++i) {
    const int left = 10 * i, right = i < 500 ? 12 * i : 6000 + 8 * (i - 500);
    run.run.log.encoders.push_back({0.05 * i, {left, right}});
  }
  run.run.log.camera = odometry::OdometryPath(run.run.log.encoders, wheels, {});
  OdometryJob job;
  CHECK_FALSE(MeasureOdometry({run, blind}, job).calibration);
  job.calibrate = true;
  job.calibration.confidence = 0.8;
  const odometry::OdometryResult result = MeasureOdometry({run, blind}, job);
  REQUIRE(result.calibration);
  CHECK(result.calibration->runs == 1);
  CHECK(result.confidence == 0.8);
  CHECK(result.calibration->wheel_radius_m.value ==
        Approx(wheels.drive.wheel_radius_m).epsilon(1e-3));
  CHECK(result.runs.size() == 2);
  CHECK(per_count_m > 0.0);
  LoadedRun another = run;
  another.experiment->hardware.odometry.drive.wheel_radius_m *= 1.1;
  CHECK_THROWS_WITH(MeasureOdometry({run, another}, job), Contains("name different wheels"));
  job.calibrate = false;
  CHECK_NOTHROW(MeasureOdometry({run, another}, job));
}

TEST_CASE("Odometry is asked for by any of its three flags") {
  CHECK_FALSE(OdometryJob{}.IsAsked());
  CHECK(OdometryJob{.odometry = true}.IsAsked());
  CHECK(OdometryJob{.program = "a.yaml"}.IsAsked());
  CHECK(OdometryJob{.calibrate = true}.IsAsked());
}

TEST_CASE("The odometry of a run is that of the wheels of its experiment") {
  const test::TemporaryFolder folder;
  LoadedRun run = RunOf(folder, "a", 1.0);
  run.run.log.encoders = odometry::ReadEncoders(Encoders(1000), "e");
  const double before = MeasureOdometry({run}, {}).runs[0].measures.odometry_gap_m;
  run.experiment->hardware.odometry.counts_per_wheel_turn *= 2.0;  // half the way
  const double after = MeasureOdometry({run}, {}).runs[0].measures.odometry_gap_m;
  CHECK(before != after);
}

}  // namespace
}  // namespace rift::sessions
