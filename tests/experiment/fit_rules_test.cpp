// What a fit keeps to beside the space it is made in.
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/yaml/node.hpp"

namespace rift::experiment {
namespace {

using Catch::Matchers::Contains;

std::string Message(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    LoadExperiment("task.yaml", overrides, [&](const std::string&) { return text; });
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

Experiment Load(const std::string& text) {
  return LoadExperiment("task.yaml", {}, [&](const std::string&) { return text; });
}

const std::string kFit =
    "goal: calibrate\nspace: {surface: [ground, parchment], v_min: [0.1]}\n"
    "reference: {kind: logs, path: \"{surface}{v_min}{trial}.csv\", trials: [1, 2, 3]}\n";

TEST_CASE("Values of a fit keep the rules at every setting, or they do not keep them") {
  const Experiment fit = Load(
      "goal: calibrate\nspace: {motor.breakaway_torque_nm: [0.004, 0.006]}\n"
      "simulation: {motor: {friction_torque_nm: 0.002, breakaway_torque_nm: 0.01}}\n"
      "reference: {kind: logs, path: \"{breakaway_torque_nm}{trial}.csv\", trials: [1, 2]}\n"
      "calibrate: {fit: {motor.friction_torque_nm: {min: 0.001, max: 0.004}}}\n");
  const Theta low{{"0.004", 0.004}}, high{{"0.006", 0.006}};
  CHECK(KeepsRules(fit, {0.005}));
  CHECK(KeepsRules(fit, {0.003}, {low, high}));
  CHECK(KeepsRules(fit, {0.005}, {high}));
  CHECK_FALSE(KeepsRules(fit, {0.005}, {low}));
  CHECK_FALSE(KeepsRules(fit, {0.005}, {high, low}));
  CHECK_FALSE(KeepsRules(fit, {0.02}));
}

TEST_CASE("A start outside of its range is told with both and its place") {
  const auto message = [](const std::string& range) {
    return Message(kFit + "calibrate: {fit: {motor.mismatch: " + range + "}}\n",
                   {"simulation.motor.mismatch=0.025"});
  };
  CHECK(message("{min: 0.05, max: 0.1}") ==
        "task.yaml:4:19: calibrate.fit: simulation.motor.mismatch starts at 0.025, which the "
        "experiment gives it, but its range is [0.05, 0.1]; widen it or set another start");
  CHECK(message("{min: -0.1, max: 0.0125}") ==
        "task.yaml:4:19: calibrate.fit: simulation.motor.mismatch starts at 0.025, which the "
        "experiment gives it, but its range is [-0.1, 0.0125]; widen it or set another start");
  CHECK(message("{min: 0.025, max: 0.1}") == "accepted");
  CHECK(message("{min: -0.1, max: 0.025}") == "accepted");
}

TEST_CASE("What is no fit is told in whole lines with what to do") {
  const auto message = [](const std::string& fit, const std::vector<std::string>& overrides = {}) {
    return Message(kFit + "calibrate: {fit: " + fit + "}\n", overrides);
  };
  const std::string mismatch = "{motor.mismatch: {min: -0.1, max: 0.1}}";
  CHECK(message(mismatch) == "accepted");
  CHECK(message(mismatch, {"candidate.kind=logs"}) ==
        "task.yaml: goal is calibrate, and candidate.kind is logs: only a simulator can be fitted");
  CHECK(message(mismatch, {"reference.tag_offset_m=0.03"}) ==
        "task.yaml: goal is calibrate, and reference.tag_offset_m is 0.03, but the fit needs the "
        "logs as the tag moved: leave it out and set simulation.mocap.tag_ahead_m");
  CHECK(message(mismatch, {"gap.dimension=xyz"}) ==
        "task.yaml: goal is calibrate, and gap.dimension is xyz: a fit looks at speeds, turns and "
        "sideways slip in the plane");
  CHECK(message(mismatch, {"calibrate.holdout=[3, 5]"}) ==
        "task.yaml: calibrate.holdout names trial 5, and reference.trials has 1, 2, 3");
  CHECK(message(mismatch, {"calibrate.holdout=[3, 1, 2]"}) ==
        "task.yaml: calibrate.holdout names all of reference.trials, so that none is left to fit");
  CHECK(message("{control.v_max: {min: 0.2, max: 0.5}}") ==
        "task.yaml:4:19: calibrate.fit: control.v_max is no parameter of the simulator; fit keys "
        "of simulation or trial");
  CHECK(message("{\"surfaces.{floor}.mu\": {min: 0.1, max: 1}}") ==
        "task.yaml:4:19: calibrate.fit: surfaces.{floor}.mu asks for a parameter 'floor' of space, "
        "which has surface, v_min");
  CHECK(
      message("{link.uart_bytes: {min: 10, max: 60}}") ==
      "task.yaml:4:19: calibrate.fit: simulation.link.uart_bytes is a whole number, and only a "
      "key that may have a fraction can be fitted: leave it out, or compare its values in a sweep "
      "(goal: grid)");
  CHECK(message("{motor.no_load_rad_s: {min: 10, max: 100}}") ==
        "task.yaml:4:19: calibrate.fit: simulation.motor.no_load_rad_s is empty, and only a number "
        "can be fitted; give it a value to start from");
}

TEST_CASE("Fitted parameters are none of a program's outside of a fit, nor of the simulator's") {
  const Experiment simulated =
      Load(kFit + "calibrate: {fit: {motor.mismatch: {min: -0.1, max: 0.1}}}\n");
  CHECK(ProgramParameters(simulated).size() == 2);
  const std::string program =
      "candidate: {kind: program, run: [sh]}\nspace: {surface: [ice]}\n"
      "reference: {kind: logs, path: \"{surface}{trial}.csv\", trials: [1, 2]}\n"
      "calibrate: {fit: {mu: {min: 0.25, max: 0.75}}, method: {runs: 1}}\n";
  CHECK(ProgramParameters(Load("goal: calibrate\n" + program)).size() == 2);
  CHECK(ProgramParameters(Load("goal: grid\n" + program)).size() == 1);
}

TEST_CASE("An axis that is wrong is told with its line and column, in whole lines") {
  CHECK(Message("goal: falsify\nspace:\n  control.v_min: [0.1]\n  gap.threshold_m: [0.1, 0.2]\n") ==
        "task.yaml:4:3: space: gap.threshold_m does not change a simulated trial; vary keys of "
        "control, trial, program or simulation");
  CHECK(Message("space:\n  control.v_min: [0.1]\n  link.uart_bytes: [8, 16.5]\n") ==
        "task.yaml:3:3: key 'simulation.link.uart_bytes' is 16.5: must be a whole number; meaning: "
        "bytes the serial line keeps between two reads, the rest are lost (RP2040: 32); 0: all");
  CHECK(Message("goal: falsify\nspace:\n  control.v_min: [0.1]\n  control.v_max: {min: 0.5, max: "
                "0.25}\n") ==
        "task.yaml:4:18: key 'space.control.v_max' is a block of keys: min is 0.5, and it must be "
        "below max, which is 0.25");
  CHECK(Message("space:\n  control.v_min: {min: 0.1, max: 0.2}\n") ==
        "task.yaml:2:3: space.control.v_min is a range, and a grid needs the values to visit: "
        "write a list, or set goal: falsify");
  CHECK(Message("goal: falsify\nspace:\n  control.v_min: {min: 0.1, max: 0.2, nominal: 0.15}\n") ==
        "task.yaml:3:3: space.control.v_min: nominal is of a program's parameters: here the key "
        "control.v_min has the value");
  CHECK_THAT(Message("space:\n  control.v_min: [0.1]\n  control.v_max: [0.3, 7]\n"),
             Catch::StartsWith("task.yaml:3:3: key 'control.v_max' is 7: must be in [0, 1]"));
}

TEST_CASE("A grid of a program needs lists as any other, and a setting leaves its experiment") {
  const std::string program =
      "candidate: {kind: program, run: [sh]}\nreference: {kind: nominal}\n"
      "control: {v_min: 0.125}\n";
  CHECK(Message("goal: grid\n" + program + "space:\n  mu: {min: 0.1, max: 0.5}\n") ==
        "task.yaml:6:3: space.mu is a range, and a grid needs the values to visit: write a list, "
        "or set goal: falsify");
  CHECK(Message("goal: falsify\n" + program + "space:\n  mu: {min: 0.1, max: 0.5}\n") ==
        "accepted");
  const Experiment experiment = Load("goal: grid\n" + program + "space: {v_min: [0.15, 0.2]}\n");
  CHECK(ExperimentAt(experiment, {{"0.2", 0.2}}).control.v_min == 0.125);
  const Experiment own = Load("space: {v_min: [0.15, 0.2]}\n");
  CHECK(ExperimentAt(own, {{"0.2", 0.2}}).control.v_min == 0.2);
}

}  // namespace
}  // namespace rift::experiment
