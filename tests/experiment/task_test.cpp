// The task of an experiment, and what is asked of it before a robot is driven.
#include "rift/experiment/task.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/yaml/node.hpp"

namespace rift::experiment {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;

Experiment Load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return LoadExperiment("task.yaml", overrides, [&](const std::string&) { return text; });
}

Experiment Way(double x_m, double y_m) {
  Experiment experiment;
  experiment.waypoints = {{"start", 0.0, 0.0, 0.0, true}, {"end", x_m, y_m, {}, true}};
  return experiment;
}

TEST_CASE("A task is a program or waypoints, and one of them is needed") {
  CHECK_THROWS_WITH(RequireWaypoints({}, "robot.yaml"),
                    Contains("robot.yaml: it has no waypoints") &&
                        Contains("include: [robot.yaml, configs/waypoints/paper.yaml]"));
  CHECK_NOTHROW(RequireWaypoints(Way(1, 0), "a.yaml"));
  Experiment program;
  program.program.segments = {{.straight_m = 1.0, .power = 0.3}};
  CHECK_NOTHROW(RequireWaypoints(program, "a.yaml"));
  CHECK_NOTHROW(RequireTask(Way(1, 0), "a.yaml"));
  Experiment nowhere = Way(1, 0);
  nowhere.waypoints.resize(1);
  CHECK_THROWS_WITH(RequireTask(nowhere, "a.yaml"), Catch::StartsWith("a.yaml: "));
}

TEST_CASE("Names of an experiment, its waypoints and trials with a line break are refused") {
  const std::string way = "waypoints: [{x: 0, y: 0}, {name: b, x: 1, y: 0}]\n";
  CHECK_NOTHROW(Load("name: a\n" + way + "reference: {trials: [c]}\n"));
  CHECK_THROWS_WITH(Load("name: \"a\\nb\"\n" + way),
                    "task.yaml: name is 'a\\nb': names have no line breaks");
  CHECK_THROWS_WITH(Load("waypoints: [{x: 0, y: 0}, {name: \"b\\rc\", x: 1, y: 0}]\n"),
                    Contains("the name of a waypoint is 'b\\x0dc'"));
  CHECK_THROWS_WITH(Load(way + "reference: {trials: [\"c\\n\"]}\n"),
                    Contains("a trial of reference.trials is 'c\\n'"));
}

TEST_CASE("Headings of later waypoints, which no controller turns to, are told") {
  Experiment experiment = Way(1, 0);
  experiment.waypoints[0].heading_deg = 90.0;
  CHECK(TaskNotes(experiment, "a.yaml").empty());
  experiment.waypoints[1].heading_deg = 45.0;
  CHECK(TaskNotes(experiment, "a.yaml") ==
        std::vector<std::string>{
            "note: a.yaml: waypoints[1] (end) at x 1 m, y 0 m has heading 45, and only that of the "
            "first waypoint is driven: it does nothing"});
  experiment.waypoints.push_back({"last", 2.0, 0.0, 30.0, true});
  REQUIRE(TaskNotes(experiment, "a.yaml").size() == 1);
  CHECK_THAT(TaskNotes(experiment, "a.yaml")[0], Contains("waypoints[1]"));
  CHECK(TaskNotes({}, "a.yaml").empty());
}

TEST_CASE("A waypoint within the reach radius of the one before it is told, the first of them") {
  Experiment experiment = Way(1, 0);
  experiment.control.reach_radius_m = 1.0;
  CHECK(TaskNotes(experiment, "a.yaml").empty());
  experiment.control.reach_radius_m = 1.01;
  experiment.waypoints.push_back(experiment.waypoints.back());
  CHECK(TaskNotes(experiment, "a.yaml") ==
        std::vector<std::string>{"note: a.yaml: waypoints[1] (end) at x 1 m, y 0 m lies 1 m from "
                                 "the waypoint before it, within control.reach_radius_m, 1.01 m: "
                                 "it counts as reached without a move"});
  experiment.control.reach_radius_m = 0.01;
  CHECK(TaskNotes(experiment, "a.yaml") ==
        std::vector<std::string>{"note: a.yaml: waypoints[2] (end) at x 1 m, y 0 m lies 0 m from "
                                 "the waypoint before it, within control.reach_radius_m, 0.01 m: "
                                 "it counts as reached without a move"});
}

