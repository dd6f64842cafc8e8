#include "rift/experiment/ensemble.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "rift/experiment/experiment.hpp"
#include "rift/statistics/random.hpp"
#include "rift/yaml/write.hpp"

namespace rift::experiment {
namespace {

const std::string kRobot = R"(simulation:
  link: {delay_s: 0.1}
  motor: {mismatch: 0.02}
ensemble:
  keys: [simulation.link.delay_s, simulation.motor.mismatch]
  draws:
    - [0.08, 0.01]
    - [0.10, 0.02]
    - [0.12, 0.03]
)";

Experiment LoadTexts(const std::map<std::string, std::string>& texts,
                     const std::vector<std::string>& overrides = {}) {
  return LoadExperiment("robot.yaml", overrides,
                        [&](const std::string& path) { return texts.at(path); });
}

std::string MessageFor(const std::string& robot) {
  try {
    LoadTexts({{"robot.yaml", robot}});
  } catch (const yaml::Error& error) {
    return error.what();
  }
  return "";
}

TEST_CASE("A run takes the values of one draw together, the same for the same seed") {
  const Experiment experiment = LoadTexts({{"robot.yaml", kRobot}});
  std::map<double, int> taken;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    const simulation::SimulationOptions drawn = DrawnAt(experiment, seed).simulation;
    CHECK(drawn.motor.mismatch == Approx(0.5 * drawn.link.delay_s - 0.03 + 0.0).margin(1e-12));
    CHECK(drawn.link.delay_s == DrawnAt(experiment, seed).simulation.link.delay_s);
    CHECK(DrawnAt(experiment, seed).ensemble.IsEmpty());
    ++taken[drawn.link.delay_s];
  }
  REQUIRE(taken.size() == 3);
  for (const auto& [delay_s, times] : taken) CHECK(times > 70);
}

TEST_CASE("A seed takes the same draw in every version of rift") {
  const Experiment experiment = LoadTexts({{"robot.yaml", kRobot}});
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const std::uint64_t taken = statistics::SeedOfStream(seed, 90) % 3;
    CAPTURE(seed, taken);
    CHECK(DrawnAt(experiment, seed).simulation.link.delay_s ==
          Approx(0.08 + 0.02 * static_cast<double>(taken)));
  }
}

TEST_CASE("An experiment without an ensemble is the same at every seed") {
  const Experiment experiment = LoadTexts({{"robot.yaml", "simulation: {link: {delay_s: 0.3}}"}});
  CHECK(DrawnAt(experiment, 1).simulation.link.delay_s == 0.3);
  CHECK(DrawnAt(experiment, 2).simulation.link.delay_s == 0.3);
}

TEST_CASE("A value of the space stands above that of a draw") {
  const Experiment experiment =
      LoadTexts({{"robot.yaml", kRobot + "space: {simulation.link.delay_s: [0.2, 0.3]}"}});
  const Experiment at = ExperimentAt(experiment, {{"0.3", 0.3}});
  std::set<double> mismatches;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    CHECK(DrawnAt(at, seed).simulation.link.delay_s == 0.3);
    mismatches.insert(DrawnAt(at, seed).simulation.motor.mismatch);
  }
  CHECK(mismatches == std::set<double>{0.01, 0.02, 0.03});
}

TEST_CASE("A value that is set over the robot's file stands above that of a draw") {
  const bool by_flag = GENERATE(true, false);
  const Experiment experiment =
      by_flag
          ? LoadTexts({{"robot.yaml", kRobot}}, {"simulation.link.delay_s=0.05"})
          : LoadTexts({{"robot.yaml", "include: fitted.yaml\nsimulation: {link: {delay_s: 0.05}}"},
                       {"fitted.yaml", kRobot}});
  CHECK(experiment.ensemble.keys == std::vector<std::string>{"simulation.motor.mismatch"});
  CHECK(experiment.ensemble.draws == std::vector<std::vector<double>>{{0.01}, {0.02}, {0.03}});
  CHECK(DrawnAt(experiment, 7).simulation.link.delay_s == 0.05);
}

