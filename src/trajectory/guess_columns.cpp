// What the columns of an unknown log may be. A guess is only ever offered, never used unasked.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "columns.hpp"
#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::trajectory {
namespace {

/// "pose.pose.position.x" and "posePositionX [mm]" in lower-case words.
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

bool IsOneOf(const std::string& word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// A column by its name.
struct NamedColumn {
  std::string name;
  std::string quantity;  ///< empty: none
  std::string unit;      ///< where its name ends in one
  int rank = 0;          ///< of several that may be one quantity the lowest is taken
};

std::string QuantityOf(const std::vector<std::string>& words) {
  const auto has = [&](std::initializer_list<std::string_view> any) {
    return std::any_of(words.begin(), words.end(),
                       [&](const std::string& word) { return IsOneOf(word, any); });
  };
  const std::string& last = words.back();
  if (has({"vel", "velocity", "speed", "twist", "linear", "angular", "acc", "accel", "cmd", "rate",
           "v", "covariance", "target", "desired", "goal", "ref", "setpoint", "error",
           "waypoint"})) {
    return "";
  }
  const bool is_rotation =
      has({"orientation", "rotation", "quaternion", "quat", "rot", "q"}) || last.starts_with('q');
  const std::string axis = last.size() == 2 && last[0] == 'q' ? last.substr(1) : last;
  if (is_rotation && IsOneOf(axis, {"x", "y", "z", "w"})) return "q" + axis;
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
  if (IsOneOf(last, {"x", "posx", "px", "tx", "xpos", "east", "easting"})) return "x";
  if (IsOneOf(last, {"y", "posy", "py", "ty", "ypos", "north", "northing"})) return "y";
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

NamedColumn Named(const std::string& name) {
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

/// The numbers of a log by columns; those of a column that holds other things are left out.
struct Numbers {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  const std::vector<double>* Of(const std::string& name) const {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? nullptr : &columns[found - names.begin()];
  }
};

Numbers ReadNumbers(std::string_view text, const std::string& name) {
  constexpr size_t kMostRows = 2000;
  TextTable table(text, name);
  Numbers numbers{table.Columns(), std::vector<std::vector<double>>(table.Columns().size())};
  std::vector<bool> is_number(numbers.names.size(), true);
  for (size_t row = 0; row < kMostRows && table.Next(); ++row) {
    for (size_t i = 0; i < is_number.size(); ++i) {
      const std::optional<double> value = table.Number(i);
      if (value) numbers.columns[i].push_back(*value);
      is_number[i] = is_number[i] && value;
    }
  }
  for (size_t i = 0; i < is_number.size(); ++i) {
    if (!is_number[i]) numbers.columns[i].clear();
  }
  return numbers;
}

std::vector<double> StepsOf(const std::vector<double>& values) {
  std::vector<double> steps;
  for (size_t i = 1; i < values.size(); ++i) {
    if (std::isfinite(values[i] - values[i - 1])) steps.push_back(values[i] - values[i - 1]);
  }
  return steps;
}

bool Rises(const std::vector<double>& values) {
  const std::vector<double> steps = StepsOf(values);
  return !steps.empty() &&
         std::all_of(steps.begin(), steps.end(), [](double step) { return step >= 0.0; }) &&
         values.back() > values.front();
}

bool Varies(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(),
                     [&](double value) { return value != values.front(); });
}

/// A log is written 2 to 1000 times a second.
std::string TimeUnit(const std::vector<double>& times) {
  std::vector<double> steps = StepsOf(times);
  std::erase(steps, 0.0);
  if (steps.empty()) return "";
  const double step = statistics::Median(steps);
  if (step > 5e5) return "ns";
  if (step > 900.0) return "us";
  return step > 1.5 ? "ms" : "";
}

/// The unit of a length, by the speed that follows: a robot drives at less than 10 m/s.
std::string LengthUnit(const std::vector<double>& x, const std::vector<double>& y,
                       const std::vector<double>& t, double time_unit_s) {
  std::vector<double> speeds;
  for (size_t i = 1; i < std::min({x.size(), y.size(), t.size()}); ++i) {
    const double step = std::hypot(x[i] - x[i - 1], y[i] - y[i - 1]);
    const double time_s = (t[i] - t[i - 1]) * time_unit_s;
    if (step > 0.0 && time_s > 0.0) speeds.push_back(step / time_s);
  }
  if (speeds.empty() || statistics::Median(speeds) < kFastest_m_s) return "";
  return "mm";
}

using Guess = std::map<std::string, std::string>;

Guess ByNames(const Numbers& numbers, std::map<std::string, std::string>& units) {
  std::map<std::string, NamedColumn> best;
  for (size_t i = 0; i < numbers.names.size(); ++i) {
    const NamedColumn column = Named(numbers.names[i]);
    if (column.quantity.empty() || numbers.columns[i].empty()) continue;
    if (column.quantity == "t" && !Rises(numbers.columns[i])) continue;
    const auto [found, is_new] = best.try_emplace(column.quantity, column);
    if (!is_new && column.rank < found->second.rank) found->second = column;
  }
  if (best.contains("qz") && best.contains("qw"))
    best.erase("yaw");
  else
    for (const char* part : {"qx", "qy", "qz", "qw"}) best.erase(part);
  Guess guess;
  for (const auto& [quantity, column] : best) {
    guess[quantity] = column.name;
    units[quantity] = column.unit;
  }
  return guess;
}

/// By ranges alone: time is the first column that rises, x and y the next two that vary.
void ByRanges(const Numbers& numbers, Guess& guess) {
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(guess.begin(), guess.end(),
                       [&](const auto& entry) { return entry.second == name; });
  };
  for (size_t i = 0; i < numbers.names.size() && !guess.contains("t"); ++i) {
    const bool may_be = !numbers.columns[i].empty() && Rises(numbers.columns[i]);
    if (may_be && !is_taken(numbers.names[i])) guess["t"] = numbers.names[i];
  }
  if (guess.contains("x") != guess.contains("y")) return;
  for (size_t i = 0; i < numbers.names.size() && !guess.contains("y"); ++i) {
    if (numbers.columns[i].empty() || !Varies(numbers.columns[i])) continue;
    if (!is_taken(numbers.names[i])) guess[guess.contains("x") ? "y" : "x"] = numbers.names[i];
  }
}

Trajectory PathOf(const Numbers& numbers, const Guess& guess) {
  const std::vector<double>*t = numbers.Of(guess.at("t")), *x = numbers.Of(guess.at("x")),
        *y = numbers.Of(guess.at("y"));
  Trajectory path;
  for (size_t i = 0; i < std::min({t->size(), x->size(), y->size()}); ++i) {
    path.poses.push_back({.t_s = (*t)[i], .x_m = (*x)[i], .y_m = (*y)[i]});
  }
  return path;
}

/// The agreement of a column with the direction of travel, read in radians or in degrees.
double AgreementOf(const std::vector<double>& column, Trajectory path, double unit_rad) {
  for (size_t i = 0; i < std::min(path.poses.size(), column.size()); ++i) {
    path.poses[i].yaw_rad = column[i] * unit_rad;
  }
  return TravelAgreement(path);
}

/// Degrees where they agree better with the path, or no other unit is possible.
std::string AngleUnit(const std::vector<double>& yaw, const Trajectory& path) {
  constexpr double kDegree = geometry::kPi / 180.0;
  double largest = 0.0;
  for (const double value : yaw) largest = std::max(largest, std::abs(value));
  if (largest > 2.5 * geometry::kPi) return "deg";
  return AgreementOf(yaw, path, kDegree) > AgreementOf(yaw, path, 1.0) + 0.2 ? "deg" : "";
}

void YawByTravel(const Numbers& numbers, const Trajectory& path, Guess& guess,
                 std::map<std::string, std::string>& units) {
  constexpr double kAgrees = 0.85;
  double best = kAgrees;
  for (size_t i = 0; i < numbers.names.size(); ++i) {
    const std::string& name = numbers.names[i];
    const bool is_taken = std::any_of(guess.begin(), guess.end(),
                                      [&](const auto& entry) { return entry.second == name; });
    const bool is_number = name.find_first_not_of("0123456789") == name.npos;
    if (is_taken || !is_number) continue;  // a name that says something else is believed
    if (numbers.columns[i].empty() || !Varies(numbers.columns[i])) continue;
    for (const std::string unit : {"", "deg"}) {
      const double agreement = AgreementOf(numbers.columns[i], path, unit.empty() ? 1.0 : 0.017453);
      if (agreement <= best) continue;
      best = agreement;
      guess["yaw"] = name;
      units["yaw"] = unit;
    }
  }
}

std::string Written(const Guess& guess, const std::map<std::string, std::string>& units,
                    const std::vector<std::string>& header) {
  // A comma ends a source: a name with one is given by its number, as one that is empty.
  const auto source = [&](const std::string& name) {
    if (!name.empty() && name.find(',') == name.npos) return name;
    return fmt::format("{}", std::find(header.begin(), header.end(), name) - header.begin() + 1);
  };
  std::string text;
  for (const std::string_view quantity : kQuantities) {
    const auto found = guess.find(std::string(quantity));
    if (found == guess.end()) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", quantity, source(found->second));
    const auto unit = units.find(found->first);
    const bool is_standard =
        unit == units.end() || unit->second.empty() || IsOneOf(unit->second, {"m", "s", "rad"});
    if (!is_standard) text += ":" + unit->second;
    if (quantity == "t" && guess.contains("nanosec")) {
      text += fmt::format("+{}:ns", source(guess.at("nanosec")));
    }
  }
  return text;
}

}  // namespace

std::string GuessColumns(std::string_view text, const std::string& name, const std::string& units) {
  const Numbers numbers = ReadNumbers(text, name);
  std::map<std::string, std::string> unit_of;
  Guess guess = ByNames(numbers, unit_of);
  ByRanges(numbers, guess);
  for (const char* needed : {"t", "x", "y"}) {
    if (!guess.contains(needed)) return "";
  }
  const Units given = ParseUnits(units);
  const Trajectory path = PathOf(numbers, guess);
  if (!guess.contains("yaw") && !guess.contains("qz")) YawByTravel(numbers, path, guess, unit_of);
  const std::vector<double>& t = *numbers.Of(guess["t"]);
  if (unit_of["t"].empty() && !given.time_s && !guess.contains("nanosec"))
    unit_of["t"] = TimeUnit(t);
  const double time_unit_s =
      unit_of["t"].empty() ? given.time_s.value_or(1.0) : UnitFor("t", unit_of["t"]).value_or(1.0);
  for (const char* length : {"x", "y", "z"}) {
    if (!unit_of[length].empty() || given.length_m) continue;
    unit_of[length] = LengthUnit(*numbers.Of(guess["x"]), *numbers.Of(guess["y"]), t, time_unit_s);
  }
  if (guess.contains("yaw") && unit_of["yaw"].empty() && !given.angle_rad) {
    unit_of["yaw"] = AngleUnit(*numbers.Of(guess["yaw"]), path);
    for (const char* angle : {"roll", "pitch"}) {
      if (unit_of[angle].empty()) unit_of[angle] = unit_of["yaw"];
    }
  }
  return Written(guess, unit_of, numbers.names);
}

}  // namespace rift::trajectory
