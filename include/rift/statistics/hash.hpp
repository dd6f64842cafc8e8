#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace rift::statistics {

/// XXH3 (xxHash) of bytes: equal bytes give equal hashes, in every version and on every platform of
/// the same byte order.
std::uint64_t Hash64(std::span<const std::byte> bytes);

/// 128 bits in hexadecimal, as `xxhsum -H2` prints them.
std::string Hash128Text(std::string_view bytes);

}  // namespace rift::statistics
