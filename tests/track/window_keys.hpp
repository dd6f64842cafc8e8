#pragma once

#include <string>

#include "support/processes/shell.hpp"

namespace rift::test {

/// Whether a shell ends with 0; what it prints is dropped.
inline bool Succeeds(const std::string& command) {
  return RunShell(command + " >/dev/null 2>&1") == 0;
}

inline int CountOf(const std::string& word, const std::string& text) {
  int count = 0;
  for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++count;
  return count;
}

}  // namespace rift::test
