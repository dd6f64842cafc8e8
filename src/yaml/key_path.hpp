#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// `a.b.c` -> a, b, c; nothing when a part is empty (then the key is no path).
std::vector<std::string> SplitPath(std::string_view key);

/// True when `key` is `<something>.<end>`.
bool EndsAtPart(std::string_view key, std::string_view end);

/// Adds an entry to a map; dots in its key open nested maps, which join those already there.
/// `path` is that of the map, for messages. Throws Error when a value is already there.
void AddAtPath(Node& map, Node::Entry entry, const std::string& path);

/// The same for a key taken as it is, dots and all.
void AddLiteral(Node& map, Node::Entry entry, const std::string& path);

[[noreturn]] void FailDuplicate(std::string_view key, const Origin& first, const Origin& second);

}  // namespace rift::yaml
