#include <catch2/catch.hpp>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/describe.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/suggest.hpp"
#include "robot_schema.hpp"

namespace rift::yaml::test {
namespace {

std::string LineOf(const std::string& key) {
  for (const KeyInfo& info : Describe<Robot>()) {
    if (info.key == key) return info.type + " (" + info.default_text + ") " + info.help;
  }
  return "not listed";
}

std::string SetError(const std::string& key, const std::string& value) {
  Robot robot;
  return ErrorOf([&] { SetValue(robot, key, Parse(value, "f")); });
}

TEST_CASE("Every key is described with its type and default and help") {
  CHECK(LineOf("control.v_min") == "number in [0, 1] (0.15) lowest forward power");
  CHECK(LineOf("control.cruise_cap") ==
        "number in [0, 1], or null (null) cruise power; null for none");
  CHECK(LineOf("gap.samples") == "whole number in [2, 10000000] (2000) evenly spaced values of u");
  CHECK(LineOf("gap.align") == "none | start | se2 (none) what is removed before comparing");
  CHECK(LineOf("seed") == "whole number (1) of every random number");
  CHECK(LineOf("headless") == "true | false (true) without a window");
  CHECK(LineOf("title") == "text (3pi+) of the report");
  CHECK(LineOf("speeds_mps") == "list, each number in [0, 2] ([0.1, 0.2]) speeds that are tried");
  CHECK(LineOf("waypoints") == "list of blocks ([]) where the robot goes");
  CHECK(LineOf("waypoints[].x_m") == "number in [-10, 10] () world frame");
  CHECK(LineOf("surfaces") == "blocks by name (2 entries) what it drives on");
  CHECK(LineOf("surfaces.<name>.friction") == "number at least 0 () Coulomb");
  CHECK(LineOf("trials") == "a count, or a list of trial numbers ([1, 2, 3]) which trials count");
  CHECK(LineOf("space") == "see the documentation ({}) what is varied");
}

TEST_CASE("The end of a key is enough when only one key has it") {
  Robot robot;
  CHECK(ResolveKey("samples", robot) == "gap.samples");
  CHECK(ResolveKey("gap.samples", robot) == "gap.samples");
  CHECK(ResolveKey("ground.friction", robot) == "surfaces.ground.friction");
}

TEST_CASE("A short key that is ambiguous or unknown names what it could be") {
  Robot robot;
  CHECK(ErrorOf([&] { ResolveKey("v_min", robot); }) ==
        "key 'v_min' is short for 3 keys: control.v_min, surfaces.cardboard.control.v_min, "
        "surfaces.ground.control.v_min; write one of them in full");
  CHECK(ErrorOf([&] { ResolveKey("smaples", robot); }) ==
        "key 'smaples' is unknown; did you mean 'gap.samples'?");
  CHECK(ErrorOf([&] { ResolveKey("gap.smaples", robot); }) ==
        "key 'gap.smaples' is unknown; did you mean 'gap.samples'?");
  CHECK(ErrorOf([&] { ResolveKey("", robot); }).find("key '' is unknown; known keys: title, ") ==
        0);
}

TEST_CASE("Any key that is listed can be set to its own value") {
  Robot robot;
  robot.waypoints = {{"a", 1.0, 2.0, true}, {"b", 3.0, 4.0, false}};
  const Robot before = robot;
  WalkKeys(before, "", false, [&](const std::string& key, const FieldInfo&, const auto& member) {
    INFO(key);
    SetValue(robot, key, ValueNode(member, key));
    CHECK(SameButSpace(robot, before));
  });
}

TEST_CASE("One value is set with the checks of binding") {
  Robot robot;
  robot.waypoints.resize(2);
  SetValue(robot, "control.v_min", Parse("0.3", "f"));
  SetValue(robot, "waypoints[1].x_m", Parse("2", "f"));
  SetValue(robot, "speeds_mps[0]", Parse("1.5", "f"));
  SetValue(robot, "surfaces.ground.control.v_max", Parse("0.9", "f"));
  CHECK(robot.control.v_min == 0.3);
  CHECK(robot.waypoints[1].x_m == 2.0);
  CHECK(robot.speeds_mps == std::vector<double>{1.5, 0.2});
  CHECK(robot.surfaces["ground"].control.v_max == 0.9);
  CHECK(SetError("control.v_min", "1.7") ==
        "f:1:1: key 'control.v_min' is 1.7: must be in [0, 1]; meaning: lowest forward power");
  CHECK(SetError("control.v_min", "0.5") == "f:1:1: key 'control': v_min must be at most v_max");
  CHECK(SetError("control.vmin", "0.5") ==
        "f:1:1: key 'control.vmin' is 0.5: no such key; did you mean 'control.v_min'?");
  CHECK(SetError("waypoints[0].x_m", "0.5").find("no such key") != std::string::npos);
}

TEST_CASE("Values set together are checked together") {
  Robot robot;
  const Node low = Parse("0.6", "f");
  const Node high = Parse("0.7", "f");
  CHECK(SetError("control.v_min", "0.6") == "f:1:1: key 'control': v_min must be at most v_max");
  SetValues(robot, {{"control.v_min", low}, {"control.v_max", high}});
  CHECK(robot.control.v_min == 0.6);
  CHECK(robot.control.v_max == 0.7);
  CHECK(ErrorOf([&] {
          SetValues(robot, {{"control.v_max", low}, {"control.v_min", high}});
        }) == "f:1:1: key 'control': v_min must be at most v_max");
  CHECK(robot.control.v_max == 0.7);
}

TEST_CASE("Edits are counted as a person makes them") {
  CHECK(EditDistance("", "abc") == 3);
  CHECK(EditDistance("kitten", "sitting") == 3);
  CHECK(EditDistance("strat", "start") == 1);
  CHECK(EditDistance("V-Min", "v_min") == 0);
}

TEST_CASE("A suggestion is made only when it is near") {
  const std::vector<std::string> keys{"period_s", "samples", "on"};
  CHECK(Nearest("period", keys) == "period_s");
  CHECK(Nearest("samplse", keys) == "samples");
  CHECK(Nearest("zzzzzz", keys).empty());
  CHECK(Nearest(std::string(100'000, 'a'), keys).empty());
  CHECK(Suggestion("samplse", keys, "known") == "; did you mean 'samples'?");
  CHECK(Suggestion("zzzzzz", keys, "known") == "; known: period_s, samples, on");
}

}  // namespace
}  // namespace rift::yaml::test
