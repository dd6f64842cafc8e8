#include "rift/experiment/settable.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace rift::experiment {
namespace {

struct SettableKey {
  std::string_view key;
  double step;
};

/// What the host's controller takes at each drive, and the floor that is laid. Waypoints are marked
/// on the floor by hand, to half a centimetre.
constexpr std::array<SettableKey, 26> kSettable{{
    {"control.distance.p", 0.05},
    {"control.distance.i", 0.01},
    {"control.distance.d", 0.005},
    {"control.heading.p", 0.005},
    {"control.heading.i", 0.001},
    {"control.heading.d", 0.0005},
    {"control.derivative_kick", 0.0},
    {"control.reach_radius_m", 0.005},
    {"control.v_min", 0.01},
    {"control.v_max", 0.01},
    {"control.w_min", 0.005},
    {"control.w_max", 0.05},
    {"control.cruise_speed", 0.01},
    {"control.cruise_cap_angle_deg", 1.0},
    {"control.through_angle_deg", 1.0},
    {"control.slew_rate_per_s", 0.1},
    {"control.latency.delay_s", 0.01},
    {"trial.control_period_s", 0.005},
    {"trial.pace", 0.0},
    {"simulation.terrain.surface", 0.0},
    {"program.power", 0.01},
    {"program.speed_mps", 0.01},
    {"program.segments[].power", 0.01},
    {"waypoints[].x", 0.005},
    {"waypoints[].y", 0.005},
    {"waypoints[].heading", 1.0},
}};

/// "waypoints[2].x" -> "waypoints[].x"
std::string PatternOf(std::string_view key) {
  std::string pattern;
  bool is_inside = false;
  for (const char c : key) {
    if (c == ']') is_inside = false;
    if (!is_inside) pattern += c;
    if (c == '[') is_inside = true;
  }
  return pattern;
}

/// A name that several keys end in ("p" of two loops), or an entry of a list ("x" of a waypoint),
/// is as likely one of somebody else's: it names no key.
const SettableKey* FindByLastName(std::string_view name) {
  const std::string end = "." + std::string(name);
  const SettableKey* found = nullptr;
  for (const SettableKey& known : kSettable) {
    if (!known.key.ends_with(end)) continue;
    if (found != nullptr || known.key.find('[') != known.key.npos) return nullptr;
    found = &known;
  }
  return found;
}

double NiceStep(double least) {
  constexpr double kRounded = 1.0 - 1e-9;  // (5.4 - 5) / 20 is a little more than 0.02
  const double power = std::pow(10.0, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= kRounded * least) return factor * power;
  }
  return 10.0 * power;
}

/// The step that the space or the schema gives a parameter.
std::optional<double> OwnStep(const Parameter& parameter) {
  if (parameter.step) return parameter.step;
  const std::optional<Settable> known = FindSettable(parameter.key);
  return known && known->step > 0.0 ? std::optional(known->step) : std::nullopt;
}

/// No one step suits both ends of a range over decades that is even in its logarithm.
bool IsOverDecades(const Parameter& parameter) {
  constexpr double kSlack = 1e-9;
  return parameter.is_logarithmic && parameter.max >= (10.0 - kSlack) * parameter.min;
}

/// The nearest of 1, 2 and 5 times a power of ten within the range, by the logarithm.
double NearestOfDecade(const Parameter& parameter, double value) {
  value = std::clamp(value, parameter.min, parameter.max);
  const double decade = std::floor(std::log10(value));
  double nearest = value, least = std::numeric_limits<double>::infinity();
  for (const double power : {decade - 1.0, decade, decade + 1.0}) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      // Divided below one, so that 5e-4 is the number nearest to it.
      const double tens = std::pow(10.0, std::abs(power));
      const double round = power < 0.0 ? factor / tens : factor * tens;
      const double distance = std::abs(std::log(round / value));
      if (round < parameter.min || round > parameter.max || distance >= least) continue;
      nearest = round;
      least = distance;
    }
  }
  return nearest;
}

}  // namespace

std::optional<Settable> FindSettable(std::string_view key) {
  if (key.find('.') == key.npos) {
    const SettableKey* const known = FindByLastName(key);
    return known != nullptr ? std::optional(Settable{known->step}) : std::nullopt;
  }
  const std::string pattern = PatternOf(key);
  const auto found = std::find_if(kSettable.begin(), kSettable.end(),
                                  [&](const SettableKey& known) { return known.key == pattern; });
  if (found == kSettable.end()) return std::nullopt;
  return Settable{found->step};
}

bool IsSettable(const Parameter& parameter) {
  return parameter.settable.value_or(FindSettable(parameter.key).has_value());
}

double StepOf(const Parameter& parameter) {
  const double step = OwnStep(parameter).value_or(NiceStep((parameter.max - parameter.min) / 20.0));
  return parameter.is_integer ? std::max(1.0, std::round(step)) : step;
}

ParameterValue NearestSettable(const Parameter& parameter, const ParameterValue& value) {
  if (!parameter.IsContinuous() || !value.number) return value;
  if (IsOverDecades(parameter) && !OwnStep(parameter)) {
    return NumberValue(NearestOfDecade(parameter, *value.number));
  }
  constexpr double kSlack = 1e-9;  // of a step: 0.3 / 0.1 is a little less than 3
  const double step = StepOf(parameter);
  const double most = std::floor(parameter.max / step + kSlack);
  const double least = std::ceil(parameter.min / step - kSlack);
  const double steps = std::max(least, std::min(most, std::round(*value.number / step)));
  // Divided where the step is one over a whole number, so that 3 steps of 0.1 are 0.3.
  const double inverse = std::round(1.0 / step);
  const bool is_inverse = step < 1.0 && std::abs(inverse * step - 1.0) < 1e-9;
  const double nearest = is_inverse ? steps / inverse : steps * step;
  return NumberValue(std::clamp(nearest, parameter.min, parameter.max));
}

}  // namespace rift::experiment
