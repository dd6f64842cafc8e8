#include "rift/yaml/write.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "rift/yaml/utf8.hpp"

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

/// Text as YAML, plain when every reader will take it for the same text (so not `true`, `1.0`,
/// `2024-01-01`, ``), else in double quotes. Throws Error when it is not UTF-8.
std::string QuotedWhenText(std::string_view text) {
  const bool plain = IsSafePlain(text) && !MayBeNumber(text) && !IsWord(text);
  return plain ? std::string(text) : Quoted(text);
}

/// A key: as text, and quoted when it has dots, which a plain key would open into nested maps.
std::string KeyText(std::string_view key) {
  return key.find('.') == std::string_view::npos ? QuotedWhenText(key) : Quoted(key);
}

constexpr std::size_t kLineWidth = 90;

/// A plain number or truth value, which quotes would make a text. Of other plain scalars the text
/// is all there is, and it may be written with quotes.
bool ReadsAsMoreThanText(const Node& node) {
  if (node.quoted) return false;
  return NumberOf(node.text) || node.text == "true" || node.text == "false";
}

std::string ScalarText(const Node& node) {
  if (node.IsNull()) return "null";
  return ReadsAsMoreThanText(node) ? node.text : QuotedWhenText(node.text);
}

/// Lists of scalars, and whatever is empty, on one line; nothing for the rest.
std::string FlowText(const Node& node) {
  if (node.IsNull() || node.IsScalar()) return ScalarText(node);
  if (node.IsMap()) return node.entries.empty() ? "{}" : "";
  std::string text;
  for (const Node& item : node.items) {
    if (!item.IsNull() && !item.IsScalar()) return "";
    text += (text.empty() ? "" : ", ") + ScalarText(item);
  }
  return "[" + text + "]";
}

std::string CommentText(std::string_view comment) {
  if (comment.empty()) return "";
  std::string line = "  # ";
  for (const char c : comment) line += c == '\n' || c == '\r' ? ' ' : c;
  return line;
}

class Emitter {
 public:
  std::string Document(const Node& root) {
    const std::string line = FlowText(root);
    if (!line.empty()) return line + "\n";
    Body(root, 0);
    return std::move(out_);
  }

 private:
  static std::string Margin(int depth) {
    return std::string(2 * static_cast<std::size_t>(depth), ' ');
  }

  bool FitsLine(const std::string& flow, int depth) const {
    return !flow.empty() && (flow[0] != '[' || Margin(depth).size() + flow.size() <= kLineWidth);
  }

  void Body(const Node& node, int depth) {
    for (const Node::Entry& entry : node.entries) {
      out_ += Margin(depth);
      Entry(entry, depth);
    }
    for (const Node& item : node.items) Item(item, depth);
  }

  /// The caller has written what stands before the key.
  void Entry(const Node::Entry& entry, int depth) {
    const std::string flow = FlowText(entry.value);
    const std::string comment = CommentText(entry.comment);
    if (FitsLine(flow, depth)) {
      out_ += fmt::format("{}: {}{}\n", KeyText(entry.key), flow, comment);
      return;
    }
    out_ += fmt::format("{}:{}\n", KeyText(entry.key), comment);
    Body(entry.value, depth + 1);
  }

  /// A map in a list starts on the line of its dash; a list in a list goes below it.
  void Item(const Node& item, int depth) {
    out_ += Margin(depth) + "-";
    const std::string flow = FlowText(item);
    if (FitsLine(flow, depth)) {
      out_ += " " + flow + "\n";
    } else if (item.IsMap()) {
      for (std::size_t i = 0; i < item.entries.size(); ++i) {
        out_ += i == 0 ? " " : Margin(depth + 1);
        Entry(item.entries[i], depth + 1);
      }
    } else {
      out_ += "\n";
      Body(item, depth + 1);
    }
  }

  std::string out_;
};

}  // namespace

std::string Emit(const Node& node) { return Emitter().Document(node); }

std::string InlineText(const Node& node) {
  const std::string flow = FlowText(node);
  if (!flow.empty() && flow.size() <= kLineWidth) return flow;
  const std::size_t size = node.IsMap() ? node.entries.size() : node.items.size();
  return fmt::format("{} {}", size, node.IsMap() ? "entries" : "items");
}

}  // namespace rift::yaml
