#pragma once

#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// A heightfield in the place of the ground, about the origin; black lies `height_m` below white.
inline TerrainOptions HeightfieldOptions(double width_m, double height_m) {
  TerrainOptions options;
  SurfaceOptions& surface = options.surfaces["ground"];
  surface.shape = Shape::kHeightfield;
  surface.image = "slope.png";
  surface.image_width_m = width_m;
  surface.image_height_m = height_m;
  return options;
}

}  // namespace rift::simulation
