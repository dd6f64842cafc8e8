#include "rift/vision/tracking/tag_family.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace rift::vision {

void RequireTagId(int id, TagFamily family) {
  const int count = ShapeOf(family).ids;
  if (id >= 0 && id < count) return;
  throw std::invalid_argument(
      fmt::format("tag id {}: the family {} has the ids 0 to {}", id, NameOf(family), count - 1));
}

}  // namespace rift::vision
