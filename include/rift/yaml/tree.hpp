#pragma once

#include <functional>
#include <string>
#include <vector>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Lays `over` over `base`: maps merge key by key at every level; anything else replaces. A block
/// keeps the origin of its first writer, each value that of its last.
void Merge(Node& base, const Node& over);

/// A map whose keys are all among min, max, scale and integer: a continuous axis of a parameter
/// space, not a block of further names.
bool IsContinuousAxis(const Node& node);

struct FlatEntry {
  std::string key;  ///< dotted
  Origin origin;    ///< of the last part of the key
  const Node* value = nullptr;
};

/// The leaves of a map under their dotted keys, in order, so that `space: {control: {v_min: ..}}`,
/// `space: {control.v_min: ..}` and `--set space.control.v_min=..` are one thing. A map is opened
/// unless it is empty or `is_leaf` says that it is a value. The entries point into `map`.
/// Throws Error when two ways of writing a key meet.
std::vector<FlatEntry> Flatten(const Node& map,
                               const std::function<bool(const Node&)>& is_leaf = IsContinuousAxis);

/// Opens keys with dots into nested maps, the inverse of Flatten: `{a.b: 1}` -> `{a: {b: 1}}`.
/// Throws Error when two ways of writing a key meet.
Node ExpandDottedKeys(const Node& map);

}  // namespace rift::yaml
