#include "last_error.hpp"

#include <string_view>

namespace rift::sweep {
namespace {

/// What Node writes below an error: blank lines, its stack, the end of its properties, its version.
bool IsBelowError(std::string_view line) {
  const size_t begin = line.find_first_not_of(" \t\r");
  if (begin == line.npos) return true;
  const std::string_view words = line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
  return words == "}" || (begin > 0 && words.starts_with("at ")) ||
         words.starts_with("Node.js v") || words.starts_with("(Use `node ");
}

}  // namespace

std::string ErrorIn(std::string text) {
  constexpr int kMostLines = 64;
  text.resize(text.find_last_not_of(" \t\r\n") + 1);
  std::string nearest;
  std::string_view rest = text;
  for (int i = 0; i < kMostLines && !rest.empty(); ++i) {
    const size_t begin = rest.rfind('\n') + 1;
    const std::string_view line = rest.substr(begin);
    rest = rest.substr(0, begin == 0 ? 0 : begin - 1);
    if (IsBelowError(line)) continue;
    if (nearest.empty()) nearest = line;
    const bool is_error = line.find("Error") != line.npos || line.find("error:") != line.npos;
    if (i == 0 || is_error) return std::string(line);
  }
  return nearest.empty() ? text.substr(text.rfind('\n') + 1) : nearest;
}

}  // namespace rift::sweep
