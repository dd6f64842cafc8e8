#include "quoting.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "rift/yaml/error.hpp"
#include "text_check.hpp"

namespace rift::yaml {
namespace {

bool IsAlnum(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

/// C1 controls, no-break space, line and paragraph separators, byte order mark: readers disagree
/// about them, and a person cannot see them.
bool IsInvisible(std::string_view sequence) {
  constexpr std::array<std::string_view, 4> kOthers{"\xC2\xA0", "\xE2\x80\xA8", "\xE2\x80\xA9",
                                                    "\xEF\xBB\xBF"};
  const bool is_c1 = sequence.size() == 2 && sequence[0] == '\xC2' &&
                     static_cast<unsigned char>(sequence[1]) < 0xA0;
  return is_c1 || std::find(kOthers.begin(), kOthers.end(), sequence) != kOthers.end();
}

std::string CheckedSequence(std::string_view text, std::size_t at) {
  const std::size_t length = Utf8Length(text, at);
  if (length == 0) {
    throw Error(fmt::format("text with byte 0x{:02x} is not UTF-8 and cannot be written as YAML",
                            static_cast<unsigned char>(text[at])));
  }
  return std::string(text.substr(at, length));
}

/// Plain in a block and between brackets, for any YAML reader.
bool IsSafePlain(std::string_view text) {
  constexpr std::string_view kInside = "_-./+=()@%* ";
  if (text.empty() || text.back() == ' ') return false;
  const bool is_path = text.starts_with("./") || text.starts_with("../") || text[0] == '/';
  const bool wide = (text[0] & '\x80') != 0;
  if (!IsAlnum(text[0]) && text[0] != '_' && !is_path && !wide) return false;
  for (std::size_t at = 0; at < text.size();) {
    const std::string sequence = CheckedSequence(text, at);
    if (sequence.size() == 1) {
      const char c = text[at];
      if (!IsAlnum(c) && kInside.find(c) == std::string_view::npos) return false;
    } else if (IsInvisible(sequence)) {
      return false;
    }
    at += sequence.size();
  }
  return true;
}

/// True for everything that some YAML reader takes for a number, a date or a time, and then some.
bool MayBeNumber(std::string_view text) {
  return std::isdigit(static_cast<unsigned char>(text[0])) != 0 &&
         text.find_first_not_of("0123456789abcdefABCDEFxXoO_.:+-TZ ") == std::string_view::npos;
}

/// What YAML 1.1 or 1.2 readers take for a bool or for nothing.
bool IsWord(std::string_view text) {
  constexpr std::array<std::string_view, 7> kWords{"true", "false", "yes", "no",
                                                   "on",   "off",   "null"};
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return std::find(kWords.begin(), kWords.end(), lower) != kWords.end();
}

std::string Escaped(const std::string& sequence) {
  const auto byte = static_cast<unsigned char>(sequence[0]);
  if (sequence == "\"" || sequence == "\\") return "\\" + sequence;
  if (sequence == "\n") return "\\n";
  if (sequence == "\t") return "\\t";
  if (byte < 0x20 || byte == 0x7F) return fmt::format("\\x{:02x}", byte);
  if (!IsInvisible(sequence)) return sequence;
  if (sequence.size() == 2)
    return fmt::format("\\x{:02x}", static_cast<unsigned char>(sequence[1]));
  return sequence == "\xE2\x80\xA8"   ? "\\u2028"
         : sequence == "\xE2\x80\xA9" ? "\\u2029"
                                      : "\\ufeff";
}

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (std::size_t at = 0; at < text.size();) {
    const std::string sequence = CheckedSequence(text, at);
    quoted += Escaped(sequence);
    at += sequence.size();
  }
  return quoted + "\"";
}

}  // namespace

std::string QuotedWhenText(std::string_view text) {
  const bool plain = IsSafePlain(text) && !MayBeNumber(text) && !IsWord(text);
  return plain ? std::string(text) : Quoted(text);
}

std::string QuotedWhenUnsafe(std::string_view text) {
  const bool negative = text.size() > 1 && text[0] == '-' && (IsAlnum(text[1]) || text[1] == '.');
  const bool plain = IsSafePlain(negative ? text.substr(1) : text);
  return plain ? std::string(text) : Quoted(text);
}

std::string KeyText(std::string_view key) {
  return key.find('.') == std::string_view::npos ? QuotedWhenText(key) : Quoted(key);
}

}  // namespace rift::yaml
