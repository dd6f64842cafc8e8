// The picture of a heightfield.
#include <stdexcept>

#include "fuzz.hpp"
#include "rift/simulation/terrain.hpp"

namespace {

/// Large pictures are refused or take long (docs/limits.md), which teaches nothing here.
bool IsSmall(std::string_view png) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
      value = value << 8U | static_cast<unsigned char>(png[i]);
    }
    return static_cast<double>(value);
  };
  return png.size() < 24 || number(16) * number(20) < 1 << 18;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rift;
  const std::string_view png = fuzz::TextOf(data, size);
  if (!IsSmall(png)) return 0;
  try {
    const simulation::HeightImage image = simulation::DecodeHeightImage(png);
    fuzz::Require(image.samples.size() == static_cast<std::size_t>(image.columns) * image.rows,
                  "a picture has a sample for each pixel");
    for (const double sample : image.samples) {
      fuzz::Require(sample >= 0.0 && sample <= 1.0, "samples are in [0, 1]");
    }
  } catch (const std::runtime_error& error) {
    fuzz::RequireOneLine(error.what());
  } catch (const std::invalid_argument& error) {
    fuzz::RequireOneLine(error.what());
  }
  return 0;
}
