#include "rift/yaml/node.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "block_limit.hpp"
#include "rift/yaml/bind.hpp"

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

std::string OneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      line += "\\n";
    } else if (byte < 0x20 || byte == 0x7F) {
      line += fmt::format("\\x{:02x}", byte);
    } else {
      line += c;
    }
  }
  return line;
}

void Collect(const Node& map, const std::string& path,
             const std::function<bool(const Node&)>& is_leaf, std::vector<FlatEntry>& out) {
  for (const Node::Entry& entry : map.entries) {
    std::string key = Join(path, entry.key);
    if (entry.value.IsMap() && !entry.value.entries.empty() && !is_leaf(entry.value)) {
      Collect(entry.value, key, is_leaf, out);
    } else {
      out.push_back({std::move(key), entry.origin, &entry.value});
    }
  }
}

constexpr std::size_t kNoPlace = static_cast<std::size_t>(-1);

/// Where the keys of one map stand in another, in one walk over both.
std::vector<std::size_t> PlacesIn(const Node& base, const Node& over) {
  std::vector<std::size_t> places(over.entries.size(), kNoPlace);
  std::unordered_map<std::string_view, std::size_t> in_over;
  for (std::size_t i = 0; i < places.size(); ++i) in_over.emplace(over.entries[i].key, i);
  for (std::size_t i = 0; i < base.entries.size(); ++i) {
    const auto found = in_over.find(base.entries[i].key);
    if (found != in_over.end()) places[found->second] = i;
  }
  return places;
}

}  // namespace

Error::Error(std::string_view message) : std::runtime_error(OneLine(message)) {}

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

Node Node::List() { return List(std::vector<Node>{}); }

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

void RequireFewKeys(std::size_t keys, const Origin& origin) {
  if (keys <= kMostKeys) return;
  throw Error(fmt::format("{}: more than {} keys in one block", origin.Text(), kMostKeys));
}

void Merge(Node& base, const Node& over) {
  if (!base.IsMap() || !over.IsMap()) {
    base = over;
    return;
  }
  const std::vector<std::size_t> places = PlacesIn(base, over);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Node::Entry& entry = over.entries[i];
    if (places[i] == kNoPlace) {
      base.entries.push_back(entry);
      continue;
    }
    Node::Entry& mine = base.entries[places[i]];
    if (mine.value.IsMap() && entry.value.IsMap()) {
      Merge(mine.value, entry.value);
    } else {
      mine = entry;
    }
  }
  RequireFewKeys(base.entries.size(), base.origin);
}

bool IsAxis(const Node& node) {
  constexpr std::array<std::string_view, 8> kAxisKeys{"min",    "max",      "scale", "integer",
                                                      "values", "settable", "step",  "nominal"};
  return node.IsMap() && !node.entries.empty() &&
         std::all_of(node.entries.begin(), node.entries.end(), [&](const Node::Entry& entry) {
           return std::find(kAxisKeys.begin(), kAxisKeys.end(), entry.key) != kAxisKeys.end();
         });
}

std::vector<FlatEntry> Flatten(const Node& map, const std::function<bool(const Node&)>& is_leaf) {
  std::vector<FlatEntry> flat;
  Collect(map, "", is_leaf, flat);
  std::map<std::string_view, const Origin*> seen;
  for (const FlatEntry& entry : flat) {
    const auto [first, is_new] = seen.emplace(entry.key, &entry.origin);
    if (!is_new) FailDuplicate(entry.key, *first->second, entry.origin);
  }
  return flat;
}

Node ExpandDottedKeys(const Node& map) {
  if (!map.IsMap()) return map;
  Node expanded = Node::Map();
  expanded.origin = map.origin;
  for (const Node::Entry& entry : map.entries) {
    Node::Entry opened = entry;
    opened.value = ExpandDottedKeys(entry.value);
    AddAtPath(expanded, std::move(opened), "");
  }
  return expanded;
}

}  // namespace rift::yaml
