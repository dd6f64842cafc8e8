// What the columns of an unknown log may be: offered, or, where units alone are given, used and
// told.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "column_names.hpp"
#include "columns.hpp"
#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::trajectory {
namespace {

/// `nan`, `inf`: what a program writes where it has no number.
bool IsNoNumber(std::string_view cell) {
  if (cell.starts_with('+')) cell.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() && !std::isfinite(value);
}

/// The numbers of a log by columns, NaN where a cell is empty; those of a column that holds other
/// things, or nothing, are left out.
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
      std::optional<double> value = table.Number(i);
      if (IsNoNumber(table.Cell(i))) value = StampedPose::kNotLogged;
      if (value) numbers.columns[i].push_back(*value);
      is_number[i] = is_number[i] && value;
    }
  }
  const auto is_finite = [](double value) { return std::isfinite(value); };
  for (size_t i = 0; i < is_number.size(); ++i) {
    std::vector<double>& column = numbers.columns[i];
    if (!is_number[i] || std::none_of(column.begin(), column.end(), is_finite)) column.clear();
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

bool Varies(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
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

/// Columns that are named alike, the first of them the one to take.
using Alike = std::vector<std::string>;

/// "; x may be x_ref or x_meas": to be appended to a message.
std::string Unclear(const std::map<std::string, Alike>& may_be) {
  constexpr size_t kMost = 6;
  std::string text;
  for (const char* quantity : {"x", "y"}) {
    const auto found = may_be.find(quantity);
    if (found == may_be.end() || found->second.empty()) continue;
    Alike names = found->second;
    if (names.size() > kMost) names.resize(kMost);
    for (std::string& name : names) name = csv::Shown(name);
    text += fmt::format("{} {} may be {}", text.empty() ? ";" : ",", quantity,
                        fmt::join(names, " or "));
  }
  return text;
}

/// Columns of numbers in whose name x or y stands anywhere, where no name tells the position.
std::string PositionsNamed(const Numbers& numbers) {
  std::map<std::string, Alike> may_be;
  for (size_t i = 0; i < numbers.names.size(); ++i) {
    const std::vector<std::string> words = WordsOf(numbers.names[i]);
    if (words.empty() || numbers.columns[i].empty() || IsRate(words) || IsRotation(words)) continue;
    if (std::any_of(words.begin(), words.end(), IsX)) may_be["x"].push_back(numbers.names[i]);
    if (std::any_of(words.begin(), words.end(), IsY)) may_be["y"].push_back(numbers.names[i]);
  }
  return Unclear(may_be);
}

/// What of a pose the names tell, and which columns may be the position as well as each other.
struct ToldByNames {
  Guess guess;
  std::string unclear;
};

ToldByNames ByNames(const Numbers& numbers, std::map<std::string, std::string>& units) {
  std::map<std::string, NamedColumn> best;
  std::map<std::string, Alike> alike;
  for (size_t i = 0; i < numbers.names.size(); ++i) {
    const NamedColumn column = NamedColumnOf(numbers.names[i]);
    if (column.quantity.empty() || numbers.columns[i].empty()) continue;
    if (column.quantity == "t" && !Rises(numbers.columns[i])) continue;
    const auto [found, is_new] = best.try_emplace(column.quantity, column);
    Alike& names = alike[column.quantity];
    if (column.rank < found->second.rank) {
      found->second = column;
      names.clear();
    }
    if (column.rank == found->second.rank) names.push_back(column.name);
  }
  if (best.contains("qz") && best.contains("qw"))
    best.erase("yaw");
  else
    for (const char* part : {"qx", "qy", "qz", "qw"}) best.erase(part);
  ToldByNames told;
  for (const auto& [quantity, column] : best) {
    told.guess[quantity] = column.name;
    units[quantity] = column.unit;
  }
  // Of several times, heights or angles the first is taken.
  std::erase_if(alike, [](const auto& entry) { return entry.second.size() < 2; });
  told.unclear = Unclear(alike);
  return told;
}

/// What has no name but its place in the row.
bool IsNameless(const std::string& name) {
  return name.find_first_not_of("0123456789") == name.npos;
}

/// Of columns without names, by ranges alone: time is the first one that rises, x and y the next
/// two that vary. A name that says something else is believed.
void ByRanges(const Numbers& numbers, Guess& guess) {
  const auto may_be = [&](size_t i) {
    const bool is_taken = std::any_of(guess.begin(), guess.end(), [&](const auto& entry) {
      return entry.second == numbers.names[i];
    });
    return !is_taken && IsNameless(numbers.names[i]) && !numbers.columns[i].empty();
  };
  for (size_t i = 0; i < numbers.names.size() && !guess.contains("t"); ++i) {
    if (may_be(i) && Rises(numbers.columns[i])) guess["t"] = numbers.names[i];
  }
  if (guess.contains("x") != guess.contains("y")) return;
  for (size_t i = 0; i < numbers.names.size() && !guess.contains("y"); ++i) {
    if (!may_be(i) || !Varies(numbers.columns[i])) continue;
    guess[guess.contains("x") ? "y" : "x"] = numbers.names[i];
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
    if (is_taken || !IsNameless(name)) continue;
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

std::string Written(const Guess& guess, const std::map<std::string, std::string>& unit_of,
                    const Units& units, const std::vector<std::string>& header) {
  const bool is_nameless = std::all_of(guess.begin(), guess.end(),
                                       [](const auto& entry) { return IsNameless(entry.second); });
  // A comma ends a source: a name with one is given by its number, as one that is empty. So are
  // columns that all have numbers for names, which may be the first row of a log without a header.
  const auto source = [&](const std::string& name) {
    const bool is_name = !is_nameless && !name.empty() && name.find(',') == name.npos;
    if (is_name) return name;
    return fmt::format("{}", std::find(header.begin(), header.end(), name) - header.begin() + 1);
  };
  std::string text;
  for (const std::string_view quantity : kQuantities) {
    const auto found = guess.find(std::string(quantity));
    if (found == guess.end()) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", quantity, source(found->second));
    const auto unit = unit_of.find(found->first);
    const bool has_unit = unit != unit_of.end() && !unit->second.empty();
    if (has_unit && UnitFor(quantity, unit->second) != StandardUnit(quantity, units)) {
      text += ":" + unit->second;
    }
    if (quantity == "t" && guess.contains("nanosec")) {
      text += fmt::format("+{}:ns", source(guess.at("nanosec")));
    }
  }
  return text;
}

}  // namespace

ColumnGuess GuessColumns(std::string_view text, const std::string& name, const std::string& units) {
  const Numbers numbers = ReadNumbers(text, name);
  std::map<std::string, std::string> unit_of;
  auto [guess, unclear] = ByNames(numbers, unit_of);
  if (!unclear.empty()) return {"", unclear};
  ByRanges(numbers, guess);
  for (const char* needed : {"t", "x", "y"}) {
    if (!guess.contains(needed)) return {"", *needed == 't' ? "" : PositionsNamed(numbers)};
  }
  const Units given = ParseUnits(units);
  const Trajectory path = PathOf(numbers, guess);
  if (!guess.contains("yaw") && !guess.contains("qz")) YawByTravel(numbers, path, guess, unit_of);
  const std::vector<double>& t = *numbers.Of(guess["t"]);
  if (unit_of["t"].empty() && guess.contains("nanosec")) unit_of["t"] = "s";
  if (unit_of["t"].empty() && !given.time_s) unit_of["t"] = TimeUnit(t);
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
  return {Written(guess, unit_of, given, numbers.names), ""};
}

}  // namespace rift::trajectory
