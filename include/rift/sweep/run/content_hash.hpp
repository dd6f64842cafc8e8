#pragma once

#include <string>
#include <string_view>

namespace rift::sweep {

/// 128-bit XXH3 in hexadecimal, as `xxhsum -H2` prints it: changed inputs show.
std::string ContentHash(std::string_view bytes);

}  // namespace rift::sweep
