#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

namespace rift::yaml {

/// The name of an enum's value, as YAML, tables and JSON write it.
template <class Enum>
constexpr std::string_view NameOf(Enum value) {
  return EnumNames(value)[static_cast<std::size_t>(value)];
}

/// The value of that name, if there is one.
template <class Enum>
constexpr std::optional<Enum> ValueNamed(std::string_view name) {
  const auto names = EnumNames(Enum{});
  const auto* const found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<Enum>(found - names.begin());
}

}  // namespace rift::yaml
