#include <map>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include "block_limit.hpp"
#include "rift/limits/limits.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "text_check.hpp"

namespace rift::yaml {
namespace {

/// The map of these keys and values, keys with dots opened. `path` is that of the map.
void FillMap(Node& map, const std::vector<Node>& keys, std::vector<Node> values,
             const std::string& path) {
  RequireFewKeys(keys.size(), map.origin);
  std::map<std::string_view, const Origin*> seen;
  for (const Node& key : keys) {
    const auto [first, is_new] = seen.emplace(key.text, &key.origin);
    if (!is_new) FailDuplicate(Join(path, key.text), *first->second, key.origin);
  }
  for (std::size_t i = 0; i < keys.size(); ++i) {
    Node::Entry entry{keys[i].text, keys[i].origin, std::move(values[i]), {}};
    // Where nothing stands, yaml-cpp marks the token after it, often on another line.
    if (entry.value.IsNull()) entry.value.origin = entry.origin;
    if (keys[i].quoted) {
      AddLiteral(map, std::move(entry), path);
    } else {
      AddAtPath(map, std::move(entry), path);
    }
  }
}

/// Builds our tree from yaml-cpp's events. Its own YAML::Node would lose what a strict reader
/// needs: duplicate keys, where keys stand, which scalars were quoted.
class TreeBuilder : public YAML::EventHandler {
 public:
  /// `text` is what yaml-cpp reads; it must outlive the builder.
  TreeBuilder(std::string_view text, std::string source)
      : text_(text), source_(std::move(source)) {}

  Node Take() { return std::move(root_); }
  Origin At(const YAML::Mark& mark) const;

  void OnDocumentStart(const YAML::Mark& mark) override;
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override;
  void OnSequenceEnd() override { Close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override;
  void OnMapEnd() override;

 private:
  /// A list or map that is still open.
  struct Frame {
    Node node;
    bool has_key = false;  ///< of a map: a key waits for its value
    Node key;
    std::vector<Node> keys;  ///< of a map: one for each of node.items, until it is closed
  };

  void Open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor);
  void Close();
  void Deliver(Node value);
  void TakeKey(Frame& frame, Node key);
  void CheckPlain(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) const;
  std::string Path() const;

  std::string_view text_;
  std::string source_;
  std::vector<Frame> open_;
  Node root_;
  bool has_document_ = false;
};

Origin TreeBuilder::At(const YAML::Mark& mark) const {
  return {source_, mark.line + 1, mark.column + 1};
}

std::string TreeBuilder::Path() const {
  std::string path;
  for (const Frame& frame : open_) {
    if (frame.node.IsList()) {
      path += fmt::format("[{}]", frame.node.items.size());
    } else if (frame.has_key) {
      path = Join(path, frame.key.text);
    }
  }
  return path;
}

void TreeBuilder::OnDocumentStart(const YAML::Mark& mark) {
  if (has_document_) {
    throw Error(At(mark).Text() +
                ": a second document starts here; a file holds one: check the indentation and the "
                "quotes, or remove what follows");
  }
  has_document_ = true;
}

void TreeBuilder::CheckPlain(const YAML::Mark& mark, const std::string& tag,
                             YAML::anchor_t anchor) const {
  if (anchor != YAML::NullAnchor) {
    throw Error(At(mark).Text() +
                ": anchors (&name) are not supported; write the value out, or share it through "
                "'include'");
  }
  if (!tag.empty() && tag != "?" && tag != "!") {
    throw Error(fmt::format("{}: tags (here <{}>) are not supported; remove it", At(mark).Text(),
                            Shown(Node::Scalar(tag))));
  }
}

void TreeBuilder::OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) {
  CheckPlain(mark, "", anchor);
  Node node;
  node.origin = At(mark);
  Deliver(std::move(node));
}

void TreeBuilder::OnAlias(const YAML::Mark& mark, YAML::anchor_t) {
  throw Error(At(mark).Text() +
              ": aliases (*name) are not supported; write the value out, or share it through "
              "'include'");
}

void TreeBuilder::OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                           const std::string& value) {
  CheckPlain(mark, tag, anchor);
  Node node = Node::Scalar(value);
  node.quoted = tag == "!";
  node.origin = At(mark);
  if (node.quoted) CheckClosed(text_, static_cast<std::size_t>(mark.pos), node.origin);
  if (value.find('\0') != value.npos) {
    throw Error(node.origin.Text() +
                ": the text holds \\0, where names of files and messages end: leave it out");
  }
  Deliver(std::move(node));
}

