#include "columns.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/trajectory/csv.hpp"

namespace rift::trajectory {
namespace {

struct Unit {
  std::string_view name;
  double in_si;
};
constexpr std::array<Unit, 6> kLengths{
    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"km", 1000.0}, {"in", 0.0254}, {"ft", 0.3048}}};
constexpr std::array<Unit, 5> kTimes{
    {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"ns", 1e-9}, {"min", 60.0}}};
constexpr std::array<Unit, 2> kAngles{{{"rad", 1.0}, {"deg", geometry::kPi / 180.0}}};

template <size_t N>
std::optional<double> Find(const std::array<Unit, N>& units, std::string_view name) {
  for (const Unit& unit : units) {
    if (unit.name == name) return unit.in_si;
  }
  return std::nullopt;
}

bool IsAngle(std::string_view quantity) {
  return quantity == "roll" || quantity == "pitch" || quantity == "yaw";
}
bool IsQuaternion(std::string_view quantity) { return quantity.starts_with('q'); }

std::vector<std::string> SplitAt(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const size_t end = std::min(text.find(separator), text.size());
    parts.emplace_back(text.substr(0, end));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// "t" -> "time", "yaw" -> "theta:deg".
using Sources = std::vector<std::pair<std::string, std::string>>;

Sources ParseColumns(const std::string& text) {
  Sources sources;
  for (const std::string& part : SplitAt(text, ',')) {
    const size_t equals = part.find('=');
    const std::string quantity = Trimmed(part.substr(0, equals));
    if (equals == part.npos || Trimmed(part.substr(equals + 1)).empty()) {
      throw std::invalid_argument(
          fmt::format("columns: '{}' is no QUANTITY=COLUMN, such as yaw=theta:deg", part));
    }
    if (std::find(kQuantities.begin(), kQuantities.end(), quantity) == kQuantities.end()) {
      throw std::invalid_argument(fmt::format("columns: '{}' is no quantity of a pose: they are {}",
                                              quantity, fmt::join(kQuantities, ", ")));
    }
    for (const auto& [other, column] : sources) {
      if (other != quantity) continue;
      throw std::invalid_argument(fmt::format("columns: {} is named twice", quantity));
    }
    sources.emplace_back(quantity, Trimmed(part.substr(equals + 1)));
  }
  const auto has = [&](std::string_view quantity) {
    return std::any_of(sources.begin(), sources.end(),
                       [&](const auto& source) { return source.first == quantity; });
  };
  for (const char* needed : {"t", "x", "y"}) {
    if (has(needed)) continue;
    throw std::invalid_argument(fmt::format("columns: {} is missing in '{}'", needed, text));
  }
  const bool quaternion = has("qx") || has("qy") || has("qz") || has("qw");
  if (quaternion && !(has("qz") && has("qw"))) {
    throw std::invalid_argument("columns: a quaternion needs qz and qw, and tilted ones qx and qy");
  }
  if (quaternion && has("yaw")) {
    throw std::invalid_argument("columns: yaw and a quaternion: leave one of them out");
  }
  for (const auto& [quantity, column] : sources) {
    for (const auto& [other, same] : sources) {
      if (quantity >= other || column != same) continue;
      throw std::invalid_argument(
          fmt::format("columns: {} and {} are both column '{}'", quantity, other, column));
    }
  }
  return sources;
}

/// A sum of columns, each times a factor.
struct Term {
  size_t column;
  double factor;
};
struct Quantity {
  std::string name;
  std::vector<Term> terms;
};

double StandardUnit(std::string_view quantity, const Units& units) {
  if (IsQuaternion(quantity)) return 1.0;
  if (quantity == "t") return units.time_s.value_or(1.0);
  return IsAngle(quantity) ? units.angle_rad.value_or(1.0) : units.length_m.value_or(1.0);
}

/// Finds the columns of a source in a header.
class SourceResolver {
 public:
  SourceResolver(const std::vector<std::string>& header, const Units& units, std::string where)
      : header_(header), units_(units), where_(std::move(where)) {}

  Quantity Resolve(const std::string& quantity, const std::string& source) const {
    Quantity resolved{quantity, {}};
    if (const std::optional<Term> whole = TermOf(quantity, source)) {
      resolved.terms.push_back(*whole);
      return resolved;
    }
    const bool is_negative = source.starts_with('-');
    for (const std::string& part : SplitAt(std::string_view(source).substr(is_negative), '+')) {
      std::optional<Term> term = TermOf(quantity, part);
      if (!term) Refuse(quantity, part);
      if (is_negative) term->factor = -term->factor;
      resolved.terms.push_back(*term);
    }
    return resolved;
  }

 private:
  std::optional<size_t> ColumnOf(const std::string& name) const {
    const auto found = std::find(header_.begin(), header_.end(), name);
    if (found != header_.end()) return found - header_.begin();
    size_t number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool is_number = error == std::errc{} && end == name.data() + name.size();
    if (!is_number || number < 1 || number > header_.size()) return std::nullopt;
    return number - 1;
  }

  std::optional<Term> TermOf(const std::string& quantity, const std::string& text) const {
    if (const auto column = ColumnOf(text)) return Term{*column, StandardUnit(quantity, units_)};
    const size_t colon = text.rfind(':');
    if (colon == text.npos) return std::nullopt;
    const auto column = ColumnOf(text.substr(0, colon));
    if (!column) return std::nullopt;
    const std::string unit = text.substr(colon + 1);
    const std::optional<double> factor = UnitFor(quantity, unit);
    if (!factor) {
      throw std::invalid_argument(
          fmt::format("{}: columns: '{}' is no unit of {}", where_, unit, quantity));
    }
    return Term{*column, *factor};
  }

  [[noreturn]] void Refuse(const std::string& quantity, const std::string& part) const {
    throw std::invalid_argument(fmt::format(
        "{}: columns: {} is to be '{}', and there is no such column: there are {}", where_,
        quantity, part, csv::Shown(fmt::format("{}", fmt::join(header_, ", ")), 400)));
  }

  const std::vector<std::string>& header_;
  const Units& units_;
  const std::string where_;
};

class PoseReader {
 public:
  PoseReader(const TextTable& table, const Sources& sources, const Units& units,
             const std::string& name)
      : name_(name) {
    const SourceResolver resolver(table.Columns(), units, fmt::format("{}:{}", name, table.Line()));
    for (const auto& [quantity, source] : sources) {
      quantities_.push_back(resolver.Resolve(quantity, source));
    }
  }

  /// Nothing for a row that has no position at all: another topic's.
  std::optional<StampedPose> PoseOf(const TextTable& table) const {
    std::map<std::string_view, double> values;
    for (const Quantity& quantity : quantities_) values[quantity.name] = Sum(quantity, table);
    if (std::isnan(values["x"]) && std::isnan(values["y"])) return std::nullopt;
    for (const Quantity& quantity : quantities_) {
      const bool is_needed = quantity.name == "t" || quantity.name == "x" || quantity.name == "y";
      if (!is_needed || !std::isnan(values[quantity.name])) continue;
      throw std::invalid_argument(fmt::format("{}:{}: column {} is empty", name_, table.Line(),
                                              table.Columns()[quantity.terms.front().column]));
    }
    return FromValues(values, fmt::format("{}:{}", name_, table.Line()));
  }

 private:
  double Sum(const Quantity& quantity, const TextTable& table) const {
    double sum = 0.0;
    for (const Term& term : quantity.terms) {
      const std::optional<double> number = table.Number(term.column);
      if (!number) {
        throw std::invalid_argument(fmt::format(
            "{}:{}: column {} is '{}': a finite number is expected", name_, table.Line(),
            csv::Shown(table.Columns()[term.column]), csv::Shown(table.Cell(term.column))));
      }
      sum += *number * term.factor;
    }
    return sum;
  }

  static StampedPose FromValues(const std::map<std::string_view, double>& values,
                                const std::string& where) {
    const auto value = [&](std::string_view name, double otherwise = StampedPose::kNotLogged) {
      const auto found = values.find(name);
      return found == values.end() ? otherwise : found->second;
    };
    StampedPose pose{.t_s = value("t"),
                     .x_m = value("x"),
                     .y_m = value("y"),
                     .z_m = value("z"),
                     .roll_rad = value("roll"),
                     .pitch_rad = value("pitch"),
                     .yaw_rad = value("yaw"),
                     .target_x_m = value("target_x"),
                     .target_y_m = value("target_y")};
    const double qz = value("qz"), qw = value("qw");
    if (!std::isnan(qz) && !std::isnan(qw)) {
      SetAngles(pose, value("qx", 0.0), value("qy", 0.0), qz, qw, where);
    }
    return pose;
  }

  const std::string& name_;
  std::vector<Quantity> quantities_;
};

}  // namespace

