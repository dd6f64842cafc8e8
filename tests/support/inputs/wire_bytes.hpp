#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rift/hardware/wire.hpp"

namespace rift::test {

/// What remains of the bytes that a robot heard without whole command frames and plain lines.
inline std::string BytesThatAreNoCommands(const std::vector<std::uint8_t>& heard) {
  constexpr std::size_t kSize = hardware::CommandFrame::kSize;
  const std::string text(heard.begin(), heard.end());
  std::string others;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t left = text.size() - at, line = text.find('\n', at);
    const bool is_line = line != text.npos && hardware::ParsePlainLine(text.substr(at, line - at));
    if (left >= kSize && hardware::DecodeCommand({&heard[at], kSize})) {
      at += kSize;
    } else if (is_line) {
      at = line + 1;
    } else {
      others += text[at++];
    }
  }
  return others;
}

}  // namespace rift::test