TEST_CASE("Two waypoints of one name are told where they are two places") {
  Experiment experiment = Way(1, 0);
  const std::string name = experiment.waypoints[0].name;
  REQUIRE_FALSE(name.empty());
  experiment.waypoints.push_back({name, 0.0, 0.0, {}, true});  // back to the start
  CHECK(TaskNotes(experiment, "a.yaml").empty());
  experiment.waypoints.push_back({name, 0.0, 2.0, {}, true});
  CHECK(TaskNotes(experiment, "a.yaml") ==
        std::vector<std::string>{"note: a.yaml: waypoints[3] (" + name +
                                 ") at x 0 m, y 2 m has the name of waypoints[0] (" + name +
                                 ") at x 0 m, y 0 m: results name both alike"});
  for (control::Waypoint& waypoint : experiment.waypoints) waypoint.name.clear();
  CHECK(TaskNotes(experiment, "a.yaml").empty());
}

TEST_CASE("A control period too short for the serial line is told with the one that is not") {
  Experiment experiment = Way(1, 0);
  experiment.simulation.link.baud = 10000.0;
  experiment.trial.control_period_s = 0.01;
  CHECK_FALSE(FullLineNote(experiment));
  experiment.trial.control_period_s = 0.008;
  CHECK(FullLineNote(experiment) ==
        "note: trial.control_period_s, 0.008 s, sends 125 commands a second, and "
        "simulation.link.baud 10000 takes 100: they queue up and come later and later; from 0.01 s "
        "on they do not");
  experiment.simulation.link.baud = 0.0;  // no line time
  CHECK_FALSE(FullLineNote(experiment));
}

TEST_CASE("A trial that ends before its first power is told") {
  Experiment experiment = Way(1, 0);
  experiment.trial.settle_s = 19.9;
  experiment.trial.timeout_s = 20.0;
  CHECK(TaskNotes(experiment, "a.yaml").empty());
  experiment.trial.settle_s = 20.0;
  CHECK(TaskNotes(experiment, "a.yaml") ==
        std::vector<std::string>{"note: a.yaml: trial.settle_s, 20 s, is not below "
                                 "trial.timeout_s, 20 s: the power is zero until the trial ends"});
}

TEST_CASE("A surface's own host is told where the camera has none") {
  Experiment experiment;
  CHECK_FALSE(IdleHostNote(experiment));
  experiment.simulation.terrain.surfaces["downhill"].host_period_s = 0.051;
  CHECK_FALSE(IdleHostNote(experiment));  // on the ground it is not asked for
  experiment.simulation.terrain.surface = "downhill";
  CHECK(IdleHostNote(experiment) ==
        "note: simulation.terrain.surfaces.downhill.host_period_s is 0.051, and does nothing while "
        "simulation.mocap.host_period_s is none: set that too");
  experiment.simulation.mocap.host_period_s = 0.06;
  CHECK_FALSE(IdleHostNote(experiment));
  experiment.simulation.mocap.host_period_s.reset();
  experiment.space.parameters = {
      {.key = "simulation.terrain.surface", .levels = {{"ground", {}}, {"bump", {}}}}};
  CHECK_FALSE(IdleHostNote(experiment));
  experiment.space.parameters[0].levels.push_back({"downhill", {}});
  CHECK(IdleHostNote(experiment));
  experiment.space.parameters.push_back({.key = "simulation.mocap.host_period_s"});
  CHECK_FALSE(IdleHostNote(experiment));
}

TEST_CASE("A program starts at the one waypoint there may be, turned by its heading") {
  Experiment experiment;
  experiment.program.segments = {{.straight_m = 1.0, .power = 0.3}};
  CHECK(TaskOf(experiment).Start().x_m == 0.0);
  CHECK(TaskOf(experiment).Start().yaw_rad == 0.0);
  experiment.waypoints = {{"start", 0.5, -0.25, 90.0, true}};
  CHECK(TaskOf(experiment).Start().x_m == 0.5);
  CHECK(TaskOf(experiment).Start().y_m == -0.25);
  CHECK(TaskOf(experiment).Start().yaw_rad == Approx(geometry::kPi / 2.0));
  experiment.waypoints.push_back(experiment.waypoints[0]);
  CHECK_THROWS_WITH(TaskOf(experiment), Contains("2 waypoints beside a program"));
}

