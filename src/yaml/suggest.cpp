#include "rift/yaml/suggest.hpp"

#include <algorithm>
#include <cctype>
#include <limits>

#include <fmt/format.h>

#include "rift/yaml/bind.hpp"
#include "rift/yaml/node.hpp"

namespace rift::yaml {
namespace {

char Fold(char c) {
  return c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

// A length difference costs at least as many edits, so a long garbage key never fills the table.
bool CanBeWithin(std::size_t limit, std::string_view a, std::string_view b) {
  return std::max(a.size(), b.size()) - std::min(a.size(), b.size()) <= limit;
}

bool LacksOnlyUnit(std::string_view name, std::string_view candidate) {
  return candidate.size() > name.size() + 1 && candidate.substr(0, name.size()) == name &&
         candidate[name.size()] == '_';
}

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

int EditDistance(std::string_view a, std::string_view b) {
  std::vector<int> before, last(b.size() + 1), now(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    now[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = Fold(a[i - 1]) == Fold(b[j - 1]);
      now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && Fold(a[i - 1]) == Fold(b[j - 2]) && Fold(a[i - 2]) == Fold(b[j - 1]);
      if (swapped) now[j] = std::min(now[j], before[j - 2] + 1);
    }
    before = last;
    last = now;
  }
  return last[b.size()];
}

std::string Nearest(std::string_view name, const std::vector<std::string>& candidates) {
  int best = std::numeric_limits<int>::max();
  std::string nearest;
  for (const std::string& candidate : candidates) {
    const std::size_t limit = std::max<std::size_t>(1, std::min(name.size(), candidate.size()) / 3);
    int distance = std::numeric_limits<int>::max();
    if (LacksOnlyUnit(name, candidate)) distance = 1;
    if (CanBeWithin(limit, name, candidate)) {
      const int edits = EditDistance(name, candidate);
      const bool keeps_a_letter = edits < static_cast<int>(candidate.size());
      if (edits <= static_cast<int>(limit) && keeps_a_letter) distance = std::min(distance, edits);
    }
    if (distance < best) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string Suggestion(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view otherwise) {
  const std::string nearest = Nearest(name, candidates);
  if (!nearest.empty()) return fmt::format("; did you mean '{}'?", nearest);
  return fmt::format("; {}: {}", otherwise, fmt::join(candidates, ", "));
}

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

}  // namespace rift::yaml
