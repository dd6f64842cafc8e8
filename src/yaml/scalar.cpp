#include "rift/yaml/scalar.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "rift/yaml/decimal.hpp"
#include "rift/yaml/suggest.hpp"

namespace rift::yaml {
namespace {

/// Every whole number up to here is a double of its own.
constexpr double kExactWhole = 9007199254740992.0;  // 2^53

[[noreturn]] void Refuse(const Node& node, const Place& place, const std::string& rule) {
  const std::string meaning = place.help.empty() ? "" : "; meaning: " + place.help;
  Fail(node, place.key, "must be " + rule + meaning);
}

bool SpellsNotFinite(std::string_view text) {
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  for (const std::string_view name : {".inf", ".Inf", ".INF", ".nan", ".NaN", ".NAN"}) {
    if (text == name) return true;
  }
  return false;
}

/// What the whole text spells in decimal digits: `fault` is none, invalid_argument for no number,
/// result_out_of_range for one that a double cannot hold. `inf` and `nan` count as numbers here.
struct Spelled {
  double value = 0.0;
  std::errc fault{};

  bool IsFinite() const { return fault == std::errc() && std::isfinite(value); }
};

Spelled Spell(std::string_view text) {
  Spelled spelled;
  spelled.fault = ReadDecimal(text, spelled.value);
  return spelled;
}

/// The finite number that the whole text spells; `expected` names what is wanted in messages.
double ParseNumber(const Node& node, const Place& place, const std::string& expected) {
  if (!node.IsScalar()) Refuse(node, place, expected);
  if (node.quoted) Refuse(node, place, expected + "; remove the quotes");
  const Spelled spelled = Spell(node.text);
  if (spelled.IsFinite()) return spelled.value;
  if (spelled.fault == std::errc() || SpellsNotFinite(node.text)) {
    Refuse(node, place, expected + " that is finite");
  }
  const bool is_too_large = spelled.fault == std::errc::result_out_of_range;
  Refuse(node, place, expected + (is_too_large ? " that a double can hold" : ""));
}

/// The whole text as digits; false when it is not that, or does not fit.
bool ParseDigits(std::string_view text, std::uint64_t& value) {
  return ReadDecimal(text, value) == std::errc();
}

double ParseWhole(const Node& node, const Place& place) {
  const double value = ParseNumber(node, place, "a whole number");
  if (value != std::floor(value)) Refuse(node, place, "a whole number");
  return value;
}

}  // namespace

std::optional<double> NumberOf(std::string_view text) {
  const Spelled spelled = Spell(text);
  return spelled.IsFinite() ? std::optional(spelled.value) : std::nullopt;
}

std::optional<double> NumberOf(const Node& node) {
  return node.IsScalar() && !node.quoted ? NumberOf(node.text) : std::nullopt;
}

double ReadDouble(const Node& node, const Place& place) {
  const double value = ParseNumber(node, place, "a number");
  if (place.range && !(value >= place.range->min && value <= place.range->max)) {
    Refuse(node, place, RangeText(*place.range));
  }
  return value;
}

int ReadInt(const Node& node, const Place& place) {
  using Limits = std::numeric_limits<int>;
  const double value = ParseWhole(node, place);
  const Range range = place.range.value_or(Range{Limits::min(), Limits::max()});
  if (!(value >= range.min && value <= range.max)) Refuse(node, place, RangeText(range));
  return static_cast<int>(value);
}

std::uint64_t ReadUint64(const Node& node, const Place& place) {
  std::uint64_t value = 0;
  if (node.IsScalar() && !node.quoted && ParseDigits(node.text, value)) return value;
  const double number = ParseWhole(node, place);
  if (number < 0.0 || number >= 18446744073709551616.0) {
    Refuse(node, place, "in [0, 18446744073709551615]");
  }
  if (number > kExactWhole) Refuse(node, place, "written out in digits above 2^53");
  return static_cast<std::uint64_t>(number);
}

bool ReadBool(const Node& node, const Place& place) {
  const bool plain = node.IsScalar() && !node.quoted;
  if (plain && node.text == "true") return true;
  if (plain && node.text == "false") return false;
  Refuse(node, place, "true or false");
}

std::string ReadText(const Node& node, const Place& place) {
  if (node.IsNull()) Refuse(node, place, "text; write \"\" for none");
  if (!node.IsScalar()) Refuse(node, place, "text; put quotes around text with [ or {");
  return node.text;
}

std::size_t ReadName(const Node& node, const Place& place,
                     std::span<const std::string_view> names) {
  if (node.IsScalar()) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == node.text) return i;
    }
  }
  std::string rule = fmt::format("one of {}", fmt::join(names, ", "));
  const std::string nearest = Nearest(node.text, {names.begin(), names.end()});
  if (!nearest.empty()) rule += fmt::format("; did you mean '{}'?", nearest);
  Refuse(node, place, rule);
}

std::string NumberText(double value, std::string_view key) {
  if (!std::isfinite(value)) {
    throw Error(fmt::format("key '{}' is {}: must be finite to be written", key, value));
  }
  return fmt::format("{}", value);  // shortest exact, and 100000 where to_chars gives 1e+05
}

std::string RangeText(const Range& range) {
  const bool has_min = std::isfinite(range.min);
  const bool has_max = std::isfinite(range.max);
  if (has_min && has_max) {
    return fmt::format("in [{}, {}]", NumberText(range.min), NumberText(range.max));
  }
  if (has_min) return "at least " + NumberText(range.min);
  if (has_max) return "at most " + NumberText(range.max);
  return "a finite number";
}

}  // namespace rift::yaml
