#pragma once

#include <cstddef>
#include <string_view>

namespace rift::yaml {

/// The name of an enum's value, as YAML, tables and JSON write it.
template <class Enum>
constexpr std::string_view NameOf(Enum value) {
  return EnumNames(value)[static_cast<std::size_t>(value)];
}

}  // namespace rift::yaml
