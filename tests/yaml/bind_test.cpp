#include <algorithm>
#include <catch2/catch.hpp>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "robot_schema.hpp"

namespace elsewhere {

struct Span {
  double low = 0.0;
  double high = 1.0;
};

}  // namespace elsewhere

template <>
struct rift::yaml::Hook<elsewhere::Span> {
  static constexpr std::string_view kTypeText = "[low, high]";
  static elsewhere::Span FromNode(const Node& node) {
    if (node.items.size() != 2) throw std::invalid_argument("must be [low, high]");
    return {ReadDouble(node.items[0], {}), ReadDouble(node.items[1], {})};
  }
  static Node ToNode(const elsewhere::Span& span) {
    return Node::List({Node::Scalar(NumberText(span.low)), Node::Scalar(NumberText(span.high))});
  }
};

namespace rift::yaml::test {
namespace {

struct Plot {
  elsewhere::Span span;
  static constexpr std::array<std::string_view, 1> kRequired{"span"};

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("span", self.span, "what is shown");
  }
};

Robot Bound(const std::string& text) {
  Robot robot;
  Bind(Parse(text, "f.yaml"), robot);
  return robot;
}

std::string BindError(const std::string& text) {
  return ErrorOf([&] { Bound(text); });
}

TEST_CASE("A file sets what it names and leaves the other defaults") {
  const Robot robot = Bound(
      "title: 1.0\nseed: 18446744073709551615\nheadless: false\n"
      "control: {v_min: 0.2, cruise_cap: 0.3}\ngap: {samples: 1e3, align: se2}\n"
      "speeds_mps: [1, +0.5, .25]\ntags: [a, \"true\", 3]\n"
      "waypoints:\n  - {name: end, x_m: 0.3832, y_m: -0.0597, stop: false}\n"
      "surfaces: {cardboard: {friction: 0.6}, ice: {friction: 0.05}}\ntrials: 2\n");
  CHECK(robot.title == "1.0");
  CHECK(robot.seed == 18446744073709551615ULL);
  CHECK_FALSE(robot.headless);
  CHECK(robot.control.v_min == 0.2);
  CHECK(robot.control.v_max == 0.4);
  CHECK(robot.control.cruise_cap == 0.3);
  CHECK(robot.gap.samples == 1000);
  CHECK(robot.gap.align == Align::kSe2);
  CHECK(robot.speeds_mps == std::vector<double>{1.0, 0.5, 0.25});
  CHECK(robot.tags == std::vector<std::string>{"a", "true", "3"});
  REQUIRE(robot.waypoints.size() == 1);
  CHECK(robot.waypoints[0].x_m == 0.3832);
  CHECK_FALSE(robot.waypoints[0].stop);
  CHECK(robot.surfaces.size() == 3);
  CHECK(robot.surfaces.at("cardboard").friction == 0.6);
  CHECK(robot.surfaces.at("ground").friction == 0.8);
  CHECK(robot.trials.numbers == std::vector<int>{1, 2});
}

TEST_CASE("Nothing written means the defaults") { CHECK(SameButSpace(Bound(""), Robot{})); }

TEST_CASE("An optional number is taken away by null") {
  Robot robot;
  robot.control.cruise_cap = 0.5;
  Bind(Parse("control: {cruise_cap: null}", "f"), robot);
  CHECK_FALSE(robot.control.cruise_cap.has_value());
}

TEST_CASE("An entry of a map of blocks changes only what it names") {
  Robot robot;
  robot.surfaces["ground"].control.v_min = 0.05;
  Bind(Parse("surfaces: {ground: {friction: 1}}", "f"), robot);
  CHECK(robot.surfaces["ground"].friction == 1.0);
  CHECK(robot.surfaces["ground"].control.v_min == 0.05);
}

TEST_CASE("A refused file leaves the struct alone") {
  Robot robot;
  CHECK_THROWS_AS(Bind(Parse("title: new\nseed: x\n", "f"), robot), Error);
  CHECK(robot.title == "3pi+");
}

TEST_CASE("An unknown key names the nearest one") {
  CHECK(BindError("control:\n  vmin: 0.2\n") ==
        "f.yaml:2:3: key 'control.vmin' is 0.2: no such key; did you mean 'control.v_min'?");
  CHECK(BindError("waypoints: [{x: 1, y: 2}]\n") ==
        "f.yaml:1:14: key 'waypoints[0].x' is 1: no such key; did you mean 'waypoints[0].x_m'?");
  CHECK(BindError("v_max: 0.2\n") ==
        "f.yaml:1:1: key 'v_max' is 0.2: no such key; did you mean 'control.v_max'?");
  CHECK(BindError("gap: {quux: [1]}\n") ==
        "f.yaml:1:7: key 'gap.quux' is a list of 1: no such key; "
        "known keys here: samples, skip_start, align");
  CHECK(BindError("incude: other.yaml\n") ==
        "f.yaml:1:1: key 'incude' is other.yaml: no such key; did you mean 'include'?");
  CHECK_THAT(BindError("gap: {incude: 1}\n"), !Catch::Contains("include"));
}

TEST_CASE("A number out of range names the range") {
  CHECK(
      BindError("control: {v_min: 1.7}") ==
      "f.yaml:1:18: key 'control.v_min' is 1.7: must be in [0, 1]; meaning: lowest forward power");
  CHECK(BindError("gap: {samples: 1}") ==
        "f.yaml:1:16: key 'gap.samples' is 1: must be in [2, 10000000]; "
        "meaning: evenly spaced values of u");
  CHECK(BindError("gap: {samples: 99999999999999999999}") ==
        "f.yaml:1:16: key 'gap.samples' is 99999999999999999999: must be in [2, 10000000]; "
        "meaning: evenly spaced values of u");
  CHECK(BindError("speeds_mps: [1, 2, 3]") ==
        "f.yaml:1:20: key 'speeds_mps[2]' is 3: must be in [0, 2]; "
        "meaning: speeds that are tried");
  CHECK(BindError("surfaces: {ice: {friction: -1}}") ==
        "f.yaml:1:28: key 'surfaces.ice.friction' is -1: must be at least 0; meaning: Coulomb");
  CHECK(BindError("control: {cruise_cap: 2}") ==
        "f.yaml:1:23: key 'control.cruise_cap' is 2: must be in [0, 1]; "
        "meaning: cruise power; null for none");
}

TEST_CASE("A number that is not finite is refused") {
  for (const std::string text :
       {"nan", "inf", "-inf", ".nan", ".inf", "-.INF", "+.inf", "infinity"}) {
    CHECK(BindError("control: {v_min: " + text + "}") ==
          "f.yaml:1:18: key 'control.v_min' is " + text +
              ": must be a number that is finite; meaning: lowest forward power");
  }
  CHECK(BindError("control: {v_min: 1e999}") ==
        "f.yaml:1:18: key 'control.v_min' is 1e999: must be a number that a double can hold; "
        "meaning: lowest forward power");
}

TEST_CASE("Only a decimal number is a number") {
  for (const std::string text : {"0x10", "1_000", "12abc", "1.5.2", "1,5", "--1", "+-1", "1e",
                                 "one", "true", "0.1 m", "+"}) {
    CHECK(BindError("control:\n  v_min: " + text + "\n") ==
          "f.yaml:2:10: key 'control.v_min' is " + text +
              ": must be a number; meaning: lowest forward power");
  }
  CHECK(BindError("control: {v_min: \"0.2\"}") ==
        "f.yaml:1:18: key 'control.v_min' is \"0.2\": must be a number; remove the quotes; "
        "meaning: lowest forward power");
  CHECK(
      BindError("control:\n  v_min:\n") ==
      "f.yaml:2:3: key 'control.v_min' is empty: must be a number; meaning: lowest forward power");
  CHECK(BindError("gap: {samples: 2.5}") ==
        "f.yaml:1:16: key 'gap.samples' is 2.5: must be a whole number; "
        "meaning: evenly spaced values of u");
}

TEST_CASE("A seed is a whole number of 64 bits") {
  CHECK(Bound("seed: 1e6").seed == 1'000'000);
  CHECK(BindError("seed: -1") ==
        "f.yaml:1:7: key 'seed' is -1: must be in [0, 18446744073709551615]; "
        "meaning: of every random number");
  CHECK(BindError("seed: 18446744073709551616") ==
        "f.yaml:1:7: key 'seed' is 18446744073709551616: must be in [0, 18446744073709551615]; "
        "meaning: of every random number");
  CHECK(BindError("seed: 1e19") ==
        "f.yaml:1:7: key 'seed' is 1e19: must be written out in digits above 2^53; "
        "meaning: of every random number");
}

TEST_CASE("A wrong type is named") {
  for (const std::string text : {"yes", "True", "1", "\"true\"", "[true]"}) {
    CHECK(BindError("headless: " + text).find("must be true or false; meaning: without a window") !=
          std::string::npos);
  }
  CHECK(BindError("title: [a]") ==
        "f.yaml:1:8: key 'title' is a list of 1: must be text; put quotes around text with [ or {; "
        "meaning: of the report");
  CHECK(BindError("title:") ==
        "f.yaml:1:1: key 'title' is empty: must be text; write \"\" for none; "
        "meaning: of the report");
  CHECK(BindError("tags: a") ==
        "f.yaml:1:7: key 'tags' is a: must be a list; write [a, b], or [] for none");
  CHECK(BindError("gap: 5") ==
        "f.yaml:1:6: key 'gap' is 5: must be a block of keys; give it some, or remove it for the "
        "defaults");
  CHECK(BindError("surfaces: [a]") ==
        "f.yaml:1:11: key 'surfaces' is a list of 1: must be a block of keys; give it some, or "
        "remove it for the defaults");
  CHECK(BindError("5") == "f.yaml:1:1: must be keys with values (key: value)");
}

TEST_CASE("An unknown name of an enum lists the names") {
  CHECK(BindError("gap: {align: strat}") ==
        "f.yaml:1:14: key 'gap.align' is strat: must be one of none, start, se2; did you mean "
        "'start'?; meaning: what is removed before comparing");
  CHECK(BindError("gap: {align: 2}") ==
        "f.yaml:1:14: key 'gap.align' is 2: must be one of none, start, se2; "
        "meaning: what is removed before comparing");
}

TEST_CASE("A required key that is missing is named") {
  CHECK(BindError("waypoints:\n  - {x_m: 1, y_m: 2}\n  - {name: end, x_m: 1}\n") ==
        "f.yaml:3:5: key 'waypoints[1].y_m' is missing: must be given");
}

TEST_CASE("A rule between fields is placed at the key it names that was written last") {
  CHECK(BindError("title: x\ncontrol:\n  v_min: 0.5\n") ==
        "f.yaml:3:3: key 'control': v_min must be at most v_max");
  Node root = Parse("control: {v_max: 0.5}\n", "f.yaml");
  Merge(root, ParseOverride("control.v_min=0.6"));
  Robot robot;
  CHECK(ErrorOf([&] { Bind(root, robot); }) ==
        "--set control.v_min: key 'control': v_min must be at most v_max "
        "(values also from f.yaml)");
  const auto error = [](const std::string& base, const std::string& own) {
    Node whole = Parse(base, "base.yaml");
    Merge(whole, Parse(own, "own.yaml"));
    Robot bound;
    return ErrorOf([&] { Bind(whole, bound); });
  };
  CHECK(error("control: {v_max: 0.2}\n", "title: x\ncontrol:\n  v_min: 0.3\n") ==
        "own.yaml:3:3: key 'control': v_min must be at most v_max (values also from base.yaml)");
  CHECK(error("control: {v_min: 0.2}\n", "control: {v_max: 0.1}\n") ==
        "own.yaml:1:11: key 'control': v_min must be at most v_max (values also from base.yaml)");
  CHECK(error("control: {v_min: 0.2, v_max: 0.1}\n", "title: x\n") ==
        "base.yaml:1:11: key 'control': v_min must be at most v_max");
  // Of three writers the command line is the last, in whatever order the rule names their keys.
  Node of_three = Parse("control: {cruise_cap: 0.3}\n", "base.yaml");
  Merge(of_three, Parse("control: {v_min: 0.5}\n", "own.yaml"));
  Merge(of_three, ParseOverride("control.v_max=0.4"));
  CHECK(ErrorOf([&] { Bind(of_three, robot); }) ==
        "--set control.v_max: key 'control': v_min must be at most v_max "
        "(values also from own.yaml)");
}

struct Table {
  std::string food = "bread";
  int seats = 4;
  std::vector<std::string> dishes{"bread", "soup"};

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("food", self.food, "what is on it");
    field("seats", self.seats, 1, 10, "chairs");
    field("dishes", self.dishes, "what there is");
  }
  void Check() const {
    if (seats == 7) throw std::invalid_argument("Seven are too many.");
    if (std::find(dishes.begin(), dishes.end(), food) != dishes.end()) return;
    throw std::invalid_argument("food is no dish");
  }
  std::string Choice() const { return food; }
  std::vector<std::string> Choices() const { return dishes; }
};

