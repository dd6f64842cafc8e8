#include "column_names.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

#include "columns.hpp"

namespace rift::trajectory {
namespace {

bool IsOneOf(const std::string& word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

bool HasOneOf(const std::vector<std::string>& words, std::initializer_list<std::string_view> any) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return IsOneOf(word, any); });
}

/// Where the robot is to be, or another one's measurement.
bool IsReference(const std::vector<std::string>& words) {
  return HasOneOf(words, {"target", "desired", "goal", "ref", "setpoint", "waypoint"});
}

std::string QuantityOf(const std::vector<std::string>& words) {
  const std::string& last = words.back();
  if (IsRate(words) || IsReference(words)) return "";
  const std::string axis = last.size() == 2 && last[0] == 'q' ? last.substr(1) : last;
  if (IsRotation(words) && IsOneOf(axis, {"x", "y", "z", "w"})) return "q" + axis;
  if (IsOneOf(last,
              {"yaw", "theta", "heading", "psi", "phi", "angle", "orientation", "th", "rz"})) {
    return "yaw";
  }
  if (IsOneOf(last, {"roll", "pitch"})) return last;
  if (IsOneOf(last, {"t", "time", "timestamp", "stamp", "sec", "secs", "seconds", "elapsed",
                     "clock", "millis", "micros", "nanos"})) {
    return "t";
  }
  if (IsOneOf(last, {"nanosec", "nsec", "nsecs", "nanoseconds"})) return "nanosec";
  if (IsX(last)) return "x";
  if (IsY(last)) return "y";
  if (IsOneOf(last, {"z", "posz", "pz", "tz", "zpos", "height", "up"})) return "z";
  return "";
}

/// No length is without a unit ("q_x []"), nor in radians.
bool FitsUnit(const NamedColumn& column) {
  const std::string& quantity = column.quantity;
  if (IsOneOf(quantity, {"x", "y", "z", "t"}) && column.name.ends_with("[]")) return false;
  if (column.unit.empty() || quantity.empty() || quantity.starts_with('q')) return true;
  return quantity == "nanosec" || UnitFor(quantity, column.unit).has_value();
}

}  // namespace

std::vector<std::string> WordsOf(const std::string& name) {
  std::vector<std::string> words(1);
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool is_hump = std::isupper(c) && i > 0 && std::islower(name[i - 1] & 0xff);
    if ((!std::isalnum(c) || is_hump) && !words.back().empty()) words.emplace_back();
    if (std::isalnum(c)) words.back() += static_cast<char>(std::tolower(c));
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool IsX(const std::string& word) {
  return IsOneOf(word, {"x", "posx", "px", "tx", "xpos", "east", "easting"});
}
bool IsY(const std::string& word) {
  return IsOneOf(word, {"y", "posy", "py", "ty", "ypos", "north", "northing"});
}

bool IsRotation(const std::vector<std::string>& words) {
  return HasOneOf(words, {"orientation", "rotation", "quaternion", "quat", "rot", "q"}) ||
         words.back().starts_with('q');
}

bool IsRate(const std::vector<std::string>& words) {
  return HasOneOf(words, {"vel", "velocity", "speed", "twist", "linear", "angular", "acc", "accel",
                          "cmd", "rate", "v", "covariance", "error"});
}

NamedColumn NamedColumnOf(const std::string& name) {
  NamedColumn column{.name = name};
  std::vector<std::string> words = WordsOf(name);
  if (words.empty()) return column;
  if (words.size() > 1) {
    for (const std::string_view quantity : {"t", "x", "yaw"}) {
      if (words.back() == "m" || words.back() == "s" || UnitFor(quantity, words.back())) {
        column.unit = words.back();
      }
    }
    if (IsOneOf(words.back(), {"degrees", "degree"})) column.unit = "deg";
    if (IsOneOf(words.back(), {"radians", "radian"})) column.unit = "rad";
    const bool is_unit_alone = !column.unit.empty();
    if (is_unit_alone) words.pop_back();
  }
  column.quantity = QuantityOf(words);
  if (!FitsUnit(column)) column.quantity.clear();
  if (column.unit.empty() && IsOneOf(words.back(), {"sec", "secs", "seconds"})) column.unit = "s";
  if (words.back() == "millis") column.unit = "ms";
  if (words.back() == "micros") column.unit = "us";
  if (words.back() == "nanos") column.unit = "ns";
  const bool is_pose = std::any_of(words.begin(), words.end(), [](const std::string& word) {
    return IsOneOf(word, {"pose", "position", "pos", "translation", "orientation", "p", "q"});
  });
  column.rank = static_cast<int>(words.size()) + (is_pose ? -10 : 0);
  if (!column.unit.empty() && column.quantity == "nanosec") column.unit.clear();
  return column;
}

}  // namespace rift::trajectory
