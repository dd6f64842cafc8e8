#include "rift/yaml/node.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "rift/yaml/error.hpp"

namespace rift::yaml {
namespace {

constexpr std::size_t kLongestShown = 60;

/// The start of a text that is too long for a message, cut between characters.
std::string Cut(std::string_view text) {
  if (text.size() <= kLongestShown) return std::string(text);
  std::size_t end = kLongestShown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "...";
}

}  // namespace

std::string Origin::Text() const {
  return line > 0 ? fmt::format("{}:{}:{}", source, line, column) : source;
}

Node Node::Scalar(std::string plain_text) {
  Node node;
  node.kind = Kind::kScalar;
  node.text = std::move(plain_text);
  return node;
}

Node Node::Text(std::string text) {
  Node node = Scalar(std::move(text));
  node.quoted = true;
  return node;
}

Node Node::List(std::vector<Node> items) {
  Node node;
  node.kind = Kind::kList;
  node.items = std::move(items);
  return node;
}

Node Node::Map() {
  Node node;
  node.kind = Kind::kMap;
  return node;
}

const Node::Entry* Node::Find(std::string_view key) const {
  const auto found = std::find_if(entries.begin(), entries.end(),
                                  [key](const Entry& entry) { return entry.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

Node::Entry* Node::Find(std::string_view key) {
  return const_cast<Entry*>(static_cast<const Node&>(*this).Find(key));
}

void Node::Add(std::string key, Node value) {
  Origin key_origin = value.origin;
  entries.push_back({std::move(key), std::move(key_origin), std::move(value), {}});
}

std::string Shown(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kNull:
      return "empty";
    case Node::Kind::kScalar:
      return node.quoted ? '"' + Cut(node.text) + '"' : Cut(node.text);
    case Node::Kind::kList:
      return fmt::format("a list of {}", node.items.size());
    case Node::Kind::kMap:
      break;
  }
  return "a block of keys";
}

void Fail(const Node& node, std::string_view key, std::string_view rule) {
  const std::string where = node.origin.Text();
  throw Error(fmt::format("{}{}key '{}' is {}: {}", where, where.empty() ? "" : ": ", Cut(key),
                          Shown(node), rule));
}

std::string Join(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

}  // namespace rift::yaml
