#include "columns.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "plausibility.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/geometry/pose3.hpp"

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

std::string Trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

/// The flag or key for units beside that for columns.
std::string InUnits(std::string flag) {
  constexpr std::string_view kColumns = "columns";
  const size_t at = flag.rfind(kColumns);
  return at == flag.npos ? flag : flag.replace(at, kColumns.size(), "units");
}

}  // namespace

std::vector<std::string> TrimmedParts(std::string_view text, char separator) {
  std::vector<std::string> parts;
  while (true) {
    const size_t end = std::min(text.find(separator), text.size());
    parts.push_back(Trimmed(std::string(text.substr(0, end))));
    if (end == text.size()) return parts;
    text.remove_prefix(end + 1);
  }
}

Sources ParseColumns(const std::string& text) {
  Sources sources;
  for (const std::string& part : TrimmedParts(text, ',')) {
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

std::optional<double> UnitFor(std::string_view quantity, std::string_view unit) {
  if (IsQuaternion(quantity)) return std::nullopt;
  if (quantity == "t") return Find(kTimes, unit);
  return IsAngle(quantity) ? Find(kAngles, unit) : Find(kLengths, unit);
}

Units ParseUnits(const std::string& text) {
  Units units;
  if (text.empty()) return units;
  for (const std::string& name : TrimmedParts(text, ',')) {
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

double StandardUnit(std::string_view quantity, const Units& units) {
  if (IsQuaternion(quantity)) return 1.0;
  if (quantity == "t") return units.time_s.value_or(1.0);
  return IsAngle(quantity) ? units.angle_rad.value_or(1.0) : units.length_m.value_or(1.0);
}

std::string ReadOptions::OwnColumnsFlag() const {
  return own_columns_flag.empty() ? columns_flag : own_columns_flag;
}

std::string ReadOptions::OwnUnitsFlag() const { return InUnits(OwnColumnsFlag()); }

void CheckColumns(const ReadOptions& options) {
  // A flag or a key: `--sim-columns `, `--set candidate.columns=`.
  std::string where = options.columns_flag;
  if (where.starts_with("--set ")) where.erase(0, std::string_view("--set ").size());
  while (where.ends_with('=') || where.ends_with(' ')) where.pop_back();
  try {
    if (!options.columns.empty()) ParseColumns(options.columns);
    where = InUnits(where);
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
  const auto angles_rad = geometry::RollPitchYaw(quaternion.toRotationMatrix());
  pose.roll_rad = angles_rad[0];
  pose.pitch_rad = angles_rad[1];
  pose.yaw_rad = angles_rad[2];
}

}  // namespace rift::trajectory
