#pragma once

#include <charconv>
#include <string_view>
#include <system_error>

namespace rift::yaml {

/// The number that all of `text` spells in decimal digits, with a plus or not: no fault,
/// invalid_argument for anything else, result_out_of_range for one that the type cannot hold. `inf`
/// and `nan` count as numbers here.
template <class Number>
std::errc ReadDecimal(std::string_view text, Number& value) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  if (has_plus) text.remove_prefix(1);
  const char* end = text.data() + text.size();
  const auto [read, fault] = std::from_chars(text.data(), end, value);
  return read == end ? fault : std::errc::invalid_argument;
}

}  // namespace rift::yaml
