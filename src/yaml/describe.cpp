#include "rift/yaml/describe.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "key_path.hpp"
#include "rift/yaml/error.hpp"
#include "rift/yaml/suggest.hpp"

namespace rift::yaml {
namespace {

constexpr std::size_t kMostCandidates = 8;

std::string Abridged(const std::vector<std::string>& keys) {
  const std::size_t shown = std::min(keys.size(), kMostCandidates);
  const auto middle = keys.begin() + static_cast<std::ptrdiff_t>(shown);
  std::string text = fmt::format("{}", fmt::join(keys.begin(), middle, ", "));
  if (shown < keys.size()) text += fmt::format(", and {} more", keys.size() - shown);
  return text;
}

/// Looks at whole keys first, then at what a person remembers of them: the last part.
std::string NearestKey(std::string_view name, const std::vector<std::string>& keys) {
  const std::string whole = Nearest(name, keys);
  if (!whole.empty()) return whole;
  std::vector<std::string> ends;
  for (const std::string& key : keys) ends.push_back(key.substr(key.rfind('.') + 1));
  const std::string end = Nearest(name, ends);
  if (end.empty()) return {};
  return keys[static_cast<std::size_t>(std::find(ends.begin(), ends.end(), end) - ends.begin())];
}

}  // namespace

std::string ResolveKey(std::string_view name, const std::vector<std::string>& keys) {
  if (!name.empty() && std::find(keys.begin(), keys.end(), name) != keys.end()) {
    return std::string(name);
  }
  std::vector<std::string> candidates;
  for (const std::string& key : keys) {
    if (!name.empty() && EndsAtPart(key, name)) candidates.push_back(key);
  }
  if (candidates.size() == 1) return candidates.front();
  if (candidates.size() > 1) {
    throw Error(fmt::format("key '{}' is short for {} keys: {}; write one of them in full", name,
                            candidates.size(), Abridged(candidates)));
  }
  throw Error(fmt::format("key '{}' is unknown; {}", name, KeyHint(name, keys)));
}

std::string KeyHint(std::string_view name, const std::vector<std::string>& keys) {
  const std::string nearest = NearestKey(name, keys);
  return nearest.empty() ? "known keys: " + Abridged(keys)
                         : fmt::format("did you mean '{}'?", nearest);
}

std::string ListTypeText(std::string_view item) {
  return item == "block" ? "list of blocks" : fmt::format("list, each {}", item);
}

std::string NumberTypeText(std::string_view noun, const std::optional<Range>& range) {
  return range ? fmt::format("{} {}", noun, RangeText(*range)) : std::string(noun);
}

}  // namespace rift::yaml
