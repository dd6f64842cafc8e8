#pragma once

#include <string>
#include <string_view>
#include <utility>

namespace rift::report {

/// Width and height from the header of a PNG (RFC 2083, 11.2.1); {0, 0} when it is none.
inline std::pair<int, int> PngSize(std::string_view png) {
  constexpr std::string_view kSignature("\x89PNG\r\n\x1a\n", 8);
  if (png.size() < 24 || png.substr(0, 8) != kSignature) return {0, 0};
  const auto number = [png](std::size_t at) {
    int value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = 256 * value + static_cast<unsigned char>(png[i]);
    return value;
  };
  return {number(16), number(20)};
}

}  // namespace rift::report
