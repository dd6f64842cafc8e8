#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rift/yaml/fields.hpp"
#include "rift/yaml/node.hpp"

/// A schema with every kind of member, close to a real experiment.
namespace rift::yaml::test {

enum class Align { kNone, kStart, kSe2 };
constexpr std::array<std::string_view, 3> EnumNames(Align) { return {"none", "start", "se2"}; }

struct Control {
  double v_min = 0.15;
  double v_max = 0.4;
  std::optional<double> cruise_cap;
  bool operator==(const Control&) const = default;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("v_min", self.v_min, 0, 1, "lowest forward power");
    field("v_max", self.v_max, 0, 1, "highest forward power");
    field("cruise_cap", self.cruise_cap, 0.0, 1.0, "cruise power; null for none");
  }
  void Check() const {
    if (v_min > v_max) throw std::invalid_argument("v_min must be at most v_max");
  }
};

struct Gap {
  int samples = 2000;
  double skip_start = 0.0;
  Align align = Align::kNone;
  bool operator==(const Gap&) const = default;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("samples", self.samples, 2, 10'000'000, "evenly spaced values of u");
    field("skip_start", self.skip_start, 0.0, 0.95, "share left out at the start");
    field("align", self.align, "what is removed before comparing");
  }
};

struct Waypoint {
  std::string name;
  double x_m = 0.0;
  double y_m = 0.0;
  bool stop = true;
  bool operator==(const Waypoint&) const = default;

  static constexpr std::array<std::string_view, 2> kRequired{"x_m", "y_m"};
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("name", self.name, "what reports call it");
    field("x_m", self.x_m, -10, 10, "world frame");
    field("y_m", self.y_m, -10, 10, "world frame");
    field("stop", self.stop, "whether the robot stops there");
  }
};

struct Surface {
  double friction = 0.8;
  Control control;  ///< a block inside a map of blocks
  bool operator==(const Surface&) const = default;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("friction", self.friction, 0, std::numeric_limits<double>::infinity(), "Coulomb");
    field("control", self.control, "powers on this surface");
  }
};

/// Read by hand: a count, or a list of numbers.
struct Trials {
  std::vector<int> numbers{1, 2, 3};
  bool operator==(const Trials&) const = default;

  static constexpr std::string_view kTypeText = "a count, or a list of trial numbers";
  static Trials FromNode(const Node& node) {
    Trials trials{{}};
    if (node.IsScalar()) {
      const int count = ReadInt(node, {"trials", Range{1, 99}, ""});
      for (int i = 1; i <= count; ++i) trials.numbers.push_back(i);
      return trials;
    }
    if (node.items.empty()) throw std::invalid_argument("must be a count or a list of numbers");
    for (const Node& item : node.items) {
      trials.numbers.push_back(ReadInt(item, {"trials", Range{1, 99}, ""}));
    }
    return trials;
  }
  Node ToNode() const {
    Node list = Node::List();
    for (const int number : numbers) list.items.push_back(Node::Scalar(std::to_string(number)));
    return list;
  }
};

struct Robot {
  std::string title = "3pi+";
  std::uint64_t seed = 1;
  bool headless = true;
  Control control;
  Gap gap;
  std::vector<double> speeds_mps{0.1, 0.2};
  std::vector<std::string> tags{"first", "second one"};
  std::vector<Waypoint> waypoints;
  std::map<std::string, Surface> surfaces{{"ground", {}}, {"cardboard", {0.5, {}}}};
  Trials trials;
  Node space = Node::Map();

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("title", self.title, "of the report");
    field("seed", self.seed, "of every random number");
    field("headless", self.headless, "without a window");
    field("control", self.control, "the controller");
    field("gap", self.gap, "how the gap is measured");
    field("speeds_mps", self.speeds_mps, 0, 2, "speeds that are tried");
    field("tags", self.tags, "words for the index");
    field("waypoints", self.waypoints, "where the robot goes");
    field("surfaces", self.surfaces, "what it drives on");
    field("trials", self.trials, "which trials count");
    field("space", self.space, "what is varied");
  }
};

inline bool SameButSpace(const Robot& a, const Robot& b) {
  return a.title == b.title && a.seed == b.seed && a.headless == b.headless &&
         a.control == b.control && a.gap == b.gap && a.speeds_mps == b.speeds_mps &&
         a.tags == b.tags && a.waypoints == b.waypoints && a.surfaces == b.surfaces &&
         a.trials == b.trials;
}

/// The message of the Error that `act` throws; anything else escapes and fails the test.
template <class Act>
std::string ErrorOf(Act&& act) {
  try {
    act();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace rift::yaml::test
