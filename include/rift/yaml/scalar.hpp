#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Both ends belong to it; an end may be infinite.
struct Range {
  double min;
  double max;
};

/// What a message needs to know of the field that a value is read for.
struct Place {
  std::string key;  ///< full dotted key
  std::optional<Range> range;
  std::string help;
};

/// The finite decimal number that the whole text spells, perhaps with a sign; none for anything
/// else. This is the one rule of what a number is.
std::optional<double> NumberOf(std::string_view text);
/// The same of a plain scalar; none for a quoted one, which is text.
std::optional<double> NumberOf(const Node& node);

/// Strict readers. Each throws Error naming place, key, value and rule. Numbers are decimal,
/// finite and in range: no 0x, no 1_000, no 12abc; a whole number may be written 1e3.
double ReadDouble(const Node& node, const Place& place);
int ReadInt(const Node& node, const Place& place);
std::uint64_t ReadUint64(const Node& node, const Place& place);
/// `true` or `false`, nothing else.
bool ReadBool(const Node& node, const Place& place);
/// Any scalar, as written.
std::string ReadText(const Node& node, const Place& place);
/// Index of the scalar among `names`.
std::size_t ReadName(const Node& node, const Place& place, std::span<const std::string_view> names);

/// Shortest text that reads back to the same bits. Throws Error naming `key` when not finite.
std::string NumberText(double value, std::string_view key = {});

/// `in [0, 1]`, `at least 0`, or `a finite number`.
std::string RangeText(const Range& range);

}  // namespace rift::yaml
