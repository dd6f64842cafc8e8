#include "rift/files/shell_word.hpp"

#include <string_view>

namespace rift::files {

std::string ShellQuoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string ShellWord(const std::string& text) {
  static constexpr std::string_view kSpecial = " \t\n\r\v\f'\"\\$&;()<>|*?[]#`!{}~^";
  const bool is_plain = !text.empty() && text.find_first_of(kSpecial) == text.npos;
  return is_plain ? text : ShellQuoted(text);
}

}  // namespace rift::files
