#include "text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "rift/yaml/utf8.hpp"

namespace rift::terminal {
namespace {

unsigned Byte(char c) { return static_cast<unsigned char>(c); }

/// The code point of a valid UTF-8 sequence.
unsigned CodePoint(std::string_view sequence) {
  if (sequence.size() == 1) return Byte(sequence[0]);
  unsigned point = Byte(sequence[0]) & (0x7FU >> sequence.size());
  for (const char c : sequence.substr(1)) point = point << 6U | (Byte(c) & 0x3FU);
  return point;
}

bool IsControl(unsigned point) { return point < 0x20 || point == 0x7F; }

/// C1 controls, separators of lines and paragraphs, and the marks, embeddings, overrides and
/// isolates of UAX #9 (Unicode bidirectional algorithm).
bool MisleadsReader(unsigned point) {
  return (point >= 0x80 && point < 0xA0) || point == 0x061C || point == 0x200E || point == 0x200F ||
         (point >= 0x2028 && point <= 0x202E) || (point >= 0x2066 && point <= 0x2069);
}

}  // namespace

std::string TerminalText(std::string_view text, LineBreaks line_breaks) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = yaml::Utf8Length(text, at);
    const std::string_view sequence = text.substr(at, length == 0 ? 1 : length);
    const unsigned point = length == 0 ? 0 : CodePoint(sequence);
    const bool is_own_break = line_breaks == LineBreaks::kKept && text[at] == '\n';
    if (length == 0 || (IsControl(point) && !is_own_break)) {
      fmt::format_to(std::back_inserter(shown), "\\x{:02x}", Byte(text[at]));
    } else if (MisleadsReader(point)) {
      fmt::format_to(std::back_inserter(shown), "\\u{{{:x}}}", point);
    } else {
      shown += sequence;
    }
    at += sequence.size();
  }
  return shown;
}

std::string FirstCharacters(const std::string& text, std::size_t most) {
  std::size_t end = 0;
  for (; most > 0 && end < text.size(); --most) {
    end += std::max<std::size_t>(1, yaml::Utf8Length(text, end));
  }
  return text.substr(0, end);
}

}  // namespace rift::terminal
