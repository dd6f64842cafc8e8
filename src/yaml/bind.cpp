#include "rift/yaml/bind.hpp"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "key_path.hpp"
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
  const std::string nearest = Nearest(entry.key, known.here);
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

}  // namespace rift::yaml
