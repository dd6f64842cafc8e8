#include "rift/sweep/run/content_hash.hpp"

#include "rift/statistics/hash.hpp"

namespace rift::sweep {

std::string ContentHash(std::string_view bytes) { return statistics::Hash128Text(bytes); }

}  // namespace rift::sweep
