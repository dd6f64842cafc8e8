#include "rift/simulation/surface.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace rift::simulation {
namespace {

// mu: the authors' Webots contact properties (rubber on parchment 0.4, ground 0.8, ramp board 0.7,
// bumps 0.85). Cardboard and wet parchment are not among them: cardboard is taken as ground, wet
// parchment a quarter below dry. Rolling resistance and slip are estimates for a small silicone
// tyre, to be replaced by values identified from logs.
SurfaceOptions Surface(Shape shape, double mu, double rolling_resistance, double slip) {
  SurfaceOptions surface;
  surface.shape = shape;
  surface.mu = mu;
  surface.rolling_resistance = rolling_resistance;
  surface.slip = slip;
  return surface;
}

}  // namespace

void SurfaceOptions::Check() const {
  if (shape == Shape::kHeightfield && image.empty()) {
    throw std::invalid_argument("image is empty, but a surface of shape heightfield needs a PNG");
  }
  if (bump_size_m > bump_pitch_m) {
    throw std::invalid_argument(
        fmt::format("bump_size_m is {}, but a block must not be wider than bump_pitch_m, {}",
                    bump_size_m, bump_pitch_m));
  }
}

std::map<std::string, SurfaceOptions> PaperSurfaces() {
  return {{"ground", Surface(Shape::kFlat, 0.8, 0.01, 0.01)},
          {"cardboard", Surface(Shape::kFlat, 0.8, 0.02, 0.01)},
          {"parchment", Surface(Shape::kFlat, 0.4, 0.01, 0.02)},
          {"wet_parchment", Surface(Shape::kFlat, 0.3, 0.02, 0.04)},
          {"uphill", Surface(Shape::kRampUp, 0.7, 0.01, 0.01)},
          {"downhill", Surface(Shape::kRampDown, 0.7, 0.01, 0.01)},
          {"bump", Surface(Shape::kBumps, 0.85, 0.02, 0.01)}};
}

}  // namespace rift::simulation
