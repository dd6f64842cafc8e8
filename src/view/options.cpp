#include "rift/view/options.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace rift::view {
namespace {

// H.264 in 4:2:0 keeps one colour for two by two pixels.
void CheckEven(const char* field, int value) {
  if (value % 2 == 0) return;
  throw std::invalid_argument(fmt::format("{} is {}, but it must be even", field, value));
}

}  // namespace

void ViewOptions::Check() const {
  CheckEven("width_px", width_px);
  CheckEven("height_px", height_px);
}

}  // namespace rift::view
