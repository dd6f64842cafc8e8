// The space and the fit of an experiment as YAML: what they may be, and what is refused where.
#include <catch2/catch.hpp>
#include <ctime>
#include <string>
#include <vector>

#include "rift/experiment/ensemble.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/experiment/program_parameters.hpp"
#include "rift/experiment/space_yaml.hpp"
#include "rift/yaml/node.hpp"
#include "support/processes/process.hpp"

namespace rift::experiment {
namespace {

using Catch::Matchers::Contains;

Experiment Load(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return LoadExperiment("task.yaml", overrides, [&](const std::string&) { return text; });
}

/// A search over one axis of a program, whose parameters are names of its own.
const std::string kProgram =
    "goal: falsify\ncandidate: {kind: program, run: [sh]}\nreference: {kind: nominal}\n";
Parameter AxisOf(const std::string& axis) {
  return Load(kProgram + "space: {mu: " + axis + "}\n").space.parameters.at(0);
}

TEST_CASE("A range has its bounds, scale, whole numbers, steps and value at rest as written") {
  const Parameter plain = AxisOf("{min: -0.5, max: 2}");
  CHECK(plain.min == -0.5);
  CHECK(plain.max == 2.0);
  CHECK(plain.IsContinuous());
  CHECK_FALSE(plain.is_integer);
  CHECK_FALSE(plain.is_logarithmic);
  CHECK_FALSE(plain.settable);
  CHECK_FALSE(plain.step);
  CHECK_FALSE(plain.nominal);
  CHECK(plain.origin == "task.yaml:4:9");
  CHECK(AxisOf("{min: 0.1, max: 2, scale: log}").is_logarithmic);
  CHECK_FALSE(AxisOf("{min: 0.1, max: 2, scale: linear}").is_logarithmic);
  CHECK(AxisOf("{min: 0, max: 2, integer: true}").is_integer);
  CHECK(AxisOf("{min: 0, max: 2, settable: true}").settable == true);
  CHECK(AxisOf("{min: 0, max: 2, settable: false}").settable == false);
  CHECK(AxisOf("{min: 0, max: 2, step: 0.25}").step == 0.25);
  for (const double nominal : {0.0, 0.5, 2.0}) {
    CHECK(AxisOf("{min: 0, max: 2, nominal: " + std::to_string(nominal) + "}").nominal == nominal);
  }
  const Parameter values = AxisOf("{values: [1, ice], settable: false}");
  REQUIRE(values.levels.size() == 2);
  CHECK(values.levels[0].number == 1.0);
  CHECK(values.levels[1].text == "ice");
  CHECK(values.settable == false);
}

TEST_CASE("An axis that breaks a rule is refused with the rule") {
  struct Wrong {
    std::string axis, says;
  };
  const Wrong wrong = GENERATE(
      values<Wrong>({{"[]", "an axis needs at least one value"},
                     {"[1, 2, 1.0]", "an axis has each value once"},
                     {"[ice, ice]", "an axis has each value once"},
                     {"[[1]]", "must be a number or a text"},
                     {"[1, \"ice\\nand snow\"]", "have no line breaks"},
                     {"[\"ice\\r\"]", "have no line breaks"},
                     {"3", "must be a list of values, or {min: a, max: b}"},
                     {"{min: 1}", "a range needs min and max; max is missing"},
                     {"{max: 1}", "a range needs min and max; min is missing"},
                     {"{min: a, max: 1}", "must be a number"},
                     {"{min: 0, max: b}", "must be a number"},
                     {"{min: 1, max: 1}", "min is 1, and it must be below max, which is 1"},
                     {"{min: 2, max: 1}", "min is 2, and it must be below max, which is 1"},
                     {"{min: 0, max: 1, scale: log}", "scale: log needs min above 0, which is 0"},
                     {"{min: 1, max: 4, scale: log, integer: true}", "and no integers"},
                     {"{min: 1, max: 4, scale: cubic}", "cubic"},
                     {"{min: 0.5, max: 4, integer: true}", "min and max of integers must be whole"},
                     {"{min: 0, max: 4.5, integer: true}", "min and max of integers must be whole"},
                     {"{min: 0, max: 4, integer: maybe}", "maybe"},
                     {"{min: 0, max: 1, nominal: 1.1}", "must be a number in its range"},
                     {"{min: 0, max: 1, nominal: -0.1}", "must be a number in its range"},
                     {"{min: 0, max: 1, nominal: a}", "must be a number in its range"},
                     {"{values: [1, 2], nominal: 1}", "must be a number in its range"},
                     {"{min: 0, max: 1, step: 0}", "must be a number above 0"},
                     {"{min: 0, max: 1, step: -1}", "must be a number above 0"},
                     {"{min: 0, max: 10, integer: true, step: 2.6}",
                      "space.mu.step' is 2.6: must be whole, as the integers of its range"},
                     {"{min: 0, max: 10, integer: true, step: 0.5}", "must be whole"},
                     {"{min: 0, max: 10, integer: true, nominal: 2.5}",
                      "space.mu.nominal' is 2.5: must be whole, as the integers of its range"},
                     {"{values: [1, 2], step: 1}", "belongs to a range"},
                     {"{values: [1, 2], min: 1}", "has values, or min and max: not both"},
                     {"{values: [1, 2], max: 1}", "has values, or min and max: not both"},
                     {"{values: [1, 2], scale: log}", "has values, or min and max: not both"},
                     {"{values: [1, 2], integer: true}", "has values, or min and max: not both"},
                     {"{values: 1}", "must be a list"}}));
  INFO(wrong.axis);
  CHECK_THROWS_WITH(AxisOf(wrong.axis), Contains("task.yaml:4") && Contains(wrong.says));
}

TEST_CASE("A parameter is called like no other and like no column of a table") {
  const auto refused = [](const std::string& space) {
    return [space] { Load(kProgram + "space: " + space + "\n"); };
  };
  CHECK_THROWS_WITH(refused("{a.mu: [1], b: [1], c.mu: [2]}")(),
                    Contains("a.mu and c.mu have the same last name 'mu'"));
  CHECK_THROWS_WITH(refused("{b: [1], trial: [1]}")(), Contains("see reference.trials"));
  CHECK_THROWS_WITH(refused("{seed: [1]}")(), Contains("for repeats set reference.trials"));
  for (const char* column : {"gap_m", "id", "exact_gap_m", "left_m"}) {
    CHECK_THROWS_WITH(refused("{b: [1], " + std::string(column) + ": [1]}")(),
                      Contains("'" + std::string(column) + "' is a column of table.csv already"));
  }
  CHECK_THROWS_WITH(refused("{\"a\\nb\": [1]}")(), Contains("have no line breaks"));
  CHECK_NOTHROW(refused("{a: [1], b: [1]}")());
}

TEST_CASE("A space comes back from what was saved of it, every kind of axis") {
  const std::string space =
      "space:\n  a: {min: 1, max: 9, integer: true, step: 2, nominal: 3, settable: true}\n"
      "  b: {min: 0.1, max: 9, scale: log}\n  c: [1, ice, \"2\"]\n"
      "  d: {values: [x, y], settable: false}\n";
  const Experiment first = Load(kProgram + space);
  const Experiment again = Load(WriteExperiment(first));
  CHECK(WriteExperiment(again) == WriteExperiment(first));
  const auto& parameters = again.space.parameters;
  REQUIRE(parameters.size() == 4);
  CHECK(parameters[0].is_integer);
  CHECK(parameters[0].step == 2.0);
  CHECK(parameters[0].nominal == 3.0);
  CHECK(parameters[0].settable == true);
  CHECK(parameters[0].min == 1.0);
  CHECK(parameters[0].max == 9.0);
  CHECK(parameters[1].is_logarithmic);
  CHECK_FALSE(parameters[1].is_integer);
  REQUIRE(parameters[2].levels.size() == 3);
  CHECK(parameters[2].levels[0].number == 1.0);
  CHECK_FALSE(parameters[2].levels[2].number);  // a text in quotes
  CHECK(parameters[3].settable == false);
}

TEST_CASE("Trials are counted from one to a million, or named once each") {
  const auto trials = [](const std::string& text) {
    return Load(kProgram + "space: {a: [1]}\n", {"reference.trials=" + text})
        .reference.trials.names;
  };
  CHECK(trials("3") == std::vector<std::string>{"1", "2", "3"});
  CHECK(trials("1") == std::vector<std::string>{"1"});
  CHECK(trials("[5, a, \"07\"]") == std::vector<std::string>{"5", "a", "07"});
  for (const char* wrong : {"0", "-1", "1.5", "1000001", "many", "[]", "{a: 1}", "[[1]]"}) {
    INFO(wrong);
    CHECK_THROWS_WITH(trials(wrong), Contains("reference.trials"));
  }
  CHECK_THROWS_WITH(trials("[1, 2, 1]"), Contains("trial 1 stands there twice"));
}

TEST_CASE(
    "A value of a program at rest is what its axis says, else its middle or its first level") {
  const auto nominal = [](const std::string& axis) {
    return NominalTheta(Load(kProgram + "space: {mu: " + axis + "}\n")).at(0);
  };
  CHECK(nominal("{min: 0, max: 2, nominal: 1.5}").number == 1.5);
  CHECK(nominal("{min: 1, max: 2}").number == 1.5);
  CHECK(nominal("{min: 1, max: 4, scale: log}").number == Approx(2.0));
  CHECK(nominal("{min: 1, max: 4, integer: true}").number == 2.0);
  CHECK(nominal("[ice, sand]").text == "ice");
  const std::string own = "space: {control.v_min: {min: 0.1, max: 0.2, nominal: 0.15}}\n";
  CHECK_THROWS_WITH(Load("goal: falsify\n" + own),
                    Contains("nominal is of a program's parameters"));
  CHECK_THROWS_WITH(Load("goal: falsify\nspace: {control.v_max: [0.3], control.v_min: {min: 0.1, "
                         "max: 0.2, nominal: 0.15}}\n"),
                    Contains("space.control.v_min: nominal is of a program's parameters"));
}

TEST_CASE("Only keys that change a simulated trial are an axis, and whole keys take whole ranges") {
  const auto load = [](const std::string& axis) {
    return Load("goal: falsify\nspace: {" + axis + "}\n");
  };
  for (const char* axis :
       {"control.v_min: {min: 0.1, max: 0.2}", "trial.timeout_s: {min: 30, max: 40}",
        "simulation.motor.mismatch: {min: 0, max: 0.1}"}) {
    CHECK_NOTHROW(load(axis));
  }
  CHECK_THROWS_WITH(load("gap.threshold_m: {min: 0.1, max: 0.2}"),
                    Contains("gap.threshold_m does not change a simulated trial") &&
                        Contains("vary keys of control, trial, program or simulation"));
  CHECK_THROWS_WITH(load("search.budget: {min: 1, max: 2}"), Contains("does not change"));
  CHECK(load("mismatch: {min: 0, max: 0.1}").space.parameters[0].key ==
        "simulation.motor.mismatch");
  CHECK_THROWS_WITH(load("no_such_key: {min: 0, max: 0.1}"),
                    Contains("task.yaml:2:9: space: ") && Contains("no_such_key"));
  CHECK(load("uart_bytes: {min: 8, max: 64}").space.parameters[0].is_integer);
  CHECK_FALSE(load("mismatch: {min: 0, max: 1e-1}").space.parameters[0].is_integer);
  for (const char* range :
       {"{min: 8.5, max: 64}", "{min: 8, max: 64.5}", "{min: 8, max: 64, scale: log}"}) {
    INFO(range);
    CHECK_THROWS_WITH(load("uart_bytes: " + std::string(range)),
                      Contains("simulation.link.uart_bytes holds whole numbers: its range needs "
                               "whole bounds and a linear scale"));
  }
  CHECK(load("uart_bytes: {min: 8, max: 64, step: 8}").space.parameters[0].step == 8.0);
  CHECK_THROWS_WITH(load("uart_bytes: {min: 8, max: 64, step: 2.5}"),
                    Contains("task.yaml:2:9: space: simulation.link.uart_bytes holds whole "
                             "numbers: its step is 2.5, and it must be whole"));
  CHECK(load("mismatch: {min: 0, max: 0.1, step: 0.03}").space.parameters[0].step == 0.03);
}

TEST_CASE("Every setting of a grid of two thousand is tried at once, of a larger one each value") {
  // v_min 0.45 beside v_max 0.3 breaks a rule that other settings keep.
  const auto load = [](int phases) {
    std::string levels;
    for (int i = 0; i < phases; ++i) levels += (i > 0 ? ", 0." : "0.") + std::to_string(10 + i);
    return Load("space: {v_min: [0.45, 0.15], v_max: [0.3, 0.5], mismatch: [" + levels +
                "], reach_radius_m: [0.01, 0.02, 0.03, 0.04, 0.05], w_min: [0.01, 0.02, 0.03, "
                "0.04, 0.05], link.delay_s: [0.1, 0.2]}\n");
  };
  CHECK_THROWS_WITH(load(10), Contains("v_max"));  // 2 x 2 x 10 x 5 x 5 x 2
  CHECK_NOTHROW(load(11));
}

TEST_CASE("A value that its key may not have is refused at once, in a grid and in a search") {
  for (const char* goal : {"grid", "falsify"}) {
    INFO(goal);
    const auto load = [&](const std::string& axis) {
      return Load("goal: " + std::string(goal) + "\nspace: {" + axis + "}\n");
    };
    CHECK_THROWS_WITH(load("control.v_min: [0.15, 7]"), Contains("control.v_min"));
    CHECK_THROWS_WITH(load("control.v_max: [0.3, 0.4], control.v_min: [7]"),
                      Contains("control.v_min"));
    CHECK_THROWS_WITH(load("surface: [ground, cheese]"), Contains("cheese"));
  }
  CHECK_THROWS_WITH(Load("goal: falsify\nspace: {control.v_min: {min: 0.1, max: 7}}\n"),
                    Contains("control.v_min"));
  CHECK_THROWS_WITH(Load("goal: falsify\nspace: {control.v_min: {min: -7, max: 0.2}}\n"),
                    Contains("control.v_min"));
  // A rule between keys that other values of the other axis keep is no error of a search.
  const std::string between = "space: {v_min: [0.15, 0.45], v_max: [0.3, 0.5]}\n";
  CHECK_NOTHROW(Load("goal: falsify\n" + between));
  CHECK_THROWS(Load("goal: grid\n" + between));
}

/// An experiment with as many values of a parameter, draws and trials.
std::string Wide(int count) {
  std::string values = "0.1", draws = "[0.1]", trials = "first";
  for (int i = 1; i < count; ++i) {
    values += ", " + std::to_string(0.1 + 1e-6 * i);
    draws += ", [" + std::to_string(0.1 + 1e-6 * i) + "]";
    trials += ", t" + std::to_string(i);
  }
  return "goal: falsify\nspace: {control.v_min: [" + values +
         "]}\nensemble: {keys: [simulation.link.delay_s], draws: [" + draws +
         "]}\nreference: {trials: [" + trials + "]}\n";
}

TEST_CASE("Ten times the values, draws and trials take no hundred times the time to be tried") {
  const std::string few = Wide(3'000), many = Wide(30'000);
  const std::clock_t begun = std::clock();
  Load(few);
  const std::clock_t between = std::clock();
  const Experiment loaded = Load(many);
  CHECK(std::clock() - between < 40 * (between - begun));
  CHECK(loaded.space.parameters.at(0).levels.size() == 30'000);
  CHECK(loaded.ensemble.draws.size() == 30'000);
  CHECK(loaded.reference.trials.names.size() == 30'000);
}

TEST_CASE("A value is tried beside the experiment's own ones, not beside one tried before it") {
  // v_max may not be below cruise_speed: 0.25 is right beside the own 0.2 alone.
  const std::string own = "control: {v_min: 0.1, cruise_speed: 0.2, v_max: 0.4}\ngoal: falsify\n";
  CHECK_NOTHROW(Load(own + "space: {cruise_speed: [0.35, 0.4], v_max: [0.25, 0.5]}\n"));
  CHECK_THROWS_WITH(Load(own + "space: {cruise_speed: [0.35, 0.4], v_max: [0.15, 0.5]}\n"),
                    Contains("cruise_speed"));
}

/// Logs that a fit is made to; the fit itself behind it.
const std::string kFit =
    "goal: calibrate\nspace: {surface: [ground, parchment]}\n"
    "reference: {kind: logs, path: \"{surface}{trial}.csv\", trials: [1, 2, 3]}\n";
Experiment LoadFit(const std::string& fit, const std::vector<std::string>& overrides = {}) {
  return Load(kFit + "calibrate: {fit: " + fit + "}\n", overrides);
}

TEST_CASE("A fit has its ranges and priors, and starts at the experiment's own values") {
  const auto fit = LoadFit(
                       "{motor.mismatch: {min: -0.1, max: 0.2}, link.delay_s: {min: 0, max: 0.3, "
                       "mean: 0.05, sd: 0.02}}",
                       {"simulation.motor.mismatch=0.07"})
                       .calibrate.fit.list;
  REQUIRE(fit.size() == 2);
  CHECK(fit[0].key == "simulation.motor.mismatch");
  CHECK(fit[0].min == -0.1);
  CHECK(fit[0].max == 0.2);
  CHECK(fit[0].start == 0.07);
  CHECK(fit[0].prior_sd == 0.0);
  CHECK(fit[1].key == "simulation.link.delay_s");
  CHECK(fit[1].prior_mean == 0.05);
  CHECK(fit[1].prior_sd == 0.02);
}

TEST_CASE("A fit comes back from what was saved of it, with what is known and without") {
  const Experiment first = LoadFit(
      "{motor.mismatch: {min: -0.1, max: 0.2}, link.delay_s: {min: 0, max: 0.3, mean: 0.05, sd: "
      "0.02}}");
  const Experiment again = Load(WriteExperiment(first));
  CHECK(WriteExperiment(again) == WriteExperiment(first));
  const auto& fit = again.calibrate.fit.list;
  REQUIRE(fit.size() == 2);
  CHECK(fit[0].min == -0.1);
  CHECK(fit[0].max == 0.2);
  CHECK(fit[0].prior_sd == 0.0);
  CHECK(fit[1].prior_mean == 0.05);
  CHECK(fit[1].prior_sd == 0.02);
}

TEST_CASE("An argument of a program that is a file beside the experiment is that file") {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "sim.py", "");
  const std::string file = folder / "task.yaml";
  const auto words = [&](const std::string& run) {
    return LoadExperiment(file, {},
                          [&](const std::string&) {
                            return "goal: falsify\ncandidate: {kind: program, run: " + run +
                                   "}\nreference: {kind: nominal}\nspace: {a: [1]}\n";
                          })
        .candidate.run.words;
  };
  CHECK(words("[python3, sim.py, --mu, \"{a}\", 0.5, \"\"]") ==
        std::vector<std::string>{"python3", folder / "sim.py", "--mu", "{a}", "0.5", ""});
  CHECK(words("[none.py]") == std::vector<std::string>{"none.py"});
  CHECK_THROWS_WITH(words("sim.py"), Contains("must be a list: [python3, sim.py, ...]"));
  CHECK_THROWS_WITH(words("[[1]]"), Contains("every argument must be a text or a number"));
}

TEST_CASE("An ensemble has each key once, and in each draw a value for each") {
  const auto check = [](const Ensemble& ensemble) { ensemble.Check(); };
  CHECK_NOTHROW(check({}));
  CHECK_NOTHROW(check({{"a", "b"}, {{1.0, 2.0}, {3.0, 4.0}}}));
  CHECK_THROWS_WITH(check({{"a", "b", "a"}, {{1.0, 2.0, 3.0}}}), "keys: a stands there twice");
  CHECK_THROWS_WITH(check({{"a"}, {}}), Contains("keys and draws go together"));
  CHECK_THROWS_WITH(check({{}, {{1.0}}}), Contains("keys and draws go together"));
  CHECK_THROWS_WITH(check({{"a", "b"}, {{1.0}, {3.0, 4.0}}}),
                    "draws[0] has 1 values, but there are 2 keys");
  CHECK_THROWS_WITH(check({{"a"}, {{1.0}, {3.0, 4.0}}}),
                    "draws[1] has 2 values, but there are 1 keys");
}

TEST_CASE(
    "Braces in a fit stand for each level of that parameter, wherever it stands in the space") {
  const Experiment fit = Load(
      "goal: calibrate\nspace: {control.v_min: [0.15], surface: [ground, parchment]}\n"
      "reference: {kind: logs, path: \"{surface}{v_min}{trial}.csv\", trials: [1, 2]}\n"
      "calibrate: {fit: {\"surfaces.{surface}.mu\": {min: 0.1, max: 1.2}}}\n");
  REQUIRE(fit.calibrate.fit.list.size() == 2);
  CHECK(fit.calibrate.fit.list[0].key == "simulation.terrain.surfaces.ground.mu");
  CHECK(fit.calibrate.fit.list[1].key == "simulation.terrain.surfaces.parchment.mu");
  CHECK_THROWS_WITH(LoadFit("{\"surfaces.{floor}.mu\": {min: 0.1, max: 1}}"),
                    Contains("asks for a parameter 'floor' of space, which has surface"));
}

TEST_CASE("A range of a fit is two numbers, or four with what is known") {
  struct Wrong {
    std::string range, says;
  };
  const Wrong wrong = GENERATE(
      values<Wrong>({{"3", "must be {min: a, max: b}"},
                     {"{min: 0}", "max is missing"},
                     {"{min: 0.2, max: 0.1}", "must be below max"},
                     {"{min: -0.1, max: 0.1, mean: 0}", "must be {min: a, max: b}"},
                     {"{min: -0.1, max: 0.1, sd: 0.1}", "must be {min: a, max: b}"},
                     {"{min: -0.1, max: 0.1, median: 0, sd: 0.1}", "must be {min: a, max: b}"},
                     {"{min: -0.1, max: 0.1, mean: x, sd: 0.1}", "must be a number"},
                     {"{min: -0.1, max: 0.1, mean: 0, sd: 0}", "must be above 0"},
                     {"{min: -0.1, max: 0.1, mean: 0, sd: -1}", "must be above 0"},
                     {"{min: -0.1, max: 0.1, mean: 0.11, sd: 0.1}", "must lie in the range"},
                     {"{min: -0.1, max: 0.1, mean: -0.11, sd: 0.1}", "must lie in the range"}}));
  INFO(wrong.range);
  CHECK_THROWS_WITH(LoadFit("{motor.mismatch: " + wrong.range + "}"),
                    Contains("task.yaml:4") && Contains(wrong.says));
  for (const char* mean : {"-0.1", "0.05", "0.1"}) {  // its ends are in it
    CHECK_NOTHROW(LoadFit("{motor.mismatch: {min: -0.1, max: 0.1, mean: " + std::string(mean) +
                          ", sd: 0.1}}"));
  }
}

TEST_CASE("What cannot be fitted is refused with its place and the reason") {
  const std::string mismatch = "{motor.mismatch: {min: -0.1, max: 0.1}}";
  CHECK_NOTHROW(LoadFit(mismatch));
  CHECK_THROWS_WITH(LoadFit("{motor.mismatch: {min: 0.05, max: 0.1}}"),
                    Contains("starts at 0, which the experiment gives it, but its range is [0.05, "
                             "0.1]"));
  CHECK_THROWS_WITH(LoadFit("{motor.mismatch: {min: -0.1, max: -0.05}}"), Contains("starts at 0"));
  CHECK_NOTHROW(LoadFit("{motor.mismatch: {min: 0, max: 0.1}}"));
  CHECK_NOTHROW(LoadFit("{motor.mismatch: {min: -0.1, max: 0}}"));
  CHECK_THROWS_WITH(LoadFit("{trial.pace: {min: 0, max: 1}}"),
                    Contains("only a number can be fitted") && !Contains("give it a value"));
  CHECK_THROWS_WITH(LoadFit("{motor.no_load_rad_s: {min: 10, max: 100}}"),
                    Contains("only a number can be fitted; give it a value to start from"));
  CHECK_THROWS_WITH(LoadFit("{control.v_min: {min: 0.1, max: 0.2}}"),
                    Contains("is no parameter of the simulator"));
  CHECK_THROWS_WITH(LoadFit("{no_such_key: {min: 0.1, max: 0.2}}"), Contains("no_such_key"));
  CHECK_THROWS_WITH(LoadFit("{motor.mismatch: {min: -100, max: 0.1}}"), Contains("mismatch"));
  CHECK_THROWS_WITH(LoadFit("{motor.mismatch: {min: -0.1, max: 100}}"), Contains("mismatch"));
  CHECK_THROWS_WITH(LoadFit("{}"), Contains("calibrate.fit is empty: name parameters, such as "
                                            "{motor.mismatch: {min: -0.1, max: 0.1}}"));
  CHECK_THROWS_WITH(LoadFit(mismatch, {"reference.tag_offset_m=0.03"}),
                    Contains("reference.tag_offset_m is 0.03"));
  CHECK_THROWS_WITH(LoadFit(mismatch, {"gap.dimension=xyz"}), Contains("gap.dimension is xyz"));
  CHECK_THROWS_WITH(LoadFit(mismatch, {"reference.kind=path"}),
                    Contains("reference.kind is not logs"));
  CHECK_THROWS_WITH(LoadFit(mismatch, {"candidate.kind=logs"}), Contains("candidate.kind is logs"));
  CHECK_THROWS_WITH(
      Load("goal: calibrate\nspace: {motor.mismatch: [0, 0.1]}\nreference: {kind: logs, path: "
           "\"{mismatch}{trial}.csv\", trials: [1, 2]}\ncalibrate: {fit: " +
           mismatch + "}\n"),
      Contains("is a parameter of space as well"));
}

TEST_CASE("A fit takes ranges of two keys of which only some pairs keep the rule between them") {
  const std::string friction = "motor.friction_torque_nm", breakaway = "motor.breakaway_torque_nm";
  const auto load = [&](const std::string& of_friction, const std::string& of_breakaway) {
    return LoadFit(
        "{" + friction + ": " + of_friction + ", " + breakaway + ": " + of_breakaway + "}",
        {"simulation." + friction + "=0.003", "simulation." + breakaway + "=0.004"});
  };
  CHECK_NOTHROW(load("{min: 0.001, max: 0.006}", "{min: 0.001, max: 0.006}"));
  CHECK_NOTHROW(load("{min: 0.002, max: 0.0035}", "{min: 0.0025, max: 0.006}"));
  // No friction of the range goes with the least of this one.
  CHECK_THROWS_WITH(load("{min: 0.002, max: 0.006}", "{min: 0.001, max: 0.006}"),
                    Contains("breakaway_torque_nm"));
  const Experiment fit = load("{min: 0.001, max: 0.006}", "{min: 0.001, max: 0.006}");
  CHECK(KeepsRules(fit, {0.003, 0.004}));
  CHECK_FALSE(KeepsRules(fit, {0.004, 0.003}));
}

TEST_CASE("A whole number is not fitted") {
  CHECK_THROWS_WITH(LoadFit("{link.uart_bytes: {min: 10, max: 60}}"),
                    Contains("task.yaml:4:") &&
                        Contains("calibrate.fit: simulation.link.uart_bytes is a whole number, and "
                                 "only a key that may have a fraction can be fitted"));
}

TEST_CASE("A key is fitted once, however it is named") {
  const std::string range = ": {min: 0.1, max: 1.2}";
  for (const std::string other : {"surfaces.ground.mu", "simulation.terrain.surfaces.ground.mu"}) {
    INFO(other);
    CHECK_THROWS_WITH(LoadFit("{" + other + range + ", \"surfaces.{surface}.mu\"" + range + "}"),
                      Contains("simulation.terrain.surfaces.ground.mu stands there twice: it is "
                               "at task.yaml:4:"));
  }
  CHECK_NOTHROW(LoadFit("{surfaces.bump.mu" + range + ", \"surfaces.{surface}.mu\"" + range + "}"));
}

TEST_CASE("Trials are held out by their names, and some are left to fit") {
  const std::string mismatch = "{motor.mismatch: {min: -0.1, max: 0.1}}";
  const auto held = [&](const std::string& names) {
    return LoadFit(mismatch, {"calibrate.holdout=" + names}).calibrate.holdout.names;
  };
  CHECK(held("[]").empty());
  CHECK(held("[3, 1]") == std::vector<std::string>{"3", "1"});
  CHECK_THROWS_WITH(held("[1, 4]"), Contains("calibrate.holdout names trial 4, and "
                                             "reference.trials has 1, 2, 3"));
  CHECK_THROWS_WITH(held("[4]"), Contains("names trial 4"));
  CHECK_THROWS_WITH(held("[1, 2, 3]"), Contains("names all of reference.trials"));
  CHECK_THROWS_WITH(held("2"), Contains("must be a list of trials, [] for none"));
}

/// A program that is fitted to logs.
Experiment LoadProgramFit(const std::string& fit, const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides{"calibrate.method.runs=1"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return Load(
      "goal: calibrate\ncandidate: {kind: program, run: [sh]}\nspace: {surface: [ice, sand]}\n"
      "reference: {kind: logs, path: \"{surface}{trial}.csv\", trials: [1, 2]}\n"
      "calibrate: {fit: " +
          fit + "}\n",
      overrides);
}

TEST_CASE("A program's fit starts at the prior's mean or in the middle, under names of its own") {
  const Experiment experiment = LoadProgramFit(
      "{mu: {min: 0.1, max: 0.5}, \"lag_{surface}\": {min: 0, max: 1, mean: 0.25, sd: 0.1}}");
  const auto& fit = experiment.calibrate.fit.list;
  REQUIRE(fit.size() == 3);
  CHECK(fit[0].start == Approx(0.3));
  CHECK(fit[1].key == "lag_ice");
  CHECK(fit[2].key == "lag_sand");
  CHECK(fit[2].start == 0.25);
  const std::vector<Parameter> parameters = ProgramParameters(experiment);
  REQUIRE(parameters.size() == 4);
  CHECK(parameters[0].key == "surface");
  CHECK(parameters[1].key == "mu");
  CHECK(parameters[1].min == 0.1);
  CHECK(parameters[1].max == 0.5);
  CHECK(*parameters[1].nominal == Approx(0.3));
  CHECK(WithFitted({{"ice", {}}}, {0.5, 2.0}) ==
        Theta{{"ice", {}}, NumberValue(0.5), NumberValue(2.0)});
  const Theta nominal = NominalTheta(experiment);
  REQUIRE(nominal.size() == 4);
  CHECK(nominal[0].text == "ice");
  CHECK(nominal[3].number == 0.25);
}

TEST_CASE("A program's fit takes no name that its trials have already, and whole runs alone") {
  const std::string mu = "{mu: {min: 0.1, max: 0.5}}";
  for (const char* name : {"seed", "trial", "out", "theta", "folder"}) {
    INFO(name);
    CHECK_THROWS_WITH(LoadProgramFit("{" + std::string(name) + ": {min: 0.1, max: 0.5}}"),
                      Contains("is what a program's trial calls something else"));
  }
  CHECK_THROWS_WITH(LoadProgramFit("{surface: {min: 0.1, max: 0.5}}"),
                    Contains("shares its name 'surface'"));
  CHECK_THROWS_WITH(LoadProgramFit("{a.mu: {min: 0.1, max: 0.5}, b.mu: {min: 0.1, max: 0.5}}"),
                    Contains("shares its name 'mu'"));
  CHECK_THROWS_WITH(LoadProgramFit(mu, {"calibrate.method.runs=0"}),
                    Contains("calibrate.method.runs is 0"));
  for (const char* horizon : {"phases=2", "most_frames=7", "moved_m=0.123"}) {
    CHECK_THROWS_WITH(LoadProgramFit(mu, {std::string("calibrate.method.horizon.") + horizon}),
                      Contains("calibrate.method.horizon predicts the next frames"));
  }
  CHECK_THROWS_WITH(LoadProgramFit(mu, {"calibrate.method.features.rounds=2"}),
                    Contains("calibrate.method.features.rounds is 2"));
  CHECK_NOTHROW(LoadProgramFit(mu, {"reference.tag_offset_m=0.03"}));
  CHECK_THROWS_WITH(LoadProgramFit("{}"), Contains("such as {mu: {min: 0.1, max: 1}}"));
}

TEST_CASE("An experiment at calibrated values has them in place of its own, and no ensemble") {
  const Experiment fit =
      LoadFit("{motor.mismatch: {min: -0.1, max: 0.2}, link.delay_s: {min: 0, max: 0.3}}",
              {"ensemble.keys=[simulation.link.delay_s]", "ensemble.draws=[[0.1], [0.2]]"});
  REQUIRE_FALSE(fit.ensemble.IsEmpty());
  const Experiment at = CalibratedAt(fit, {0.125, 0.25});
  CHECK(at.simulation.motor.mismatch == 0.125);
  CHECK(at.simulation.link.delay_s == 0.25);
  CHECK(at.ensemble.IsEmpty());
}

}  // namespace
}  // namespace rift::experiment