TEST_CASE("A simulated robot is put down with its tag on the start, its axle behind or ahead") {
  Experiment experiment;
  experiment.waypoints = {{"start", 0.5, -0.25, 90.0, true}, {"end", 0.5, 0.25, {}, true}};
  for (const double tag_ahead_m : {-0.028, 0.0, 0.05}) {
    experiment.simulation.mocap.tag_ahead_m = tag_ahead_m;
    const geometry::Pose2 axle = AxleAtStart(experiment);
    CHECK(axle.x_m == Approx(0.5));
    CHECK(axle.y_m == Approx(-0.25 - tag_ahead_m));
    CHECK(axle.yaw_rad == Approx(geometry::kPi / 2.0));
  }
}

TEST_CASE("A program has to end before its trial does, with settling and rest") {
  Experiment experiment;
  experiment.program.segments = {{.straight_m = 0.1, .power = 0.3}, {.hold_s = 10.0}};
  const double driven_s =
      control::Program(experiment.program, experiment.hardware.odometry.drive, {}).Duration_s();
  experiment.program.rest_s = 2.0;
  experiment.trial.settle_s = 1.5;
  experiment.trial.timeout_s = driven_s + 3.6;
  CHECK_NOTHROW(TaskOf(experiment));
  experiment.trial.timeout_s = driven_s + 3.5;
  CHECK_THROWS_WITH(
      TaskOf(experiment),
      Contains("the program takes 1") && Contains("with settling and rest, and trial.timeout_s"));
}

TEST_CASE("A waypoint outside of the arena is named by its number and place") {
  Experiment experiment = Way(0.5, 0.25);
  CHECK_NOTHROW(RequireReachableWaypoints(experiment, "a.yaml"));
  experiment.trial.arena.x_max_m = 0.4;
  CHECK_THROWS_WITH(RequireReachableWaypoints(experiment, "a.yaml"),
                    Contains("a.yaml: waypoints[1] (end) at x 0.5 m, y 0.25 m lies outside "
                             "trial.arena"));
  experiment.waypoints[1].name.clear();
  CHECK_THROWS_WITH(RequireReachableWaypoints(experiment, "a.yaml"),
                    Contains("waypoints[1] at x 0.5 m, y 0.25 m lies"));
}

TEST_CASE("Waypoints that no robot reaches in time are taken for millimetres, near ones never") {
  const auto check = [](double x_m, double y_m, double timeout_s, int times = 1) {
    Experiment experiment = Way(x_m, y_m);
    const std::vector<control::Waypoint> there_and_back = experiment.waypoints;
    for (int i = 1; i < times; ++i) {
      experiment.waypoints.insert(experiment.waypoints.end(), there_and_back.begin(),
                                  there_and_back.end());
    }
    experiment.trial.timeout_s = timeout_s;
    auto& arena = experiment.trial.arena;
    arena.x_min_m = arena.y_min_m = -1000.0;
    arena.x_max_m = arena.y_max_m = 1000.0;
    RequireReachableWaypoints(experiment, "a.yaml");
  };
  // 5 m/s over the time of a trial.
  CHECK_NOTHROW(check(100.0, 0.0, 20.0));
  CHECK_THROWS_WITH(check(101.0, 0.0, 20.0), Contains("101 m apart in all, as far as 101 m out") &&
                                                 Contains("trial.timeout_s, 20 s"));
  CHECK_THROWS(check(0.0, -101.0, 20.0));
  CHECK_THROWS(check(-101.0, 0.0, 20.0));
  CHECK_NOTHROW(check(19.9, 0.0, 1.0));  // slow, but below a camera
  CHECK_THROWS(check(20.0, 0.0, 1.0));
  // Along all legs: there, back and there again.
  CHECK_NOTHROW(check(33.0, 0.0, 20.0, 2));
  CHECK_THROWS_WITH(check(34.0, 0.0, 20.0, 2), Contains("102 m apart in all, as far as 34 m out"));
}

TEST_CASE("The tag is held to the floor that the surface's shape allows") {
  const auto ground_on = [](const std::string& surface, vision::Ground said) {
    Experiment experiment;
    experiment.simulation.terrain.surface = surface;
    experiment.track.tag.ground = said;
    return TagOn(experiment).ground;
  };
  using vision::Ground;
  CHECK(ground_on("ground", Ground::kFlat) == Ground::kFlat);
  CHECK(ground_on("bump", Ground::kFlat) == Ground::kBumps);
  CHECK(ground_on("uphill", Ground::kFlat) == Ground::kFree);
  CHECK(ground_on("nowhere", Ground::kFlat) == Ground::kFlat);
  CHECK(ground_on("bump", Ground::kFree) == Ground::kFree);
  CHECK(ground_on("uphill", Ground::kBumps) == Ground::kBumps);
}

