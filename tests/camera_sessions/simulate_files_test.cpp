// The start, the names and the files of a simulated run.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/simulate/pictures.hpp"
#include "rift/sessions/simulate/run.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paper_waypoints.hpp"
#include "support/processes/process.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Catch::Matchers::Contains;

experiment::Experiment ShortTask() {
  experiment::Experiment experiment;
  experiment.name = "short";
  experiment.waypoints = {{"start", 0.1, 0.2, 0.0, false}, {"end", 0.35, 0.22, {}, true}};
  return experiment;
}

Simulated MakeRun(const experiment::Experiment& experiment) {
  const sweep::Inputs inputs{[](const std::string& path) { return files::ReadIfThere(path); },
                             [](const std::string&) {}};
  const geometry::Pose2 start = experiment::TaskOf(experiment).Start();
  Simulated made{
      experiment, sweep::SimulatedTrialOf(experiment, start, 1, "short.yaml", inputs), {}};
  made.run = sweep::Simulate(made.trial);
  return made;
}

TEST_CASE("A start of three numbers moves the first waypoint alone, and turns it") {
  experiment::Experiment experiment = ShortTask();
  PutStart("-0.28,-0.06,90", experiment);
  CHECK(experiment.waypoints[0].x_m == -0.28);
  CHECK(experiment.waypoints[0].y_m == -0.06);
  CHECK(experiment.waypoints[0].name == "start");
  CHECK(experiment::TaskOf(experiment).Start().yaw_rad == Approx(geometry::kPi / 2.0));
  experiment.waypoints[0] = ShortTask().waypoints[0];
  CHECK(experiment::WriteExperiment(experiment) == experiment::WriteExperiment(ShortTask()));
}

TEST_CASE("A start of other than three numbers is refused with its words") {
  experiment::Experiment experiment = ShortTask();
  for (const char* text : {"1,2", "1,2,3,4", "", "1"}) {
    INFO(text);
    CHECK_THROWS_WITH(
        PutStart(text, experiment),
        std::string("--start '") + text + "': give X,Y,YAW_DEG, such as -0.28,-0.06,10");
  }
  CHECK_THROWS_WITH(PutStart("1,b,3", experiment), Contains("--start") && Contains("y"));
}

TEST_CASE("Each file of a run has its name in the folder, or beside the log that was named") {
  const RunFiles in("out/run"), beside("out/sim.csv");
  const std::vector<std::pair<fs::path RunFiles::*, std::string>> names{
      {&RunFiles::truth, "truth.csv"},
      {&RunFiles::commands, "commands.csv"},
      {&RunFiles::encoders, "encoders.csv"},
      {&RunFiles::experiment, "experiment.yaml"},
      {&RunFiles::summary, "summary.json"}};
  for (const auto& [member, name] : names) {
    CHECK(in.*member == "out/run/" + name);
    CHECK(beside.*member == "out/sim." + name);
  }
  CHECK(in.trajectory == "out/run/trajectory.csv");
  CHECK(beside.trajectory == "out/sim.csv");
}

TEST_CASE("No file of a run is one of its inputs, whichever it is") {
  const test::TemporaryFolder folder;
  const experiment::Experiment experiment = ShortTask();
  const RunFiles run(folder / "run");
  for (const fs::path& path :
       {run.trajectory, run.truth, run.commands, run.encoders, run.experiment, run.summary}) {
    INFO(path);
    CHECK_THROWS_WITH(CheckRunNames(folder / "run", experiment, {path}, {}, true),
                      Contains(path.string()) && Contains("is an input"));
    CHECK_THROWS_WITH(CheckRunNames(folder / "run", experiment, {}, {path}, true),
                      Contains(path.string()));
  }
  CHECK_NOTHROW(CheckRunNames(folder / "run", experiment, {folder / "in.csv"},
                              {folder / "figure.svg"}, false));
}

TEST_CASE("Whatever file of a run is there keeps another run from being written") {
  const experiment::Experiment experiment = ShortTask();
  for (const char* name : {"trajectory.csv", "truth.csv", "commands.csv", "encoders.csv",
                           "experiment.yaml", "summary.json"}) {
    const test::TemporaryFolder folder;
    const fs::path out = folder / "run";
    fs::create_directories(out);
    test::WriteText(out / name, "of another run");
    INFO(name);
    CHECK_THROWS_WITH(CheckRunNames(out, experiment, {}, {}, false), Contains(name));
    CHECK_NOTHROW(CheckRunNames(out, experiment, {}, {}, true));
  }
}

TEST_CASE("A figure beside a repeated run is not replaced without force") {
  const test::TemporaryFolder folder;
  const experiment::Experiment experiment = ShortTask();
  const fs::path out = folder / "run";
  fs::create_directories(out);
  test::WriteText(RunFiles(out).experiment, experiment::WriteExperiment(experiment));
  test::WriteText(folder / "figure.svg", "<svg/>");
  CHECK_THROWS_WITH(CheckRunNames(out, experiment, {}, {folder / "figure.svg"}, false),
                    Contains("figure.svg"));
  CHECK_NOTHROW(CheckRunNames(out, experiment, {}, {folder / "figure.svg"}, true));
}

