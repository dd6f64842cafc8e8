#include <random>

#include <catch2/catch.hpp>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/write.hpp"
#include "robot_schema.hpp"
#include "support/inputs/random_fill.hpp"

namespace rift::yaml::test {
namespace {

/// Parses and binds; true when both were accepted. Anything but an Error escapes.
bool Accepts(const std::string& text) {
  try {
    const Node root = Parse(text, "f");
    CHECK(Emit(Parse(Emit(root), "g")) == Emit(root));
    Robot robot;
    Bind(root, robot);
    return true;
  } catch (const Error& error) {
    CHECK(std::string(error.what()).find('\n') == std::string::npos);
    return false;
  }
}

std::string ValidPage(std::mt19937_64& random) {
  Robot robot;
  rift::test::RandomFill(robot, random);
  return Emit(ToNode(robot, random() % 2 == 0));
}

std::string RandomBytes(std::mt19937_64& random) {
  static const std::string kYaml = "abz019 \n\n:-[]{},#\"'|>&*!?%@`~\t.\\<=";
  std::string text;
  for (std::size_t left = random() % 60; left > 0; --left) {
    text += random() % 40 == 0 ? static_cast<char>(random()) : kYaml[random() % kYaml.size()];
  }
  return text;
}

void Mutate(std::string& text, std::mt19937_64& random) {
  for (std::size_t left = 1 + random() % 4; left > 0 && !text.empty(); --left) {
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0:
        text.erase(at, 1 + random() % 8);
        break;
      case 1:
        text.insert(at, RandomBytes(random).substr(0, 6));
        break;
      case 2:
        text[at] = static_cast<char>(random());
        break;
      default:
        text.insert(at, text.substr(random() % text.size(), random() % 40));
    }
  }
}

TEST_CASE("Random bytes give an error or a tree and nothing else") {
  std::mt19937_64 random(11);
  for (int i = 0; i < 20'000; ++i) {
    const std::string text = RandomBytes(random);
    INFO(text);
    Accepts(text);
  }
}

TEST_CASE("A damaged page gives an error or an experiment and nothing else") {
  std::mt19937_64 random(12);
  int accepted = 0;
  for (int page = 0; page < 100; ++page) {
    const std::string whole = ValidPage(random);
    REQUIRE(Accepts(whole));
    for (int i = 0; i < 50; ++i) {
      std::string text = whole;
      Mutate(text, random);
      INFO(text);
      accepted += Accepts(text) ? 1 : 0;
    }
  }
  CHECK(accepted > 50);
  CHECK(accepted < 4'950);
}

TEST_CASE("A page cut off at any byte gives an error or an experiment and nothing else") {
  Robot robot;
  robot.waypoints = {{"{a}", 1.0, 2.0, true}, {"it's \"b\"\n", 3.0, 4.0, false}};
  const std::string whole =
      Emit(ToNode(robot, true)) + "# end\nspace.more: {gap.samples: ['1', 2]}\n";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    INFO(size);
    Accepts(whole.substr(0, size));
  }
}

TEST_CASE("Random overrides give an error or a tree and nothing else") {
  std::mt19937_64 random(14);
  for (int i = 0; i < 5'000; ++i) {
    const std::string text = "gap." + RandomBytes(random) + "=" + RandomBytes(random);
    INFO(text);
    try {
      Node root = Node::Map();
      Merge(root, ParseOverride(text));
      Robot robot;
      Bind(root, robot);
    } catch (const Error& error) {
      CHECK(std::string(error.what()).find("--set") == 0);
    }
  }
}

}  // namespace
}  // namespace rift::yaml::test
