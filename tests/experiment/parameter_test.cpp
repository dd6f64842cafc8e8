// Parameters of a space: their values, their grid, the steps of a person, paths that name them.
#include "rift/experiment/parameter.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <string>
#include <vector>

#include "rift/experiment/path_template.hpp"
#include "rift/experiment/settable.hpp"
#include "rift/experiment/words.hpp"

namespace rift::experiment {
namespace {

using Catch::Matchers::Contains;

Parameter Range(double min, double max, std::optional<double> step = {}) {
  Parameter range{.key = "block.unknown", .min = min, .max = max};
  range.step = step;
  return range;
}

TEST_CASE("A parameter is called by the last part of its key") {
  CHECK(Parameter{.key = "simulation.terrain.surface"}.Name() == "surface");
  CHECK(Parameter{.key = "mu"}.Name() == "mu");
  CHECK(Parameter{.key = "a.b.c"}.Name() == "c");
}

TEST_CASE("An axis with one word among its levels is categorical, and one without levels a range") {
  const Parameter numbers{.key = "a", .levels = {{"1", 1.0}, {"2", 2.0}}};
  const Parameter mixed{.key = "a", .levels = {{"1", 1.0}, {"two", {}}}};
  CHECK_FALSE(numbers.IsCategorical());
  CHECK(mixed.IsCategorical());
  CHECK_FALSE(Range(0, 1).IsCategorical());
  CHECK(Range(0, 1).IsContinuous());
  CHECK_FALSE(numbers.IsContinuous());
}

TEST_CASE("Values are the same by their number where both have one, else by their text") {
  CHECK(SameValue({"0.3", 0.3}, {"0.30", 0.3}));
  CHECK_FALSE(SameValue({"0.3", 0.3}, {"0.31", 0.31}));
  CHECK(SameValue({"ice", {}}, {"ice", {}}));
  CHECK_FALSE(SameValue({"ice", {}}, {"sand", {}}));
  CHECK_FALSE(SameValue({"1", 1.0}, {"one", {}}));
  CHECK(SameValue({"1", 1.0}, {"1", {}}));
}

TEST_CASE("A value of a table is the level of that text, else a number unless the axis has words") {
  const Parameter words{.key = "a", .levels = {{"ice", {}}, {"7", 7.0}}};
  CHECK(ParseValue(words, "ice").text == "ice");
  CHECK(ParseValue(words, "7").number == 7.0);
  CHECK_FALSE(ParseValue(words, "8").number);
  const Parameter numbers{.key = "a", .levels = {{"0.20", 0.2}}};
  CHECK(ParseValue(numbers, "0.20").number == 0.2);
  CHECK(ParseValue(numbers, "0.25").number == 0.25);
  CHECK(ParseValue(numbers, "0.25").text == "0.25");
  CHECK(ParseValue(Range(0, 1), "0.125").number == 0.125);
  CHECK(NumberValue(0.1).text == "0.1");
  CHECK_THROWS_AS(NumberValue(std::numeric_limits<double>::infinity()), std::invalid_argument);
  CHECK_THROWS_AS(NumberValue(std::nan("")), std::invalid_argument);
}

TEST_CASE("The paper's grid has its surfaces and speeds in their order") {
  const Space space = PaperSpace();
  REQUIRE(space.parameters.size() == 3);
  const auto texts = [&](size_t i) {
    std::vector<std::string> all;
    for (const ParameterValue& level : space.parameters[i].levels) all.push_back(level.text);
    return all;
  };
  CHECK(space.parameters[0].key == "simulation.terrain.surface");
  CHECK(texts(0) ==
        std::vector<std::string>{"ground", "cardboard", "parchment", "uphill", "downhill"});
  CHECK(space.parameters[1].key == "control.v_min");
  CHECK(texts(1) == std::vector<std::string>{"0.15", "0.20"});
  CHECK(space.parameters[2].key == "control.v_max");
  CHECK(texts(2) == std::vector<std::string>{"0.30", "0.40", "0.50"});
  for (size_t i = 1; i < 3; ++i) {
    for (const ParameterValue& level : space.parameters[i].levels) {
      CHECK(level.number == std::stod(level.text));
    }
  }
}

TEST_CASE("A grid is every combination once, the first parameter changing slowest") {
  CHECK(GridPoints({}) == std::vector<Theta>{{}});
  const Parameter a{.key = "a", .levels = {{"x", {}}, {"y", {}}}};
  const Parameter b{.key = "b", .levels = {{"1", 1.0}, {"2", 2.0}, {"3", 3.0}}};
  std::string order;
  for (const Theta& point : GridPoints({a, b})) order += point[0].text + point[1].text + " ";
  CHECK(order == "x1 x2 x3 y1 y2 y3 ");
}

TEST_CASE("A grid refuses ranges by their place and more than a million settings") {
  Parameter range = Range(0, 1);
  range.origin = "task.yaml:3:4";
  CHECK_THROWS_WITH(CheckGrid({range}),
                    "task.yaml:3:4: space.block.unknown is a range, and a grid needs the values to "
                    "visit: write a list, or set goal: falsify");
  const auto axis = [](int levels) {
    Parameter parameter{.key = "a"};
    for (int i = 0; i < levels; ++i) parameter.levels.push_back(NumberValue(i));
    return parameter;
  };
  CHECK_NOTHROW(CheckGrid({axis(1000), axis(1000)}));
  CHECK_THROWS_WITH(CheckGrid({axis(1000), axis(1001)}), Contains("space is a grid of 1e+06"));
}

TEST_CASE("A person can set what the host's controller takes, waypoints and the floor") {
  // Keys with their steps; 0: no number.
  const std::vector<std::pair<std::string, double>> keys{{"control.distance.p", 0.05},
                                                         {"control.distance.i", 0.01},
                                                         {"control.distance.d", 0.005},
                                                         {"control.heading.p", 0.005},
                                                         {"control.heading.i", 0.001},
                                                         {"control.heading.d", 0.0005},
                                                         {"control.derivative_kick", 0.0},
                                                         {"control.reach_radius_m", 0.005},
                                                         {"control.v_min", 0.01},
                                                         {"control.v_max", 0.01},
                                                         {"control.w_min", 0.005},
                                                         {"control.w_max", 0.05},
                                                         {"control.cruise_speed", 0.01},
                                                         {"control.cruise_cap_angle_deg", 1.0},
                                                         {"control.through_angle_deg", 1.0},
                                                         {"control.slew_rate_per_s", 0.1},
                                                         {"control.latency.delay_s", 0.01},
                                                         {"trial.control_period_s", 0.005},
                                                         {"trial.pace", 0.0},
                                                         {"simulation.terrain.surface", 0.0},
                                                         {"program.power", 0.01},
                                                         {"program.speed_mps", 0.01},
                                                         {"program.segments[3].power", 0.01},
                                                         {"waypoints[0].x", 0.005},
                                                         {"waypoints[12].y", 0.005},
                                                         {"waypoints[2].heading", 1.0}};
  for (const auto& [key, step] : keys) {
    INFO(key);
    const auto found = FindSettable(key);
    REQUIRE(found);
    CHECK(found->step == step);
  }
  for (const char* key : {"simulation.motor.mismatch", "v_minimum", "control", "trial.timeout_s",
                          "waypoints[].z", "other.v_min", ""}) {
    INFO(key);
    CHECK_FALSE(FindSettable(key));
  }
  CHECK(FindSettable("v_min")->step == 0.01);  // the column of a table
  CHECK(FindSettable("surface"));
  CHECK_FALSE(FindSettable("min"));
  // A program's own names: two loops have a p, and a waypoint an x.
  for (const char* name : {"p", "i", "d", "power", "x", "y", "heading"}) {
    INFO(name);
    CHECK_FALSE(FindSettable(name));
  }
}

TEST_CASE("The space says whether a parameter can be set, else its key") {
  Parameter speed{.key = "control.v_min", .min = 0.1, .max = 0.2};
  Parameter motor{.key = "simulation.motor.mismatch", .min = -0.1, .max = 0.1};
  CHECK(IsSettable(speed));
  CHECK_FALSE(IsSettable(motor));
  speed.settable = false;
  motor.settable = true;
  CHECK_FALSE(IsSettable(speed));
  CHECK(IsSettable(motor));
}

TEST_CASE("The step of a range is its own, its key's, or a round twentieth of it or more") {
  CHECK(StepOf(Range(0, 1, 0.3)) == 0.3);
  CHECK(StepOf({.key = "control.v_min", .min = 0.1, .max = 0.2}) == 0.01);
  CHECK(StepOf(Range(0, 20)) == Approx(1.0));
  CHECK(StepOf(Range(0, 21)) == Approx(2.0));
  CHECK(StepOf(Range(0, 40)) == Approx(2.0));
  CHECK(StepOf(Range(0, 41)) == Approx(5.0));
  CHECK(StepOf(Range(0, 101)) == Approx(10.0));
  CHECK(StepOf(Range(5, 5.4)) == Approx(0.02));
  Parameter whole = Range(0, 3);
  whole.is_integer = true;
  CHECK(StepOf(whole) == 1.0);
  whole.max = 55;
  CHECK(StepOf(whole) == 5.0);
  whole.step = 3.0;
  CHECK(StepOf(whole) == 3.0);
}

TEST_CASE("A value is set to the nearest step within its range, and a level as it is") {
  const auto nearest = [](const Parameter& parameter, double value) {
    return NearestSettable(parameter, NumberValue(value));
  };
  CHECK(nearest(Range(0, 1, 0.1), 0.2999).text == "0.3");
  CHECK(nearest(Range(0, 1, 0.1), 0.34).text == "0.3");
  CHECK(nearest(Range(0, 1, 0.1), 0.36).text == "0.4");
  CHECK(nearest(Range(-1, 1, 0.25), -0.6).number == -0.5);
  CHECK(nearest(Range(0.12, 0.27, 0.1), 0.12).number == 0.2);   // 0.1 is below the range
  CHECK(nearest(Range(0.12, 0.27, 0.1), 0.27).number == 0.2);   // 0.3 above it
  CHECK(nearest(Range(0.12, 0.18, 0.1), 0.15).number == 0.18);  // no step lies in it
  CHECK(nearest(Range(0, 100, 30), 50).number == 60.0);
  CHECK(nearest(Range(0, 2, 0.3), 1.0).number == Approx(0.9));
  const Parameter levels{.key = "a", .levels = {{"0.15", 0.15}}};
  CHECK(NearestSettable(levels, {"0.153", 0.153}).text == "0.153");
  CHECK(NearestSettable(Range(0, 1, 0.1), {"word", {}}).text == "word");
}

TEST_CASE("A bound that is a whole number of steps can be set, at either end") {
  const auto nearest = [](const Parameter& parameter, double value) {
    return NearestSettable(parameter, NumberValue(value)).text;
  };
  CHECK(nearest(Range(0, 0.3, 0.1), 0.3) == "0.3");  // 3 * 0.1 is more, and 0.3 / 0.1 less than 3
  CHECK(nearest(Range(0.1, 0.3, 0.05), 0.29) == "0.3");
  CHECK(nearest(Range(0.1, 0.3, 0.05), 0.27) == "0.25");
  CHECK(nearest(Range(-0.3, 0.3, 0.1), -0.3) == "-0.3");
  CHECK(nearest(Range(-0.3, -0.1, 0.1), -0.1) == "-0.1");
  CHECK(nearest(Range(0.3, 1, 0.1), 0.3) == "0.3");
  CHECK(nearest(Range(0, 0.2999, 0.1), 0.2999) == "0.2");  // truly below a step
  CHECK(nearest(Range(-0.2999, 0, 0.1), -0.2999) == "-0.2");
}

TEST_CASE("A range over decades without a step of its own is set to 1, 2 or 5 in each of them") {
  Parameter range = Range(1e-4, 1);
  range.is_logarithmic = true;
  const auto nearest = [&](double value) {
    return NearestSettable(range, NumberValue(value)).text;
  };
  CHECK(nearest(1e-3) == "0.001");
  CHECK(nearest(1e-4) == "0.0001");
  CHECK(nearest(1.3e-4) == "0.0001");  // below the root of 2, and above it
  CHECK(nearest(1.5e-4) == "0.0002");
  CHECK(nearest(3.1e-4) == "0.0002");  // about the root of 10
  CHECK(nearest(3.2e-4) == "0.0005");
  CHECK(nearest(0.069) == "0.05");  // about the root of 50
  CHECK(nearest(0.072) == "0.1");
  CHECK(nearest(1.0) == "1");
  range.max = 0.9;  // no value above the range, nor below it
  CHECK(nearest(0.9) == "0.5");
  range.min = 3e-4;
  CHECK(nearest(3e-4) == "0.0005");
  range.max = 4e5;
  CHECK(nearest(3e5) == "200000");
  range.min = 0.07, range.max = 0.7;  // a decade to the last bit
  CHECK(nearest(0.07) == "0.1");
  range.max = 0.6;  // less than a decade: a twentieth, 0.05
  CHECK(nearest(0.44) == "0.45");
  range.max = 1000.0;
  range.step = 0.25;
  CHECK(nearest(0.3) == "0.25");
  range.step.reset();
  range.key = "control.v_min";  // in steps of 0.01
  CHECK(nearest(0.134) == "0.13");
  range.key = "block.unknown";
  range.is_logarithmic = false;
  CHECK(nearest(70.0) == "50");
  CHECK(StepOf(range) == 50.0);
}

TEST_CASE("A name's unit is its ending, and the word before it its label") {
  const std::vector<std::pair<std::string, std::string>> units{{"a_rad_per_mps", "rad/(m/s)"},
                                                               {"a_ns_per_m", "N s/m"},
                                                               {"a_n_per_m", "N/m"},
                                                               {"a_rad_s", "rad/s"},
                                                               {"a_kg_m2", "kg m²"},
                                                               {"a_mps2", "m/s²"},
                                                               {"a_deg_s", "°/s"},
                                                               {"a_mps", "m/s"},
                                                               {"a_rad", "rad"},
                                                               {"a_deg", "°"},
                                                               {"a_kg", "kg"},
                                                               {"a_nm", "N m"},
                                                               {"a_hz", "Hz"},
                                                               {"a_ms", "ms"},
                                                               {"a_mm", "mm"},
                                                               {"a_px", "px"},
                                                               {"a_m", "m"},
                                                               {"a_s", "s"}};
  for (const auto& [name, unit] : units) {
    INFO(name);
    CHECK(UnitOf(name) == unit);
    CHECK(LabelOf(name) == "a (" + unit + ")");
  }
  CHECK(UnitOf("mu").empty());
  CHECK(UnitOf("_m").empty());  // nothing would be left
  CHECK(LabelOf("mu") == "mu");
}

TEST_CASE("A value is named with its parameter and unit unless it is a word") {
  const auto named = [](const std::string& key, const std::string& text) {
    return NamedValue({.key = key, .min = 0, .max = 1}, text);
  };
  CHECK(named("simulation.link.delay_s", "0.2") == "delay 0.2 s");
  CHECK(named("control.v_min", "0.15") == "v_min 0.15");
  CHECK(NamedValue({.key = "surface", .levels = {{"ice", {}}}}, "ice") == "ice");
}

TEST_CASE("The help of a key is its own, or that of the one key with its last name") {
  CHECK_FALSE(HelpOf("control.v_min").empty());
  CHECK(HelpOf("v_min") == HelpOf("control.v_min"));
  CHECK(HelpOf("no_such_key_anywhere").empty());
  CHECK(HelpOf("min").empty());
  CHECK(HelpOf("p").empty());  // of several controllers
}

std::string Fill(const std::string& text, const Theta& theta, const std::string& trial = "7") {
  const std::vector<Parameter> parameters{{.key = "space.surface"}, {.key = "control.v_min"}};
  return FillTemplate(text, parameters, theta, trial);
}
const Theta kTheta{{"ice", {}}, {"0.20", 0.2}};

TEST_CASE("Names in braces are filled in as they are written, or as their format says") {
  CHECK(Fill("{surface}/{v_min}_{trial}.csv", kTheta) == "ice/0.20_7.csv");
  CHECK(Fill("{v_min}{v_min}", kTheta) == "0.200.20");
  CHECK(Fill("{v_min:.3f}", kTheta) == "0.200");
  CHECK(Fill("{trial:03d}", kTheta) == "007");
  CHECK(Fill("{surface:>5}", kTheta) == "  ice");
  CHECK(Fill("{v_min:.1f}", {{"ice", {}}, {"2", 2.0}}) == "2.0");
  CHECK(Fill("plain", kTheta) == "plain");
  CHECK(TemplateNames("{a}/{b:.2f}_{a}") == std::vector<std::string>{"a", "b", "a"});
  CHECK(TemplateNames("plain").empty());
}

TEST_CASE("A template that cannot be filled in says which field and which value") {
  CHECK_THROWS_WITH(Fill("{floor}", kTheta),
                    "path '{floor}' names {floor}, and the space has only surface, v_min, trial");
  CHECK_THROWS_WITH(Fill("{surface:.2f}", kTheta),
                    "path '{surface:.2f}' cannot be filled in: {surface:.2f} does not fit 'ice'");
  CHECK_THROWS_WITH(Fill("{v_min:03d}", kTheta), Contains("{v_min:03d} does not fit '0.20'"));
  CHECK_THROWS_WITH(Fill("{v_min:.2f}{surface:.1f}", kTheta),
                    Contains("{surface:.1f} does not fit 'ice'"));
  for (const char* broken : {"{a", "a}", "{a{b}}", "}{", "{{a}"}) {
    INFO(broken);
    CHECK_THROWS_WITH(TemplateNames(broken),
                      std::string("path '") + broken + "' has a brace without its partner");
  }
}

TEST_CASE("What a person sets on the robot has the step that a hand and a ruler reach") {
  const std::vector<std::pair<std::string, double>> steps{{"control.distance.p", 0.05},
                                                          {"control.distance.i", 0.01},
                                                          {"control.distance.d", 0.005},
                                                          {"control.heading.p", 0.005},
                                                          {"control.heading.i", 0.001},
                                                          {"control.heading.d", 0.0005},
                                                          {"control.reach_radius_m", 0.005},
                                                          {"control.v_max", 0.01},
                                                          {"control.w_min", 0.005},
                                                          {"control.w_max", 0.05},
                                                          {"control.cruise_speed", 0.01},
                                                          {"control.cruise_cap_angle_deg", 1.0},
                                                          {"control.through_angle_deg", 1.0},
                                                          {"control.slew_rate_per_s", 0.1},
                                                          {"control.latency.delay_s", 0.01},
                                                          {"trial.control_period_s", 0.005},
                                                          {"program.power", 0.01},
                                                          {"program.speed_mps", 0.01},
                                                          {"program.segments[2].power", 0.01},
                                                          {"waypoints[1].x", 0.005},
                                                          {"waypoints[12].y", 0.005},
                                                          {"waypoints[3].heading", 1.0}};
  for (const auto& [key, step] : steps) {
    INFO(key);
    const Parameter parameter{.key = key, .min = 0.0, .max = 7.0};
    CHECK(IsSettable(parameter));
    CHECK(StepOf(parameter) == step);
  }
  for (const char* word : {"control.derivative_kick", "trial.pace", "simulation.terrain.surface"}) {
    INFO(word);
    const Parameter parameter{.key = word, .min = 0.0, .max = 4.0};
    CHECK(IsSettable(parameter));
    CHECK(StepOf(parameter) == Approx(0.2));  // of no step of their own: a twentieth
  }
  for (const char* key : {"simulation.motor.mismatch", "control.p", "waypoints.x", "program"}) {
    INFO(key);
    CHECK_FALSE(IsSettable({.key = key, .max = 1.0}));
  }
}

}  // namespace
}  // namespace rift::experiment
