#include <algorithm>

#include <fmt/format.h>

#include "quoting.hpp"
#include "rift/yaml/error.hpp"
#include "rift/yaml/write.hpp"

namespace rift::yaml {
namespace {

constexpr std::size_t kLineWidth = 90;

std::string ScalarText(const Node& node) {
  if (node.IsNull()) return "null";
  return node.quoted ? QuotedWhenText(node.text) : QuotedWhenUnsafe(node.text);
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