TEST_CASE(
    "A choice that is none gets the nearest one proposed, and a rule without keys the block") {
  const auto error = [](const std::string& own, const std::string& set) {
    Node whole = Parse("dishes: [bread, soup]\nseats: 3\n", "base.yaml");
    Merge(whole, Parse(own, "own.yaml"));
    if (!set.empty()) Merge(whole, ParseOverride(set));
    Table table;
    return ErrorOf([&] { Bind(whole, table); });
  };
  CHECK(error("food: soap", "") == "own.yaml:1:1: food is no dish; did you mean 'soup'?");
  CHECK(error("food: x", "food=bred") == "--set food: food is no dish; did you mean 'bread'?");
  CHECK(error("food: potatoes", "") == "own.yaml:1:1: food is no dish");
  CHECK(error("food: soup\nseats: 7", "") ==
        "own.yaml:2:8: Seven are too many. (values also from base.yaml)");
  CHECK(error("food: soup", "seats=7") ==
        "--set seats: Seven are too many. (values also from base.yaml, own.yaml)");
}

TEST_CASE("A value read by hand is checked by its own rules") {
  CHECK(BindError("trials: {}") ==
        "f.yaml:1:9: key 'trials' is a block of keys: must be a count or a list of numbers");
  CHECK(BindError("trials: [1, 100]") == "f.yaml:1:13: key 'trials' is 100: must be in [1, 99]");
}

