#include "rift/yaml/error.hpp"

#include <fmt/format.h>

namespace rift::yaml {
namespace {

std::string OneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      line += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      line += fmt::format("\\x{:02x}", byte);
    } else {
      line += c;
    }
  }
  return line;
}

}  // namespace

Error::Error(std::string_view message) : std::runtime_error(OneLine(message)) {}

}  // namespace rift::yaml
