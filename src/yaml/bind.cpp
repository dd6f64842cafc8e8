#include "rift/yaml/bind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "rift/yaml/suggest.hpp"

namespace rift::yaml {

namespace {

void CollectSources(const Node& node, std::set<std::string>& sources) {
  sources.insert(node.origin.source);
  for (const Node& item : node.items) CollectSources(item, sources);
  for (const Node::Entry& entry : node.entries) CollectSources(entry.value, sources);
}

std::string Prefix(const Node& node, std::string_view key) {
  const std::string where = node.origin.Text();
  return fmt::format("{}{}{}", where, where.empty() ? "" : ": ",
                     key.empty() ? "" : fmt::format("key '{}': ", key));
}

}  // namespace

void RequireMap(const Node& node, const Place& place) {
  if (node.IsMap()) return;
  if (place.key.empty()) {
    throw Error(Prefix(node, "") + "must be keys with values (key: value)");
  }
  Fail(node, place.key, "must be a block of keys; give it some, or remove it for the defaults");
}

void RequireList(const Node& node, const Place& place) {
  if (!node.IsList()) Fail(node, place.key, "must be a list; write [a, b], or [] for none");
}

void FailUnknown(const Node::Entry& entry, std::string_view path, const KnownKeys& known) {
  std::string hint;
  std::vector<std::string> here = known.here;
  if (path.empty()) here.emplace_back("include");  // taken out of a file before it is bound
  const std::string nearest = Nearest(entry.key, here);
  if (!nearest.empty()) {
    hint = fmt::format("did you mean '{}'?", Join(path, nearest));
  } else {
    const auto elsewhere =
        std::find_if(known.anywhere.begin(), known.anywhere.end(),
                     [&](const std::string& key) { return EndsAtPart(key, entry.key); });
    if (elsewhere != known.anywhere.end()) hint = fmt::format("did you mean '{}'?", *elsewhere);
  }
  if (hint.empty()) hint = fmt::format("known keys here: {}", fmt::join(known.here, ", "));
  Node at_key = entry.value;
  at_key.origin = entry.origin;
  Fail(at_key, Join(path, entry.key), "no such key; " + hint);
}

void RequireKey(const Node& block, std::string_view path, std::string_view key) {
  if (block.Find(key) != nullptr) return;
  throw Error(
      fmt::format("{}key '{}' is missing: must be given", Prefix(block, ""), Join(path, key)));
}

void FailRule(const Node& block, std::string_view path, const std::invalid_argument& broken) {
  std::set<std::string> others;
  CollectSources(block, others);
  others.erase(block.origin.source);
  others.erase("");
  throw Error(fmt::format(
      "{}{}{}", Prefix(block, path), broken.what(),
      others.empty() ? "" : fmt::format(" (values also from {})", fmt::join(others, ", "))));
}

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
