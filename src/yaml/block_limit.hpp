#pragma once

#include <cstddef>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Keys are found by walking the map, which is right for blocks that people write.
inline constexpr std::size_t kMostKeys = 10'000;

/// Throws Error for a block of more keys that begins at `origin`.
void RequireFewKeys(std::size_t keys, const Origin& origin);

}  // namespace rift::yaml
