#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

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

}  // namespace

std::string PlainLine(const control::WheelPower& power, const PlainOptions& options) {
  static_cast<void>(MilliOf(power));  // refuses what is beyond full power
  const double middle = 0.5 * (options.range.at(0) + options.range.at(1));
  const double half = 0.5 * (options.range.at(1) - options.range.at(0));
  const auto number = [&](double share) { return middle + half * share; };
  const double left = number(power.left), right = number(power.right);
  try {
    return fmt::vformat(options.format,
                        fmt::make_format_args(fmt::arg("left", left), fmt::arg("right", right)));
  } catch (const fmt::format_error&) {  // {left:d} wants whole numbers
    try {
      const long long whole_left = std::llround(left), whole_right = std::llround(right);
      return fmt::vformat(options.format, fmt::make_format_args(fmt::arg("left", whole_left),
                                                                fmt::arg("right", whole_right)));
    } catch (const fmt::format_error& error) {
      throw std::invalid_argument(
          fmt::format("format is {}, but {}; write it as in \"{{left:.2f}} {{right:.2f}}\\n\" or "
                      "\"M {{left:d}},{{right:d}}\\r\\n\"",
                      Quoted(options.format), error.what()));
    }
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
}

}  // namespace rift::hardware
