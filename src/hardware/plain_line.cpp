#include <fmt/args.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rift/hardware/options.hpp"
#include "rift/hardware/wire.hpp"

namespace rift::hardware {
namespace {

constexpr size_t kLongestPlainLine = 64;

/// As it stands in YAML.
std::string Quoted(const std::string& text) {
  std::string quoted;
  for (const char c : text) {
    quoted += c == '\n' ? "\\n" : c == '\r' ? "\\r" : c == '\t' ? "\\t" : std::string(1, c);
  }
  return '"' + quoted + '"';
}

/// How a format writes one of its two numbers: each of its places, as fmt takes it ("{:.2f}").
class Number {
 public:
  /// None of a format that fmt will refuse. Throws std::invalid_argument for a place that writes no
  /// decimal number, since nobody could tell what it asks of the motors.
  Number(const std::string& format, std::string_view name) {
    for (size_t at = 0; at < format.size(); ++at) {
      if (format[at] != '{') continue;
      if (format.compare(at, 2, "{{") == 0) {
        ++at;
        continue;
      }
      const size_t end = format.find('}', at);
      if (end == format.npos) return;
      const std::string_view place = std::string_view(format).substr(at + 1, end - at - 1);
      const std::string_view spec = place.substr(std::min(place.size(), name.size()));
      if (place.starts_with(name) && (spec.empty() || spec[0] == ':')) Add(format, spec);
      at = end;
    }
  }

  bool IsWhole() const { return is_whole_; }
  /// The number farthest from `middle` that any place writes for `value`.
  double Written(double value, double middle) const {
    double farthest = middle;
    for (const std::string& place : places_) {
      const double written = WrittenAt(place, value);
      if (std::abs(written - middle) > std::abs(farthest - middle)) farthest = written;
    }
    return farthest;
  }

 private:
  void Add(const std::string& format, std::string_view spec) {
    const char type = spec.empty() ? 'f' : spec.back();
    if (std::string_view("xXobBaAcsp%L?{").find(type) != std::string_view::npos) {
      throw std::invalid_argument(
          fmt::format("format is {}, but a power must be a decimal number: write {{left:.2f}} or "
                      "{{left:d}}",
                      Quoted(format)));
    }
    is_whole_ = is_whole_ || type == 'd';
    places_.push_back(fmt::format("{{{}}}", spec));
  }
  double WrittenAt(const std::string& place, double value) const {
    const long long whole = std::llround(value);
    const std::string text = is_whole_ ? fmt::vformat(place, fmt::make_format_args(whole))
                                       : fmt::vformat(place, fmt::make_format_args(value));
    const size_t start = std::min(text.find_first_not_of(" +"), text.size());
    double written = 0.0;  // not strtod, which may want a comma
    std::from_chars(text.data() + start, text.data() + text.size(), written);
    return written;
  }

  std::vector<std::string> places_;
  bool is_whole_ = false;
};

/// A range of powers in the robot's unit.
struct Unit {
  explicit Unit(const PlainOptions& options)
      : middle(0.5 * (options.range.at(0) + options.range.at(1))),
        half(0.5 * (options.range.at(1) - options.range.at(0))) {}
  double Of(double power) const { return middle + half * power; }
  /// By how much `value` asks for more than `power`, as a share of full power.
  double Excess(double value, double power) const {
    return (std::abs(value - middle) - std::abs(half * power)) / std::abs(half);
  }