TEST_CASE("Values of an experiment by their keys are one line each") {
  Experiment experiment = Way(0.5, 0.25);
  const auto values = FlatValues(experiment);
  CHECK(values.at("gap.threshold_m") == "0.06");
  CHECK(values.at("goal") == "grid");
  CHECK(values.at("waypoints").find('\n') == std::string::npos);
  CHECK(values.at("waypoints").find("  ") == std::string::npos);
  CHECK_THAT(values.at("waypoints"), Contains("0.25"));
  for (const auto& [key, value] : values) {
    INFO(key);
    CHECK((value.empty() || (value.front() != ' ' && value.back() != ' ')));
  }
}

TEST_CASE("Every key is described with its type, default, help and the step of a person") {
  const std::string keys = DescribeKeys();
  const auto of = [&](const std::string& key) {
    const size_t at = ("\n" + keys).find("\n" + key + ": ");
    REQUIRE(at != std::string::npos);
    return keys.substr(at, keys.find('\n', keys.find('\n', at) + 1) - at);
  };
  CHECK_THAT(of("control.v_min"), Contains("(a person can set it on the robot, in steps of 0.01)"));
  CHECK_THAT(of("control.derivative_kick"), Catch::EndsWith("(a person can set it on the robot)"));
  CHECK_THAT(of("simulation.motor.mismatch"), !Contains("a person can set it"));
  CHECK_THAT(of("gap.threshold_m"), Contains("[0.06]") && Contains("\n    a gap above this"));
  CHECK_THAT(of("seed"), !Contains("a person can set it"));
}

TEST_CASE(
    "A picture of a heightfield and paths of logs are made absolute where a file names them") {
  const Experiment experiment = Load(
      "simulation: {terrain: {surfaces: {hill: {shape: heightfield, image: hill.png}}}}\n"
      "candidate: {kind: logs, path: sim.csv}\nreference: {kind: logs, path: sub/../real.csv}\n");
  const std::string here = std::filesystem::current_path().string();
  CHECK(experiment.simulation.terrain.surfaces.at("hill").image == here + "/hill.png");
  CHECK(experiment.candidate.path.text == here + "/sim.csv");
  CHECK(experiment.reference.path.text == here + "/real.csv");
  CHECK(Load("waypoints: []\n").candidate.path.text.empty());
}

TEST_CASE("Pictures that a space varies lie beside the file that names them") {
  const auto pictures = [](const std::string& space, const std::vector<std::string>& overrides) {
    const std::string text =
        "simulation: {terrain: {surfaces: {hill: {shape: heightfield, image: a.png}}}}\n" + space;
    const Experiment experiment =
        LoadExperiment("maps/task.yaml", overrides, [&](const std::string&) { return text; });
    std::vector<std::string> paths;
    for (const ParameterValue& level : experiment.space.parameters.at(0).levels) {
      paths.push_back(level.text);
    }
    return paths;
  };
  using Paths = std::vector<std::string>;
  const std::string here = std::filesystem::current_path().string();
  CHECK(pictures("space: {surfaces.hill.image: [a.png, ../b.png, /c.png]}\n", {}) ==
        Paths{here + "/maps/a.png", here + "/b.png", "/c.png"});
  CHECK(pictures("space: {surfaces.hill.image: {values: [a.png], settable: true}}\n", {}) ==
        Paths{here + "/maps/a.png"});
  CHECK(pictures("space: {surfaces.hill.image: [a.png]}\n",
                 {"space.surfaces.hill.image=[d.png]"}) == Paths{here + "/d.png"});
  CHECK(pictures("candidate: {kind: program, run: [x]}\nspace: {image: [a.png]}\n", {}) ==
        Paths{"a.png"});
}