std::optional<double> UnitFor(std::string_view quantity, std::string_view unit) {
  if (IsQuaternion(quantity)) return std::nullopt;
  if (quantity == "t") return Find(kTimes, unit);
  return IsAngle(quantity) ? Find(kAngles, unit) : Find(kLengths, unit);
}

Units ParseUnits(const std::string& text) {
  Units units;
  if (text.empty()) return units;
  for (const std::string& part : SplitAt(text, ',')) {
    const std::string name = Trimmed(part);
    const auto set = [&](std::optional<double>& kind, std::optional<double> value) {
      if (!value) return false;
      if (kind) throw std::invalid_argument(fmt::format("units: '{}' names one kind twice", text));
      kind = value;
      return true;
    };
    if (set(units.length_m, Find(kLengths, name)) || set(units.time_s, Find(kTimes, name)) ||
        set(units.angle_rad, Find(kAngles, name))) {
      continue;
    }
    throw std::invalid_argument(fmt::format(
        "units: '{}' is none of m, cm, mm, km, in, ft, s, ms, us, ns, min, rad, deg", name));
  }
  return units;
}

void CheckColumns(const ReadOptions& options) {
  // A flag or a key: `--sim-columns `, `--set candidate.columns=`.
  std::string where = options.columns_flag;
  if (where.starts_with("--set ")) where.erase(0, std::string_view("--set ").size());
  while (where.ends_with('=') || where.ends_with(' ')) where.pop_back();
  try {
    if (!options.columns.empty()) ParseColumns(options.columns);
    const size_t at = where.rfind("columns");
    if (at != where.npos) where.replace(at, where.npos, "units");
    ParseUnits(options.units);
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    throw std::invalid_argument(where +
                                message.substr(std::min(message.find(':'), message.size())));
  }
  const bool has_own = !options.columns.empty() || !options.units.empty();
  if (!has_own || options.format == Format::kAuto) return;
  throw std::invalid_argument(
      "columns and units are of a log in no dialect, and a format is one: leave out either");
}

