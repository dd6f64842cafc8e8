#pragma once

#include <array>
#include <map>
#include <string>
#include <string_view>

namespace rift::simulation {

enum class Shape { kFlat, kRampUp, kRampDown, kBumps, kHeightfield };
constexpr std::array<std::string_view, 5> EnumNames(Shape) {
  return {"flat", "ramp_up", "ramp_down", "bumps", "heightfield"};
}

/// How a piece of ground holds a wheel.
struct Grip {
  double mu = 0.8;
  double rolling_resistance = 0.0;
  double slip = 0.0;
  double caster_factor = 1.0;
};

struct SurfaceOptions {
  Shape shape = Shape::kFlat;
  double mu = 0.8;
  double rolling_resistance = 0.0;
  double slip = 0.0;
  double caster_factor = 1.0;
  double ramp_rad = 0.2404;
  double ramp_top_m = 0.24;
  double ramp_edge_x_m = 0.05;
  double bump_size_m = 0.020;
  double bump_pitch_m = 0.060;
  double bump_height_m = 0.004;
  std::string image;
  double image_width_m = 1.0;
  double image_height_m = 0.02;
  double image_x_m = 0.0;
  double image_y_m = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("shape", self.shape,
          "flat, ramp_up (climbs towards +x to a plateau), ramp_down (plateau, then falls towards "
          "+x), bumps (a grid of square blocks), heightfield (a PNG)");
    field("mu", self.mu, 0.0, 5.0, "friction coefficient of tyre on ground, no unit");
    field("rolling_resistance", self.rolling_resistance, 0.0, 0.5,
          "resistance to rolling as a share of the load on the wheel");
    field("slip", self.slip, 0.0, 0.5,
          "creep of a wheel at the limit of its friction, as a share of its speed");
    field("caster_factor", self.caster_factor, 0.0, 20.0,
          "friction of the caster's ball here as a multiple of body.caster_mu");
    field("ramp_rad", self.ramp_rad, 0.001, 0.7,
          "inclination of the board in rad (z in the downhill logs: 0.2404)");
    field("ramp_top_m", self.ramp_top_m, 0.0, 2.0,
          "height of the plateau above the floor in m (z in the downhill logs: 0.24)");
    field("ramp_edge_x_m", self.ramp_edge_x_m, -10.0, 10.0,
          "x at which plateau and slope meet, in m (z in the downhill logs: 0.05)");
    field("bump_size_m", self.bump_size_m, 0.001, 1.0,
          "side of a block in m (paper's board: 0.02)");
    field("bump_pitch_m", self.bump_pitch_m, 0.002, 2.0,
          "from block to block in x and in y, in m (paper's board: 0.06)");
    field("bump_height_m", self.bump_height_m, 0.0, 0.1,
          "height of a block in m (paper's board: 0.004)");
    field("image", self.image, "PNG of the heightfield: black is the floor, white image_height_m");
    field("image_width_m", self.image_width_m, 0.01, 100.0,
          "extent of the image in x, in m; y follows from its shape, around it lies the floor");
    field("image_height_m", self.image_height_m, 0.0, 1.0, "height of white in m");
    field("image_x_m", self.image_x_m, -100.0, 100.0, "x of the image's centre in m");
    field("image_y_m", self.image_y_m, -100.0, 100.0, "y of the image's centre in m");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  Grip GripOf() const { return {mu, rolling_resistance, slip, caster_factor}; }
};

/// The surfaces of the paper by name: ground, cardboard, parchment, wet_parchment, uphill, downhill
/// and bump.
std::map<std::string, SurfaceOptions> PaperSurfaces();

}  // namespace rift::simulation