TEST_CASE("A run is saved with each file holding what its name says") {
  const test::TemporaryFolder folder;
  const Simulated made = MakeRun(ShortTask());
  const trial::SteeringCheck check = CheckOf(made);
  const RunFiles files(folder / "run");
  SaveRun(files, made, check);
  CHECK(files::ReadFile(files.experiment) == experiment::WriteExperiment(made.experiment));
  CHECK(files::ReadFile(files.truth) == trajectory::WriteRift(made.run.truth));
  CHECK(files::ReadFile(files.trajectory) == trajectory::WriteRift(made.run.result.trajectory));
  CHECK(files::ReadFile(files.truth) != files::ReadFile(files.trajectory));
  CHECK(files::ReadFile(files.commands) == report::CommandsCsv(made.run.result));
  CHECK(nlohmann::json::parse(files::ReadFile(files.summary))["outcome"] == "reached");
  REQUIRE_FALSE(made.run.encoders.empty());
  CHECK(files::ReadFile(files.encoders) == odometry::EncodersCsv(made.run.encoders));
  Simulated blind = made;
  blind.run.encoders.clear();
  const RunFiles second(folder / "blind");
  SaveRun(second, blind, check);
  CHECK_FALSE(fs::exists(second.encoders));
  CHECK(fs::exists(second.trajectory));
}

TEST_CASE("A run that arrived directly has no cause and nothing to be tried") {
  const trial::SteeringCheck check = CheckOf(MakeRun(ShortTask()));
  CHECK(check.has_arrived);
  CHECK(check.causes.empty());
  CHECK(check.proposals.empty());
  CHECK_FALSE(check.tried_s);
}

/// The paper's waypoints as a file would set them, seed 7.
Simulated MakeLoaded(const std::vector<std::string>& overrides) {
  experiment::Experiment experiment =
      experiment::LoadExperiment("task.yaml", overrides, [](const std::string&) {
        return std::string(
            "waypoints: [{x: -0.28, y: -0.07, heading: -1}, {x: -0.07, y: -0.09, stop: true},"
            " {x: -0.1, y: 0.3, stop: true}, {x: 0.38, y: -0.06, stop: true}]\n");
      });
  return MakeRun(experiment);
}

TEST_CASE("A run is explained by the draw of the ensemble that it took") {
  const Simulated made =
      MakeLoaded({"ensemble.keys=[simulation.motor.dead_band]", "ensemble.draws=[[0.6]]"});
  CHECK(made.experiment.simulation.motor.dead_band == 0.1);
  const trial::SteeringCheck check = CheckOf(made);
  REQUIRE_FALSE(check.causes.empty());
  CHECK_THAT(check.causes[0], Contains("its wheels turn from 0.6 (simulation.motor.dead_band)"));
}

TEST_CASE("A speed proposed below the cruise speed brings that down with it") {
  const Simulated made =
      MakeLoaded({"simulation.motor.mismatch=0.3", "control.heading.p=0.01", "control.heading.d=0",
                  "control.cruise_speed=0.28", "control.w_max=0.05"});
  const trial::SteeringCheck check = CheckOf(made);
  CHECK_FALSE(check.has_arrived);
  CHECK_THAT(check.causes.at(0), Contains("it pulls to the"));
  CHECK((check.tried_s || check.failed_tries > 0));
}

TEST_CASE("Values that no experiment may have are not driven, and the run keeps its check") {
  Simulated made = MakeLoaded({"control.v_max=0.11", "control.v_min=0.05"});
  // As if a rule between keys were broken by whatever is proposed.
  made.experiment.control.w_min = 0.9;
  const trial::SteeringCheck check = CheckOf(made);
  CHECK_FALSE(check.causes.empty());
  CHECK(check.proposals.empty());
  CHECK(check.failed_tries == 1);
}

TEST_CASE("What is proposed for a robot that does not arrive is the same trial with other keys") {
  const std::string mistake =
      GENERATE(as<std::string>{}, "control.v_max=0.11", "control.pose_gate.max_speed_mps=0.1");
  std::vector<std::string> settings{mistake};
  if (mistake == "control.v_max=0.11") settings.emplace_back("control.v_min=0.05");
  const Simulated made = MakeLoaded(settings);
  const trial::SteeringCheck check = CheckOf(made);
  INFO(mistake);
  CHECK_FALSE(check.has_arrived);
  REQUIRE_FALSE(check.causes.empty());
  REQUIRE(check.tried_s);
  REQUIRE_FALSE(check.proposals.empty());
  for (const trial::KeyProposal& one : check.proposals) {
    settings.push_back(fmt::format("{}={:g}", one.key, one.value));
  }
  const Simulated again = MakeLoaded(settings);
  CHECK(again.run.result.outcome == trial::Outcome::kReached);
  CHECK(again.run.result.Duration_s() == *check.tried_s);
}

