#include "text_check.hpp"

#include <fmt/format.h>

#include "rift/yaml/utf8.hpp"

namespace rift::yaml {
namespace {

unsigned Byte(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0U;
}

bool IsControl(std::string_view text, std::size_t at) {
  const unsigned byte = Byte(text, at);
  if (byte == '\r') return Byte(text, at + 1) != '\n';
  return (byte < 0x20 && byte != '\n' && byte != '\t') || byte == 0x7F;
}

bool Indents(std::string_view text, std::size_t at, std::size_t line_begin) {
  const std::string_view before = text.substr(line_begin, at - line_begin);
  return text[at] == '\t' && before.find_first_not_of(' ') == std::string_view::npos;
}

}  // namespace

std::size_t Utf8Length(std::string_view text, std::size_t at) {
  const unsigned lead = Byte(text, at);
  if (lead < 0x80) return 1;
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC2 ? 2 : 0;
  if (length == 0 || lead > 0xF4 || at + length > text.size()) return 0;
  unsigned point = lead & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    const unsigned next = Byte(text, at + i);
    if ((next & 0xC0U) != 0x80U) return 0;
    point = point << 6U | (next & 0x3FU);
  }
  const bool overlong = (length == 3 && point < 0x800) || (length == 4 && point < 0x10000);
  const bool surrogate = point >= 0xD800 && point <= 0xDFFF;
  return overlong || surrogate || point > 0x10FFFF ? 0 : length;
}

bool IsUtf8(std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = Utf8Length(text, at);
    if (length == 0) return false;
    at += length;
  }
  return true;
}

void CheckText(std::string_view text, const std::string& source) {
  Origin here{source, 1, 1};
  std::size_t line_begin = 0;
  for (std::size_t at = 0; at < text.size();) {
    here.column = static_cast<int>(at - line_begin) + 1;
    const std::size_t length = Utf8Length(text, at);
    if (length == 0) {
      throw Error(fmt::format("{}: byte 0x{:02x} is not UTF-8; save the file as UTF-8 text",
                              here.Text(), Byte(text, at)));
    }
    if (IsControl(text, at)) {
      throw Error(fmt::format("{}: control character 0x{:02x}; this is no YAML text file",
                              here.Text(), Byte(text, at)));
    }
    if (Indents(text, at, line_begin)) {
      throw Error(here.Text() + ": a tab indents this line; YAML wants spaces");
    }
    if (text[at] == '\n') {
      ++here.line;
      line_begin = at + 1;
    }
    at += length;
  }
}

void CheckClosed(std::string_view text, std::size_t at, const Origin& origin) {
  const char quote = at < text.size() ? text[at] : '\0';
  if (quote != '"' && quote != '\'') return;
  for (std::size_t i = at + 1; i < text.size(); ++i) {
    if (quote == '"' && text[i] == '\\') {
      ++i;
    } else if (text[i] == quote) {
      if (quote == '"' || i + 1 >= text.size() || text[i + 1] != quote) return;
      ++i;  // two single quotes stand for one
    }
  }
  throw Error(origin.Text() + ": the quote that opens here is never closed");
}

}  // namespace rift::yaml
