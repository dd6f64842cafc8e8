#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rift::yaml {

/// Insertions, deletions, substitutions and swaps of neighbours that turn `a` into `b`; letter
/// case and `-` for `_` cost nothing (restricted Damerau-Levenshtein).
int EditDistance(std::string_view a, std::string_view b);

/// The candidate a person most likely meant: within one edit for every three letters, or `name`
/// without its unit (`period` -> `period_s`). Empty when nothing is near.
std::string Nearest(std::string_view name, const std::vector<std::string>& candidates);

/// `; did you mean 'v_min'?`, or `; <otherwise>: a, b, c` when nothing is near.
std::string Suggestion(std::string_view name, const std::vector<std::string>& candidates,
                       std::string_view otherwise);

/// The full key for a full key or for the end of one, when there is only one such: `v_min` ->
/// `control.v_min`. Throws Error naming the candidates when there are several, the nearest key when
/// there is none.
std::string ResolveKey(std::string_view name, const std::vector<std::string>& keys);

/// `did you mean 'gap.samples'?`, or the first known keys when none is near.
std::string KeyHint(std::string_view name, const std::vector<std::string>& keys);

}  // namespace rift::yaml