TEST_CASE("A type of a room that knows no config is hooked from outside") {
  Plot plot;
  Bind(Parse("span: [0.5, 2]", "f"), plot);
  CHECK(plot.span.high == 2.0);
  CHECK(Emit(ToNode(plot)) == "span: [0.5, 2]\n");
  CHECK(Describe(plot)[0].type == "[low, high]");
  CHECK(ErrorOf([&] { Bind(Parse("span: 5", "f"), plot); }) ==
        "f:1:7: key 'span' is 5: must be [low, high]");
  CHECK(ErrorOf([&] { Bind(Parse("", "f"), plot); }) ==
        "f:1:1: key 'span' is missing: must be given");
}

TEST_CASE("A message stays one line whatever the value") {
  const std::string message = BindError("headless: \"" + std::string(500, 'x') + "\\n\"");
  CHECK(message.size() < 160);
  CHECK(
      BindError("headless: \"a\\nb\"") ==
      "f.yaml:1:11: key 'headless' is \"a\\nb\": must be true or false; meaning: without a window");
}

TEST_CASE("An error of an override names the override") {
  Robot robot;
  CHECK(ErrorOf([&] { Bind(ParseOverride("gap.samples=x"), robot); }) ==
        "--set gap.samples: key 'gap.samples' is x: must be a whole number; "
        "meaning: evenly spaced values of u");
  CHECK(ErrorOf([&] { Bind(ParseOverride("gap.sample=5"), robot); }) ==
        "--set gap.sample: key 'gap.sample' is 5: no such key; did you mean 'gap.samples'?");
}

}  // namespace
}  // namespace rift::yaml::test
