#include "rift/experiment/experiment.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>

#include "rift/yaml/describe.hpp"
#include "rift/yaml/node.hpp"
#include "support/inputs/random_fill.hpp"

#include "rift/experiment/space_yaml.hpp"

namespace rift::experiment {
namespace {

/// Loads from texts by name instead of files.
Experiment LoadTexts(const std::map<std::string, std::string>& texts,
                     const std::vector<std::string>& overrides = {}) {
  return LoadExperiment(texts.begin()->first, overrides,
                        [&](const std::string& path) { return texts.at(path); });
}

/// Names, and values of parameters, are one line.
std::string RandomName(std::mt19937_64& random) {
  std::string name = test::RandomText(random);
  std::erase_if(name, [](char c) { return c == '\n' || c == '\r'; });
  return name;
}

Space RandomSpace(std::mt19937_64& random) {
  Space space;
  for (size_t i = random() % 4; i > 0; --i) {
    Parameter parameter{.key = "block.parameter_" + std::to_string(i)};
    if (random() % 2 == 0) {
      parameter.min = -std::uniform_real_distribution<double>(0.0, 9.0)(random);
      parameter.max = std::uniform_real_distribution<double>(0.1, 9.0)(random);
    } else {
      parameter.levels = {{"0.30", 0.3}, {"text " + RandomName(random), std::nullopt}};
    }
    space.parameters.push_back(parameter);
  }
  return space;
}

TEST_CASE("A waypoint file of the authors is an experiment with every default") {
  const Experiment experiment = LoadTexts({{"task.yaml", R"(waypoints:
  - {name: start, x: -0.2822, y: -0.0655, heading: -0.9, stop: true}
  - {name: end, x: 0.3832, y: -0.0597, stop: true}
)"}});
  CHECK(experiment.name == "task");
  REQUIRE(experiment.waypoints.size() == 2);
  CHECK(experiment.waypoints[0].heading_deg == -0.9);
  CHECK(experiment.waypoints[1].x_m == 0.3832);
  CHECK(experiment.gap.samples == 2000);
  CHECK(experiment.gap.threshold_m == 0.06);
}

/// What a fit asks of the rest of its experiment.
void MakeFit(Experiment& experiment) {
  experiment.space.parameters.clear();
  experiment.candidate.kind = CandidateKind::kSimulation;
  experiment.reference.kind = ReferenceKind::kLogs;
  experiment.reference.tag_offset_m = 0.0;
  const double start = experiment.simulation.motor.mismatch;
  experiment.calibrate.fit.list = {{.key = "simulation.motor.mismatch",
                                    .min = std::max(start - 0.1, -0.5),
                                    .max = std::min(start + 0.1, 0.5),
                                    .start = start}};
  experiment.gap.dimension = gap::Dimension::kXy;
  experiment.gap.align = gap::Align::kNone;
  experiment.calibrate.holdout.names = {"02"};
}

TEST_CASE("A resolved experiment loads as the same experiment") {
  std::mt19937_64 random(1);
  for (int i = 0; i < 120; ++i) {
    Experiment experiment;
    test::RandomFill(experiment, random);
    experiment.name = RandomName(random);
    for (control::Waypoint& waypoint : experiment.waypoints) waypoint.name = RandomName(random);
    experiment.space = RandomSpace(random);  // of names that only logs can have
    if (!experiment.space.parameters.empty()) {
      experiment.candidate.kind = CandidateKind::kLogs;
    }
    experiment.gap.samples = std::min(experiment.gap.samples, 1'000'000);  // docs/limits.md
    experiment.reference.trials.names = {"1", "02", RandomName(random) + "x"};
    experiment.reference.path.text = "/logs/{surface}: " + test::RandomText(random);
    experiment.candidate.path.text = "/a/b.csv";
    if (experiment.goal == Goal::kCalibrate) MakeFit(experiment);
    experiment.ensemble = {};
    if (i % 2 == 1) experiment.ensemble = {{"simulation.link.delay_s"}, {{0.1}, {0.2}}};
    for (auto& [name, surface] : experiment.simulation.terrain.surfaces) {
      if (!surface.image.empty()) surface.image = "/maps/hill.png";  // absolute, as once loaded
    }
    const std::string written = WriteExperiment(experiment);
    INFO(written);
    Experiment loaded;
    try {
      loaded = LoadTexts({{"experiment.yaml", written}});
    } catch (const yaml::Error& error) {
      FAIL(error.what());
    }
    loaded.reference.path = experiment.reference.path;  // made absolute and normal on loading
    CHECK(WriteExperiment(loaded) == written);
  }
}

TEST_CASE("Paths of a file are relative to it and paths of an override to the shell") {
  const std::map<std::string, std::string> texts{
      {"/a/b/task.yaml", "candidate: {path: ../logs/{surface}.csv}\n"}};
  CHECK_THROWS_AS(LoadTexts(texts), yaml::Error);  // braces in a flow map are YAML's own
  const Experiment experiment =
      LoadTexts({{"/a/b/task.yaml", "candidate:\n  path: ../logs/{surface}.csv\n"}},
                {"reference.path=/x/../y.csv"});
  CHECK(experiment.candidate.path.text == "/a/logs/{surface}.csv");
  CHECK(experiment.reference.path.text == "/y.csv");
}

TEST_CASE("A rule that is broken points at the file or override that broke it") {
  const std::map<std::string, std::string> texts{
      {"/own.yaml", "include: base.yaml\nsimulation:\n  terrain:\n    surface: bunp\n"},
      {"/slow.yaml", "include: base.yaml\n"},
      {"/base.yaml",
       "simulation:\n  terrain:\n    surface: ground\n    patches: []\n"
       "control: {v_min: 0.1, v_max: 0.2}\n"}};
  const auto error = [&](const std::string& path, const std::vector<std::string>& overrides) {
    try {
      LoadExperiment(path, overrides, [&](const std::string& file) { return texts.at(file); });
    } catch (const yaml::Error& refused) {
      return std::string(refused.what());
    }
    return std::string();
  };
  CHECK(error("/own.yaml", {}) ==
        "/own.yaml:4:5: key 'simulation.terrain': surface is 'bunp', but it must be one of: bump, "
        "cardboard, downhill, ground, parchment, uphill, wet_parchment; did you mean 'bump'?");
  CHECK_THAT(error("/slow.yaml", {"simulation.terrain.surface=bunp"}),
             Catch::StartsWith("--set simulation.terrain.surface: key 'simulation.terrain': ") &&
                 Catch::EndsWith("; did you mean 'bump'?"));
  CHECK(error("/slow.yaml", {"control.v_min=0.5"}) ==
        "--set control.v_min: key 'control': v_min is 0.5, and it must not exceed v_max, which is "
        "0.2 (values also from /base.yaml)");
  CHECK_THAT(error("/slow.yaml", {"control.v_max=0.05"}),
             Catch::StartsWith("--set control.v_max: key 'control': v_min is 0.1"));
}

TEST_CASE("Nested and dotted and overridden axes are one thing") {
  const std::string dotted = "space: {control.v_min: [0.15, 0.20]}\n";
  const std::string nested = "space:\n  control:\n    v_min: [0.15, 0.20]\n";
  const Experiment a = LoadTexts({{"a.yaml", dotted}}), b = LoadTexts({{"a.yaml", nested}});
  const Experiment c = LoadTexts({{"a.yaml", "{}"}}, {"space.control.v_min=[0.15, 0.20]"});
  CHECK(WriteExperiment(a) == WriteExperiment(b));
  CHECK(WriteExperiment(a) == WriteExperiment(c));
  const Experiment d = LoadTexts({{"a.yaml", "space: {v_min: [0.15, 0.20]}"}});
  CHECK(WriteExperiment(a) == WriteExperiment(d));  // the short name is unique
  REQUIRE(a.space.parameters.size() == 1);
  CHECK(a.space.parameters[0].key == "control.v_min");
  CHECK(a.space.parameters[0].levels[1].text == "0.20");
  CHECK(a.space.parameters[0].levels[1].number == 0.2);
}

TEST_CASE("A simulated parameter is a key of the experiment and its values are tried at once") {
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      LoadTexts({{"a.yaml", text}});
    } catch (const yaml::Error& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(refusal("space: {control.v_mim: [0.1]}").find("v_min") != std::string::npos);
  CHECK(refusal("space: {mu: [0.1]}").find("surfaces.ground.mu") != std::string::npos);
  CHECK(refusal("space: {simulation.body.chassis_mass_kg: [0.1, 0]}").starts_with("a.yaml:1:9"));
  CHECK(refusal("space: {v_min: [0.9]}").find("v_max") != std::string::npos);
  CHECK(refusal("space: {v_min: [0.9], v_max: [0.95]}") == "accepted");
}

TEST_CASE("A level is a number in every spelling that a key takes for one") {
  for (const std::string text : {"0.30", "+0.30", ".30", "+.3", "3e-1", "3E-1"}) {
    INFO(text);
    const Experiment experiment =
        LoadTexts({{"a.yaml", "space: {control.v_max: [" + text + ", 0.5]}"}});
    const Parameter& axis = experiment.space.parameters.at(0);
    CHECK(axis.levels[0].number == 0.3);
    CHECK_FALSE(axis.IsCategorical());
    CHECK(ParseValue(axis, text).number == 0.3);
    CHECK(ExperimentAt(experiment, {axis.levels[0]}).control.v_max == 0.3);
    const Experiment saved = LoadTexts({{"a.yaml", WriteExperiment(experiment)}});
    CHECK(saved.space.parameters.at(0).levels == axis.levels);
  }
}

TEST_CASE("A word that is no number is refused for a number without a word of quotes") {
  for (const std::string text : {"0.3.4", "fast", "+-1", "\"0.3.4\""}) {
    INFO(text);
    CHECK_THROWS_WITH(LoadTexts({{"a.yaml", "space: {control.v_max: [" + text + "]}"}}),
                      Catch::Contains("must be a number; meaning"));
  }
  CHECK_THROWS_WITH(LoadTexts({{"a.yaml", "space: {control.v_max: [\"0.3\"]}"}}),
                    Catch::Contains("must be a number; remove the quotes"));
}

TEST_CASE("Levels that are truth values stay without quotes in the saved experiment") {
  const Experiment experiment =
      LoadTexts({{"a.yaml", "space: {control.derivative_kick: [true, false]}"}});
  CHECK_THAT(WriteExperiment(experiment),
             Catch::Contains("control.derivative_kick\": [true, false]"));
}

TEST_CASE("An experiment at a setting has its values and leaves the rest") {
  const Experiment experiment =
      LoadTexts({{"a.yaml", "space: {surface: [ground, bump], v_min: [0.1]}"}});
  const Experiment at = ExperimentAt(experiment, {{"bump", {}}, {"0.1", 0.1}});
  CHECK(at.simulation.terrain.surface == "bump");
  CHECK(at.control.v_min == 0.1);
  CHECK(at.control.v_max == experiment.control.v_max);
}

/// Every key that an axis may name and that holds a value.
std::vector<Parameter> EveryAxis(const Experiment& experiment) {
  std::vector<Parameter> axes;
  for (const std::string& key : yaml::ListKeys(experiment)) {
    const bool is_simulated = key.starts_with("control.") || key.starts_with("trial.") ||
                              key.starts_with("simulation.") || key.starts_with("waypoints[");
    if (!is_simulated) continue;
    const yaml::Node value = yaml::GetValue(experiment, key);
    const bool is_word_null = value.IsScalar() && value.text == "null";
    if ((value.IsScalar() || value.IsNull()) && !is_word_null) axes.push_back({.key = key});
  }
  return axes;
}

TEST_CASE("An experiment at its own values is the experiment") {
  std::mt19937_64 random(11);
  // More than 50 values of each of 30 experiments: one value in 300 that is not set as it was is
  // missed in one of a hundred.
  for (int i = 0; i < 30; ++i) {
    Experiment experiment;
    test::RandomFill(experiment, random);
    experiment.space.parameters = EveryAxis(experiment);
    REQUIRE(experiment.space.parameters.size() > 50);
    const Theta nominal = NominalTheta(experiment);
    const std::string written = WriteExperiment(experiment);
    REQUIRE(WriteExperiment(ExperimentAt(experiment, nominal)) == written);
  }
}

TEST_CASE("An axis of a key that may have no value can have none among its levels") {
  const Experiment experiment =
      LoadTexts({{"a.yaml", "space: {control.cruise_speed: [null, 0.3]}"}});
  const std::vector<ParameterValue>& levels = experiment.space.parameters.at(0).levels;
  CHECK_FALSE(ExperimentAt(experiment, {levels[0]}).control.cruise_speed);
  CHECK(ExperimentAt(experiment, {levels[1]}).control.cruise_speed == 0.3);
  CHECK(NominalTheta(experiment) == Theta{levels[0]});
  const Experiment saved = LoadTexts({{"a.yaml", WriteExperiment(experiment)}});
  CHECK(saved.space.parameters.at(0).levels == levels);
  CHECK_THROWS_WITH(LoadTexts({{"a.yaml", "space: {control.v_max: [null]}"}}),
                    Catch::Contains("must be a number"));
}

TEST_CASE("The own value of a word that needs quotes has none") {
  Experiment experiment;
  experiment.simulation.terrain.surface = "floor #2";
  experiment.space.parameters = {{.key = "simulation.terrain.surface"}};
  CHECK(NominalTheta(experiment) == Theta{{"floor #2", std::nullopt}});
}

TEST_CASE("The own value of a waypoint's coordinate is a number") {
  Experiment experiment;
  experiment.waypoints = {{.x_m = 0.25}};
  experiment.space.parameters = {{.key = "waypoints[0].x"}};
  CHECK(NominalTheta(experiment) == Theta{{"0.25", 0.25}});
}

TEST_CASE("A program that takes longer than a trial with settling and rest is refused") {
  Experiment experiment;
  experiment.program.segments = {{.straight_m = 0.5}};
  experiment.program.rest_s = 0.7;
  experiment.trial.settle_s = 1.5;
  const control::Program program(experiment.program, experiment.hardware.odometry.drive, {});
  const double needed_s = 1.5 + program.Duration_s() + 0.7;
  experiment.trial.timeout_s = needed_s + 0.01;
  CHECK_NOTHROW(TaskOf(experiment));
  experiment.trial.timeout_s = needed_s - 0.01;
  CHECK_THROWS_WITH(TaskOf(experiment),
                    Catch::Contains("the program takes") && Catch::Contains("trial.timeout_s is"));
}

TEST_CASE("Trials are a list or a count") {
  const auto trials = [](const std::string& text) {
    return LoadTexts({{"a.yaml", "reference: {trials: " + text + "}"}}).reference.trials.names;
  };
  CHECK(trials("[1, b, 3]") == std::vector<std::string>{"1", "b", "3"});
  CHECK(trials("3") == std::vector<std::string>{"1", "2", "3"});
  CHECK_THROWS_AS(trials("[]"), yaml::Error);
  CHECK_THROWS_AS(trials("2.5"), yaml::Error);
  CHECK_THROWS_AS(trials("[1, 1]"), yaml::Error);
}

}  // namespace
}  // namespace rift::experiment