TEST_CASE("With all its keys set elsewhere an ensemble is gone") {
  const Experiment experiment =
      LoadTexts({{"robot.yaml", kRobot}},
                {"simulation.link.delay_s=0.05", "simulation.motor.mismatch=-0.01"});
  CHECK(experiment.ensemble.IsEmpty());
  CHECK(experiment.ensemble.draws.empty());
  CHECK(DrawnAt(experiment, 3).simulation.motor.mismatch == -0.01);
}

TEST_CASE("A saved experiment draws as the one that was saved") {
  const Experiment experiment = LoadTexts({{"robot.yaml", kRobot}});
  const Experiment again = LoadTexts({{"robot.yaml", yaml::Emit(yaml::ToNode(experiment))}});
  CHECK(again.ensemble.keys == experiment.ensemble.keys);
  CHECK(again.ensemble.draws == experiment.ensemble.draws);
}

TEST_CASE("An ensemble that cannot be drawn from is refused with its place") {
  CHECK(MessageFor("ensemble: {keys: [simulation.link.delay_s], draws: [[0.1], [0.1, 0.2]]}")
            .find("draws[1] has 2 values, but there are 1 keys") != std::string::npos);
  CHECK(MessageFor("ensemble: {keys: [simulation.link.delay_s]}").find("give both, or neither") !=
        std::string::npos);
  CHECK(MessageFor("ensemble: {keys: [gap.threshold_m], draws: [[0.1]]}")
            .find("gap.threshold_m is no key of simulation or trial") != std::string::npos);
  const std::string unknown =
      MessageFor("ensemble: {keys: [simulation.link.delai_s], draws: [[0.1]]}");
  CHECK(unknown.find("robot.yaml:1:") == 0);
  CHECK(unknown.find("did you mean 'simulation.link.delay_s'") != std::string::npos);
  const std::string beyond =
      MessageFor("ensemble:\n  keys: [simulation.link.delay_s]\n  draws: [[0.1], [7]]\n");
  CHECK(beyond.find("robot.yaml:3:") == 0);
  CHECK(beyond.find("must be in [0, 2]") != std::string::npos);
  CHECK(MessageFor("ensemble: {keys: [simulation.link.delay_s, simulation.link.delay_s], "
                   "draws: [[0.1, 0.2]]}")
            .find("stands there twice") != std::string::npos);
}

TEST_CASE(
    "A draw of which a key is set elsewhere keeps the values of the others, whichever it is") {
  const std::string robot = R"(ensemble:
  keys: [simulation.link.delay_s, simulation.motor.mismatch, trial.settle_s]
  draws: [[0.08, 0.01, 1.5], [0.12, 0.03, 1.75]]
)";
  const auto left = [&](const std::vector<std::string>& overrides) {
    return LoadTexts({{"robot.yaml", robot}}, overrides).ensemble;
  };
  using Draws = std::vector<std::vector<double>>;
  CHECK(left({}).draws == Draws{{0.08, 0.01, 1.5}, {0.12, 0.03, 1.75}});
  CHECK(left({"simulation.link.delay_s=0.1"}).draws == Draws{{0.01, 1.5}, {0.03, 1.75}});
  CHECK(left({"simulation.motor.mismatch=0"}).draws == Draws{{0.08, 1.5}, {0.12, 1.75}});
  CHECK(left({"trial.settle_s=1"}).draws == Draws{{0.08, 0.01}, {0.12, 0.03}});
  CHECK(left({"trial.settle_s=1", "simulation.link.delay_s=0.1"}).keys ==
        std::vector<std::string>{"simulation.motor.mismatch"});
  CHECK(left({"trial.timeout_s=60"}).keys.size() == 3);
}

}  // namespace
}  // namespace rift::experiment
