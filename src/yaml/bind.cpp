#include "rift/yaml/bind.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "rift/yaml/suggest.hpp"

namespace rift::yaml {

namespace {

void CollectOrigins(const Node& node, std::vector<const Origin*>& origins) {
  origins.push_back(&node.origin);
  for (const Node& item : node.items) CollectOrigins(item, origins);
  for (const Node::Entry& entry : node.entries) CollectOrigins(entry.value, origins);
}

const Node::Entry* FindPath(const Node& block, std::string_view path) {
  const Node* node = &block;
  const Node::Entry* entry = nullptr;
  for (const std::string& part : SplitPath(path)) {
    entry = node->Find(part);
    if (entry == nullptr) return nullptr;
    node = &entry->value;
  }
  return entry;
}

/// Where the keys of the block are written that the rule names, in its order.
std::vector<const Origin*> OriginsNamed(std::string_view rule, const Node& block) {
  constexpr std::string_view kLetters =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.";
  std::vector<const Origin*> origins;
  std::size_t begin = rule.find_first_of(kLetters);
  while (begin != rule.npos) {
    const std::size_t end = std::min(rule.find_first_not_of(kLetters, begin), rule.size());
    std::string_view word = rule.substr(begin, end - begin);
    while (word.ends_with('.')) word.remove_suffix(1);
    const Node::Entry* entry = FindPath(block, word);
    if (entry != nullptr) origins.push_back(&entry->origin);
    begin = rule.find_first_of(kLetters, end);
  }
  return origins;
}

/// The first of those written last: a block keeps the origin of its first writer.
const Origin& Latest(const std::vector<const Origin*>& origins, const Origin& of_block) {
  const auto lateness = [&](const Origin* origin) {
    if (origin->source.starts_with("--set ")) return 2;
    return origin->source.empty() || origin->source == of_block.source ? 0 : 1;
  };
  return **std::max_element(origins.begin(), origins.end(),
                            [&](auto* a, auto* b) { return lateness(a) < lateness(b); });
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

void FailRule(const Node& block, std::string_view path, const std::invalid_argument& broken,
              const std::string& proposal) {
  std::vector<const Origin*> origins = OriginsNamed(broken.what(), block);
  if (origins.empty()) CollectOrigins(block, origins);
  Node at_fault;
  at_fault.origin = Latest(origins, block.origin);
  std::set<std::string> others;
  for (const Origin* origin : origins) others.insert(origin->source);
  others.erase(at_fault.origin.source);
  others.erase("");
  throw Error(fmt::format(
      "{}{}{}{}", Prefix(at_fault, path), broken.what(),
      proposal.empty() ? "" : fmt::format("; did you mean '{}'?", proposal),
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