  double middle, half;
};

constexpr double kSame = 1e-9;  // of full power

/// What to write for `power`, so that no rounding makes it more than was allowed: rounding is
/// monotone, so the largest value that is not too much is found by halving.
double Towards0(const Number& number, const Unit& unit, double power) {
  const auto is_too_much = [&](double asked) {
    return unit.Excess(number.Written(unit.Of(asked), unit.middle), power) > kSame;
  };
  if (!is_too_much(power)) return unit.Of(power);
  double less = 0.0, more = power;
  for (int i = 0; i < 50; ++i) {
    const double half = 0.5 * (less + more);
    (is_too_much(half) ? more : less) = half;
  }
  return unit.Of(less);
}

/// Why a number of that format and range cannot say which power is meant; none: it can.
std::optional<std::string> FaultOf(const Number& number, const Unit& unit, std::string_view name) {
  constexpr double kCoarsest = 0.05;  // of full power
  const double zero = number.Written(unit.middle, unit.middle);
  if (unit.Excess(zero, 0.0) > kSame) {
    return fmt::format(
        "it writes {:g} for the {} wheel at zero power, and the middle of the range is {:g}: write "
        "more decimals, or choose a range whose middle it can write",
        zero, name, unit.middle);
  }
  const int steps = static_cast<int>(std::lround(1.0 / kCoarsest));
  double before = zero;
  for (int i = 1; i <= 2 * steps; ++i) {
    if (i == steps + 1) before = zero;  // and backward
    const double power = kCoarsest * (i <= steps ? i : steps - i);
    const double written = number.Written(Towards0(number, unit, power), unit.middle);
    if (std::abs(written - before) <= kSame * std::abs(unit.half)) {
      return fmt::format(
          "it writes {:g} for the {} wheel at power {:g} and at {:g}: powers {:g} apart must be "
          "told apart: write more decimals, or a wider range",
          written, name, power - std::copysign(kCoarsest, power), power, kCoarsest);
    }
    before = written;
  }
  return std::nullopt;
}

}  // namespace

std::string PlainLine(const control::WheelPower& power, const PlainOptions& options) {
  static_cast<void>(MilliOf(power));  // refuses what is beyond full power
  try {
    const Unit unit(options);
    fmt::dynamic_format_arg_store<fmt::format_context> numbers;
    const auto put = [&](const char* name, double share) {
      const Number number(options.format, name);
      const double value = Towards0(number, unit, share);
      if (number.IsWhole()) {
        numbers.push_back(fmt::arg(name, std::llround(value)));
      } else {
        numbers.push_back(fmt::arg(name, value));
      }
    };
    put("left", power.left);
    put("right", power.right);
    return fmt::vformat(options.format, numbers);
  } catch (const fmt::format_error& error) {
    throw std::invalid_argument(
        fmt::format("format is {}, but {}; write it as in \"{{left:.2f}} {{right:.2f}}\\n\" or "
                    "\"M {{left:d}},{{right:d}}\\r\\n\"",
                    Quoted(options.format), error.what()));
  }
}

void PlainOptions::Check() const {
  if (range.size() != 2 || range[0] == range[1]) {
    throw std::invalid_argument(
        "range must be two different numbers, full power backward and forward, such as [-255, "
        "255]");
  }
  const auto fail = [&](const std::string& rule) {
    throw std::invalid_argument(fmt::format("format is {}, but {}", Quoted(format), rule));
  };
  const std::string zero = PlainLine({}, *this);
  for (const double power : {-1.0, 1.0}) {
    const std::string left = PlainLine({power, 0.0}, *this), right = PlainLine({0.0, power}, *this);
    if (left == zero) fail("the left power is not in it: write {left:.2f} or {left:d}");
    if (right == zero) fail("the right power is not in it: write {right:.2f} or {right:d}");
    if (left == right) fail("left and right cannot be told apart");
    for (const std::string& line : {left, right}) {
      if (line.size() > kLongestPlainLine) {
        fail(fmt::format("a command of it has {} bytes: at most {}", line.size(),
                         kLongestPlainLine));
      }
    }
  }
  if (zero.back() != '\n' && zero.back() != '\r') {
    fail("a command must end with a line ending: \"...\\n\" or \"...\\r\\n\", in double quotes");
  }
  for (const char* name : {"left", "right"}) {
    if (const auto fault = FaultOf(Number(format, name), Unit(*this), name)) fail(*fault);
  }
}

}  // namespace rift::hardware
