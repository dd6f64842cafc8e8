#include "rift/yaml/tree.hpp"

#include <algorithm>
#include <array>
#include <map>

#include "key_path.hpp"

namespace rift::yaml {
namespace {

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

}  // namespace

void Merge(Node& base, const Node& over) {
  if (!base.IsMap() || !over.IsMap()) {
    base = over;
    return;
  }
  for (const Node::Entry& entry : over.entries) {
    Node::Entry* mine = base.Find(entry.key);
    if (mine == nullptr) {
      base.entries.push_back(entry);
    } else if (mine->value.IsMap() && entry.value.IsMap()) {
      Merge(mine->value, entry.value);
    } else {
      *mine = entry;
    }
  }
}

bool IsContinuousAxis(const Node& node) {
  constexpr std::array<std::string_view, 4> kAxisKeys{"min", "max", "scale", "integer"};
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
