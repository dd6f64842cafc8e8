#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <string_view>

#include <catch2/catch.hpp>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/write.hpp"
#include "robot_schema.hpp"
#include "support/inputs/random_fill.hpp"

namespace rift::yaml::test {
namespace {

std::string EmittedText(const std::string& text) { return Emit(Node::Text(text)); }

TEST_CASE("A written experiment is a page that a person can read") {
  Robot robot;
  robot.waypoints = {{"start", -0.2822, -0.0655, true}, {"{x:.2f}", 0.0, 1e-9, false}};
  CHECK(Emit(ToNode(robot)) ==
        "title: 3pi+\nseed: 1\nheadless: true\n"
        "control:\n  v_min: 0.15\n  v_max: 0.4\n  cruise_cap: null\n"
        "gap:\n  samples: 2000\n  skip_start: 0\n  align: none\n"
        "speeds_mps: [0.1, 0.2]\ntags: [first, second one]\n"
        "waypoints:\n"
        "  - name: start\n    x_m: -0.2822\n    y_m: -0.0655\n    stop: true\n"
        "  - name: \"{x:.2f}\"\n    x_m: 0\n    y_m: 1e-09\n    stop: false\n"
        "surfaces:\n"
        "  cardboard:\n    friction: 0.5\n    control:\n"
        "      v_min: 0.15\n      v_max: 0.4\n      cruise_cap: null\n"
        "  ground:\n    friction: 0.8\n    control:\n"
        "      v_min: 0.15\n      v_max: 0.4\n      cruise_cap: null\n"
        "trials: [1, 2, 3]\nspace: {}\n");
}

TEST_CASE("The help can be written as comments and changes nothing") {
  const Robot robot;
  const std::string page = Emit(ToNode(robot, true));
  CHECK(page.find(
            "gap:  # how the gap is measured\n  samples: 2000  # evenly spaced values of u\n") !=
        std::string::npos);
  CHECK(Emit(Parse(page, "f")) == Emit(ToNode(robot)));
}

TEST_CASE("Text is quoted only when it must be") {
  CHECK(EmittedText("plain") == "plain\n");
  CHECK(EmittedText("two words") == "two words\n");
  CHECK(EmittedText("../shared/a_b-c.csv") == "../shared/a_b-c.csv\n");
  CHECK(EmittedText("größe") == "größe\n");
  CHECK(EmittedText("3pi+") == "3pi+\n");
  CHECK(EmittedText("true") == "\"true\"\n");
  CHECK(EmittedText("No") == "\"No\"\n");
  CHECK(EmittedText("1.0") == "\"1.0\"\n");
  CHECK(EmittedText("") == "\"\"\n");
  CHECK(EmittedText("a: b") == "\"a: b\"\n");
  CHECK(EmittedText("#x") == "\"#x\"\n");
  CHECK(EmittedText(" a") == "\" a\"\n");
  CHECK(EmittedText("a\n\tb\x01") == "\"a\\n\\tb\\x01\"\n");
  CHECK(EmittedText("\"\\") == "\"\\\"\\\\\"\n");
  CHECK(ErrorOf([] { EmittedText("a\xE9"); }) ==
        "text with byte 0xe9 is not UTF-8 and cannot be written as YAML");
}

TEST_CASE("A number that is not finite is not written") {
  Robot robot;
  robot.surfaces["ice"].friction = std::numeric_limits<double>::infinity();
  CHECK(ErrorOf([&] { ToNode(robot); }) ==
        "key 'surfaces.ice.friction' is inf: must be finite to be written");
}

TEST_CASE("Any text comes back from the file as it was") {
  std::mt19937_64 random(7);
  for (int i = 0; i < 5'000; ++i) {
    const std::string text = rift::test::RandomText(random);
    Node map = Node::Map();
    map.Add(text, Node::List({Node::Text(text), Node::Text("x")}));
    const std::string page = Emit(map);
    INFO(page);
    const Node back = Parse(page, "f");
    REQUIRE(back.entries.size() == 1);
    REQUIRE(back.entries[0].key == text);
    REQUIRE(back.entries[0].value.items[0].text == text);
  }
}

std::string RandomScalarText(std::mt19937_64& random) {
  static constexpr std::array<std::string_view, 12> kWords{"true", "false", "null", "~",
                                                           "yes",  ".inf",  "nan",  "2024-01-01",
                                                           "0x10", "---",   "- a",  "a #b"};
  const std::uint64_t kind = random() % 4;
  if (kind == 0) return std::string(kWords.at(random() % kWords.size()));
  if (kind == 1) return rift::test::RandomText(random);
  static constexpr std::string_view kOfNumbers = "+-..0123456789eE";
  std::string text;
  for (std::uint64_t left = 1 + random() % 6; left > 0; --left) {
    text += kOfNumbers.at(random() % kOfNumbers.size());
  }
  return text;
}

TEST_CASE("Any scalar comes back with its text and is a number or a truth value as before") {
  std::mt19937_64 random(10);
  const auto is_truth = [](const Node& node) {
    return !node.quoted && (node.text == "true" || node.text == "false");
  };
  int numbers = 0;
  for (int i = 0; i < 50'000; ++i) {
    const std::string text = RandomScalarText(random);
    const Node scalar = random() % 2 == 0 ? Node::Text(text) : Node::Scalar(text);
    const std::string page = Emit(Node::List({scalar}));
    INFO(page);
    const Node tree = Parse(page, "f");
    const Node& back = tree.items.at(0);
    REQUIRE(back.IsScalar());
    REQUIRE(back.text == text);
    REQUIRE(NumberOf(back) == NumberOf(scalar));
    REQUIRE(is_truth(back) == is_truth(scalar));
    REQUIRE(Emit(tree) == page);
    numbers += NumberOf(scalar).has_value();
  }
  CHECK(numbers > 5'000);
}

TEST_CASE("Any number comes back from the file with the same bits") {
  std::mt19937_64 random(8);
  for (int i = 0; i < 20'000; ++i) {
    double value = 0.0;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    REQUIRE(ReadDouble(Node::Scalar(NumberText(value)), {}) == value);
  }
  const double smallest = std::numeric_limits<double>::denorm_min();
  CHECK(ReadDouble(Node::Scalar(NumberText(smallest)), {}) == smallest);
}

TEST_CASE("A random experiment comes back from its file and is written again the same") {
  std::mt19937_64 random(9);
  for (int i = 0; i < 500; ++i) {
    Robot robot;
    rift::test::RandomFill(robot, random);
    const std::string page = Emit(ToNode(robot));
    INFO(page);
    Robot back;
    Bind(Parse(page, "f"), back);
    REQUIRE(SameButSpace(back, robot));
    REQUIRE(Emit(ToNode(back)) == page);
    REQUIRE(Emit(Parse(page, "f")) == page);
  }
}

TEST_CASE("Lists of lists and of empty blocks come back") {
  const std::string page =
      "a:\n  -\n    - [1, 2]\n    - x: 1\n      y:\n        - z: {}\n  - []\n  - {}\n  - null\n";
  CHECK(Emit(Parse(page, "f")) == page);
}

}  // namespace
}  // namespace rift::yaml::test