TEST_CASE("A name that is not UTF-8 and would be saved is refused with its key when it is loaded") {
  const auto message = [](const std::string& text, const std::string& file) {
    try {
      LoadExperiment(file, {}, [&](const std::string&) { return text; });
    } catch (const yaml::Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string latin = "/data/caf\xE9/task.yaml", what = "rename the folder or the file";
  const std::string reference = message("reference: {kind: logs, path: real.csv}\n", latin);
  CHECK_THAT(reference,
             StartsWith(latin + ": reference.path is '/data/caf\xE9/real.csv', and that "));
  CHECK_THAT(reference, EndsWith(what));
  CHECK_THAT(message("candidate: {kind: logs, path: a.csv}\n", latin), Contains("candidate.path"));
  const std::string hills = "simulation: {terrain: {surfaces: {hill: {shape: heightfield, image: ";
  CHECK_THAT(message(hills + "a.png}}}}\n", latin), Contains("surfaces.hill.image is '/data/caf"));
  CHECK_THAT(message(hills + "/a.png}}}}\nspace: {surfaces.hill.image: [/a.png, b.png]}\n", latin),
             Contains("surfaces.hill.image is '/data/caf\xE9/b.png'"));
  CHECK_THAT(message("", "caf\xE9.yaml"), Contains("name is 'caf\xE9', and that name is not"));
  CHECK(message("waypoints: [{x: 0, y: 0}, {x: 1, y: 0}]\n", latin).empty());
  CHECK(
      message("reference: {kind: logs, path: real.csv}\n", "/data/caf\xC3\xA9/task.yaml").empty());
}

TEST_CASE("More than may be taken is refused before anything is computed") {
  CHECK_THROWS_WITH(Load("gap: {samples: 10000000}\n"), Contains("task.yaml"));
  const auto grid = [](int trials, const std::string& goal) {
    return Load("goal: " + goal + "\nreference: {trials: " + std::to_string(trials) +
                "}\nspace: {control.v_min: [0.12, 0.14, 0.15, 0.16]}\n");
  };
  CHECK_NOTHROW(grid(1000, "grid"));
  CHECK_THROWS_WITH(grid(250'001, "grid"), Contains("task.yaml: 1000004 trials of a grid"));
  CHECK_NOTHROW(grid(250'001, "falsify"));
}

TEST_CASE("What a task asks too much of is one line with its numbers") {
  Experiment experiment;
  // At a power of 0.25 the 3pi+ drives a quarter of 75.4 rad/s times 0.016 m.
  experiment.program.segments = {{.straight_m = 0.25 * 75.4 * 0.016 * 4.0, .power = 0.25},
                                 {.hold_s = 6.25}};
  experiment.program.rest_s = 2.0;
  experiment.trial.settle_s = 1.5;
  experiment.trial.timeout_s = 13.5;
  CHECK_THROWS_WITH(TaskOf(experiment),
                    "the program takes 13.8 s with settling and rest, and trial.timeout_s is 13.5: "
                    "raise it");
  experiment.waypoints.resize(3);
  CHECK_THROWS_WITH(TaskOf(experiment),
                    "3 waypoints beside a program: it starts at the first and makes its own ends, "
                    "leave the others out");
  Experiment far = Way(0.5, -300.0);
  far.trial.timeout_s = 20.0;
  far.trial.arena = {-2.0, 2.0, -2.0, 2.0};
  CHECK_THROWS_WITH(RequireReachableWaypoints(far, "a.yaml"),
                    "a.yaml: waypoints[1] (end) at x 0.5 m, y -300 m lies outside trial.arena, "
                    "where a run ends: move it, widen the arena, or give --any-waypoints");
  far.trial.arena = {-1000.0, 1000.0, -1000.0, 1000.0};
  far.waypoints[1].x_m = 400.0;
  CHECK_THROWS_WITH(
      RequireReachableWaypoints(far, "a.yaml"),
      "a.yaml: its waypoints are 500 m apart in all, as far as 400 m out, and no 3pi+ "
      "drives that in trial.timeout_s, 20 s: waypoints are metres, so divide "
      "millimetres by 1000, or give --any-waypoints");
}

TEST_CASE("Only a flat floor and blocks hold a tag to them") {
  Experiment experiment;
  experiment.track.tag.ground = vision::Ground::kFlat;
  auto& surfaces = experiment.simulation.terrain.surfaces;
  surfaces["hill"].shape = simulation::Shape::kHeightfield;
  for (const auto& [name, ground] : {std::pair{"downhill", vision::Ground::kFree},
                                     {"hill", vision::Ground::kFree},
                                     {"cardboard", vision::Ground::kFlat},
                                     {"bump", vision::Ground::kBumps}}) {
    INFO(name);
    experiment.simulation.terrain.surface = name;
    CHECK(TagOn(experiment).ground == ground);
  }
}

}  // namespace
}  // namespace rift::experiment
