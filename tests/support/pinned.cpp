#include "support/pinned.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include "support/inputs/trials.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift::test {
namespace {

constexpr double kSame = 1e-9;

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

/// Numbers are equal within kSame of their size (of 1, for what is nearly nothing), all else is
/// equal to the byte.
bool IsSameLine(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const char *p = a.c_str(), *q = b.c_str();
  while (*p != 0 && *q != 0) {
    if (IsDigit(*p) && IsDigit(*q)) {
      char *p_end = nullptr, *q_end = nullptr;
      const double x = std::strtod(p, &p_end), y = std::strtod(q, &q_end);
      if (!(std::abs(x - y) <= kSame * std::max({1.0, std::abs(x), std::abs(y)}))) return false;
      p = p_end;
      q = q_end;
    } else if (*p++ != *q++) {
      return false;
    }
  }
  return *p == *q;
}

}  // namespace

std::string DifferenceFromPinned(const std::string& name, std::string text) {
  text = std::regex_replace(text, std::regex("(rift_version\"?: ?)\"[0-9.]+\""), "$1\"VERSION\"");
  text = std::regex_replace(text, std::regex("\\(rift [0-9.]+\\)"), "(rift VERSION)");
  if (text.empty() || text.back() != '\n') text += '\n';
  const std::filesystem::path path = std::filesystem::path(SourceDir()) / "tests/pinned" / name;
  if (std::getenv("RIFT_PIN") != nullptr) {
    WriteText(path, text);
    return "";
  }
  if (!std::filesystem::exists(path)) return path.string() + " is not there: run with RIFT_PIN=1";
  std::istringstream pinned(ReadFile(path)), now(text);
  std::string expected, found;
  for (int line = 1;; ++line) {
    const bool has_expected = static_cast<bool>(std::getline(pinned, expected));
    const bool has_found = static_cast<bool>(std::getline(now, found));
    if (!has_expected && !has_found) return "";
    if (!has_expected) expected = "(the end)";
    if (!has_found) found = "(the end)";
    if (has_expected == has_found && IsSameLine(expected, found)) continue;
    return fmt::format("tests/pinned/{}:{} (RIFT_PIN=1 writes it anew)\n  pinned: {}\n  now:    {}",
                       name, line, expected, found);
  }
}

}  // namespace rift::test