void TreeBuilder::OnSequenceStart(const YAML::Mark& mark, const std::string& tag,
                                  YAML::anchor_t anchor, YAML::EmitterStyle::value) {
  Open(Node::Kind::kList, mark, tag, anchor);
}

void TreeBuilder::OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                             YAML::EmitterStyle::value) {
  Open(Node::Kind::kMap, mark, tag, anchor);
}

void TreeBuilder::Open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag,
                       YAML::anchor_t anchor) {
  CheckPlain(mark, tag, anchor);
  if (open_.size() >= static_cast<std::size_t>(kMaxDepth)) {
    throw Error(fmt::format("{}: more than {} levels of nesting", At(mark).Text(), kMaxDepth));
  }
  Frame frame;
  frame.node.kind = kind;
  frame.node.origin = At(mark);
  open_.push_back(std::move(frame));
}

void TreeBuilder::OnMapEnd() {
  Frame& frame = open_.back();
  std::vector<Node> values = std::move(frame.node.items);
  frame.node.items.clear();
  Frame done = std::move(frame);
  open_.pop_back();
  FillMap(done.node, done.keys, std::move(values), Path());
  Deliver(std::move(done.node));
}

void TreeBuilder::Close() {
  Node node = std::move(open_.back().node);
  open_.pop_back();
  Deliver(std::move(node));
}

void TreeBuilder::Deliver(Node value) {
  if (open_.empty()) {
    root_ = std::move(value);
    return;
  }
  Frame& frame = open_.back();
  if (frame.node.IsMap() && !frame.has_key) {
    TakeKey(frame, std::move(value));
    return;
  }
  if (frame.node.IsMap()) frame.keys.push_back(std::move(frame.key));
  frame.has_key = false;
  frame.node.items.push_back(std::move(value));
}

void TreeBuilder::TakeKey(Frame& frame, Node key) {
  const std::string where = key.origin.Text();
  if (!key.IsScalar()) throw Error(where + ": a key must be text, and this one is " + Shown(key));
  if (key.text == "<<" && !key.quoted) {
    throw Error(where + ": merge keys (<<) are not supported; share values through 'include'");
  }
  frame.has_key = true;
  frame.key = std::move(key);
}

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// yaml-cpp's usual complaint about `path: {surface}/x.csv` does not name the cure.
std::string QuoteHint(std::string_view text, int line) {
  for (int i = 0; i < line; ++i) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  const bool has_bracket = text.substr(0, text.find('\n')).find_first_of("{[") != text.npos;
  return has_bracket ? "; text that starts with { or [ needs quotes" : "";
}

}  // namespace

Node Parse(std::string_view text, const std::string& source) {
  limits::Require(limits::Amount::kYamlBytes, static_cast<double>(text.size()), source);
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  CheckText(text, source);
  std::istringstream stream{std::string(text)};
  TreeBuilder builder(text, source);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& fault) {
    const bool placed = !fault.mark.is_null();
    const Origin at = placed ? builder.At(fault.mark) : Origin{source, 1, 1};
    throw Error(fmt::format("{}: {}{}", at.Text(), fault.msg,
                            placed ? QuoteHint(text, fault.mark.line) : ""));
  }
  Node root = builder.Take();
  if (root.origin.line == 0) root.origin = {source, 1, 1};
  return root;
}

}  // namespace rift::yaml
