#include "key_path.hpp"

#include <fmt/format.h>

namespace rift::yaml {
namespace {

/// No real key has more parts; a line of dots must not become a tower of maps.
constexpr std::size_t kMostParts = 32;

/// `a.b: x` as `a: {b: x}`; a key without dots as it is.
Node::Entry Nest(Node::Entry entry) {
  const std::vector<std::string> parts = SplitPath(entry.key);
  if (parts.size() < 2 || parts.size() > kMostParts) return entry;
  entry.key = parts.back();
  for (std::size_t i = parts.size() - 1; i-- > 0;) {
    Node block = Node::Map();
    block.origin = entry.origin;
    const Origin origin = entry.origin;
    block.entries.push_back(std::move(entry));
    entry = {parts[i], origin, std::move(block), {}};
  }
  return entry;
}

}  // namespace

void FailDuplicate(std::string_view key, const Origin& first, const Origin& second) {
  throw Error(fmt::format("{}: key '{}' is given twice: the first is at {}; remove one of them",
                          second.Text(), key, first.Text()));
}

std::vector<std::string> SplitPath(std::string_view key) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  while (true) {
    const std::size_t dot = key.find('.', begin);
    parts.emplace_back(key.substr(begin, dot - begin));
    if (parts.back().empty()) return {};
    if (dot == std::string_view::npos) return parts;
    begin = dot + 1;
  }
}

bool EndsAtPart(std::string_view key, std::string_view end) {
  return key.size() > end.size() + 1 && key.ends_with(end) &&
         key[key.size() - end.size() - 1] == '.';
}

void AddLiteral(Node& map, Node::Entry entry, const std::string& path) {
  Node::Entry* mine = map.Find(entry.key);
  if (mine == nullptr) {
    map.entries.push_back(std::move(entry));
    return;
  }
  const std::string key = Join(path, entry.key);
  if (!mine->value.IsMap() || !entry.value.IsMap()) FailDuplicate(key, mine->origin, entry.origin);
  for (Node::Entry& inner : entry.value.entries) AddLiteral(mine->value, std::move(inner), key);
}

void AddAtPath(Node& map, Node::Entry entry, const std::string& path) {
  AddLiteral(map, Nest(std::move(entry)), path);
}

}  // namespace rift::yaml
