#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rift/yaml/fields.hpp"
#include "rift/yaml/node.hpp"

/// The parts of binding that need no template.
namespace rift::yaml {

/// The keys that a block knows, and where to look for one that was written in the wrong block.
struct KnownKeys {
  std::vector<std::string> here;
  const std::vector<std::string>& anywhere;  ///< full dotted keys
};

/// Throw Error unless the node is of that kind.
void RequireMap(const Node& node, const Place& place);
void RequireList(const Node& node, const Place& place);

/// Throws Error for an unknown key: names the nearest known one, here or elsewhere, or all here.
[[noreturn]] void FailUnknown(const Node::Entry& entry, std::string_view path,
                              const KnownKeys& known);
/// Throws Error when a key that must be written is not.
void RequireKey(const Node& block, std::string_view path, std::string_view key);

/// Throws Error for a rule between fields: where the block stands, its key, and the other places
/// that values of it came from.
[[noreturn]] void FailRule(const Node& block, std::string_view path,
                           const std::invalid_argument& broken);

/// Runs the block's own rules, if it has any. `node` is where the block was written.
template <class S>
void CheckRules(const S& block, const Node& node, std::string_view path) {
  if constexpr (Checked<S>) {
    try {
      block.Check();
    } catch (const std::invalid_argument& broken) {
      FailRule(node, path, broken);
    }
  }
}

}  // namespace rift::yaml