TEST_CASE("The ground in the figure of a run is that under its path, not beside it") {
  experiment::Experiment experiment = ShortTask();
  experiment.simulation.terrain.surface = "bump";  // a block every 0.06 m, 0.02 m wide
  Simulated made = MakeRun(experiment);
  const double between_m = 0.03, on_block_m = 0.06;
  made.run.truth.poses = {
      {.t_s = 0.0, .x_m = 0.0, .y_m = between_m, .z_m = 0.016, .yaw_rad = 0.0},
      {.t_s = 1.0, .x_m = 0.06, .y_m = on_block_m, .z_m = 0.02, .yaw_rad = 0.0}};
  const auto ground = [&] {
    const std::string plot = FigureOf(made).plot;
    const size_t from = plot.find("$ground");
    REQUIRE(from != std::string::npos);
    return plot.substr(from, plot.find("EOD", plot.find('\n', from)) - from);
  };
  CHECK_THAT(ground(), Contains("0.06 0.004 \n"));
  made.run.truth.poses[1].y_m = between_m;
  CHECK_THAT(ground(), Contains("0.06 0 \n") && !Contains(" 0.004 \n"));
}

TEST_CASE(
    "The figure of a run shows its name, its waypoints, its patches and the ground below it") {
  experiment::Experiment experiment = ShortTask();
  experiment.simulation.terrain.patches = {
      {.x_min_m = 0.15, .x_max_m = 0.2, .y_min_m = 0.05, .y_max_m = 0.4, .mu = 0.35}};
  const Simulated made = MakeRun(experiment);
  const report::Figure figure = FigureOf(made);
  CHECK_THAT(figure.title + figure.plot, Contains("short"));
  CHECK_THAT(figure.plot, Contains("start") && Contains("end") && Contains("mu 0.35"));
  const view::Film film = FilmOf(made);
  CHECK(film.fixed.title == "short on ground");
  REQUIRE(film.fixed.waypoints.size() == 2);
  CHECK(film.fixed.waypoints[0].name == "start");
  CHECK(film.fixed.waypoints[1].name == "end");
  REQUIRE(film.fixed.patches.size() == 1);
  CHECK(film.fixed.patches[0].label == "mu 0.35");
  CHECK(film.fixed.patches[0].x_min_m == 0.15);
  CHECK(film.fixed.patches[0].x_max_m == 0.2);
  CHECK(film.fixed.patches[0].y_min_m == 0.05);
  CHECK(film.fixed.patches[0].y_max_m == 0.4);
  CHECK(film.fixed.trail_m.size() == made.run.result.trajectory.poses.size());
  CHECK(film.scenes.back().outcome == made.run.result.reason);
  CHECK(film.scenes.back().world_from_robot.x_m ==
        Approx(made.run.truth.poses.back().x_m).margin(1e-9));
  CHECK(film.fixed.body.wheel_radius_m == view::ShapeOf(experiment.simulation.body).wheel_radius_m);
}

/// x of the ground in the figure of a run.
std::vector<double> GroundOf(const Simulated& made) {
  const std::string plot = FigureOf(made).plot;
  const std::string head = "$ground << EOD\n";
  REQUIRE(plot.find(head) != plot.npos);
  std::istringstream rows(plot.substr(plot.find(head) + head.size()));
  std::vector<double> x_m;
  for (std::string line; std::getline(rows, line) && line != "EOD";) {
    x_m.push_back(std::stod(line));
  }
  return x_m;
}

TEST_CASE("The ground below a run goes on ten centimetres beyond its ends, each 2 mm or less") {
  Simulated made = MakeRun(ShortTask());
  made.run.result.trajectory.poses.clear();
  for (const bool is_forward : {true, false}) {
    const double from_m = is_forward ? 0.15 : 0.211, to_m = is_forward ? 0.211 : 0.15;
    const double yaw_rad = is_forward ? 0.0 : geometry::kPi;
    made.run.truth.poses = {
        {.t_s = 0.0, .x_m = from_m, .y_m = 0.2, .z_m = 0.016, .yaw_rad = yaw_rad},
        {.t_s = 1.0, .x_m = from_m, .y_m = 0.2, .z_m = 0.016, .yaw_rad = yaw_rad},
        {.t_s = 2.0, .x_m = to_m, .y_m = 0.2, .z_m = 0.016, .yaw_rad = yaw_rad}};
    const std::vector<double> x_m = GroundOf(made);
    INFO(is_forward);
    CHECK(x_m.front() == Approx(is_forward ? 0.05 : 0.311));
    CHECK(x_m.back() == Approx(is_forward ? 0.311 : 0.05));
    for (size_t i = 1; i < x_m.size(); ++i) {
      const double step_m = (x_m[i] - x_m[i - 1]) * (is_forward ? 1.0 : -1.0);
      CHECK(step_m > 0.0018);
      CHECK(step_m < 0.002001);
    }
  }
}

}  // namespace
}  // namespace rift::sessions