void SetAngles(StampedPose& pose, double qx, double qy, double qz, double qw,
               const std::string& where) {
  Eigen::Quaterniond quaternion(qw, qx, qy, qz);
  // Neither the squares of large numbers nor those of small ones may be lost.
  quaternion.coeffs().stableNormalize();
  if (!(quaternion.norm() > 0.0)) {
    throw std::invalid_argument(fmt::format("{}: the quaternion has zero length", where));
  }
  const Eigen::Matrix3d r = quaternion.toRotationMatrix();
  pose.roll_rad = std::atan2(r(2, 1), r(2, 2));
  pose.pitch_rad = std::asin(std::clamp(-r(2, 0), -1.0, 1.0));
  pose.yaw_rad = std::atan2(r(1, 0), r(0, 0));
}

LogRows ReadColumns(std::string_view text, const std::string& name, const ReadOptions& options) {
  const Units units = ParseUnits(options.units);
  std::string columns = options.columns;
  if (columns.empty()) columns = GuessColumns(text, name, options.units);
  TextTable table(text, name);
  if (columns.empty()) {
    throw std::invalid_argument(fmt::format(
        "{}: units are given, and no columns are found for time, x and y: name them with {}t=..."
        ",x=...,y=...",
        name, options.columns_flag));
  }
  const PoseReader reader(table, ParseColumns(columns), units, name);
  LogRows rows;
  while (table.Next()) {
    const std::optional<StampedPose> pose = reader.PoseOf(table);
    if (pose)
      AddPose(rows, *pose, name, table.Line());
    else
      ++rows.without_position;
  }
  return rows;
}

}  // namespace rift::trajectory
