#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  double unevenness = 0.0;
};

struct SurfaceOptions {
  Shape shape = Shape::kFlat;
  double mu = 0.8;
  double rolling_resistance = 0.0;
  double slip = 0.0;
  double caster_factor = 1.0;
  double unevenness = 0.0;
  std::optional<double> host_period_s;
  double tracker_noise = 1.0;
  double mirrored_share = 1.0;
  double mirrored_runs = 1.0;
  double session_mismatch = 0.0;
  double ramp_rad = 0.255;
  double ramp_top_m = 0.24;
  double ramp_edge_x_m = 0.05;
  double ramp_bend_m = 0.0;
  double ramp_plateau_rad = 0.0;
  double ramp_turn_rad = 0.0;
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
    field(
        "unevenness", self.unevenness, 0.0, 1.0,
        "scatter of the way a wheel makes for each way its rim turns, over some millimetres, as a "
        "share: dust, fibres, a tyre that is not round; it turns the robot at random");
    field("host_period_s", self.host_period_s, 0.005, 2.0,
          "mocap.host_period_s in the session on this surface; none: that of mocap; nothing where "
          "mocap has none");
    field("tracker_noise", self.tracker_noise, 0.0, 20.0,
          "scatter of the measured pose in the session on this surface, as a multiple of that of "
          "mocap: light, distance from the camera");
    field(
        "mirrored_share", self.mirrored_share, 0.0, 1.0,
        "mocap.ambiguity.share in the session on this surface, as a share of that of mocap (logs: "
        "0.36 of the pictures on ground in its runs that have any, 0.44 to 0.46 elsewhere)");
    field("mirrored_runs", self.mirrored_runs, 0.0, 1.0,
          "mocap.ambiguity.runs in the session on this surface, as a share of that of mocap");
    field("session_mismatch", self.session_mismatch, -0.5, 0.5,
          "motor.mismatch in the session on this surface less motor.mismatch: another battery, "
          "cleaned wheels");
    field("ramp_rad", self.ramp_rad, 0.001, 0.7,
          "inclination of the board in rad (z in the downhill logs; authors' world: 0.2404)");
    field("ramp_top_m", self.ramp_top_m, 0.0, 2.0,
          "height of the plateau above the floor in m, at its edge (z in the downhill logs: 0.24)");
    field("ramp_edge_x_m", self.ramp_edge_x_m, -10.0, 10.0,
          "x at which plateau and slope meet at y = 0, in m (z of the logs, axle: downhill 0.05, "
          "uphill "
          "0.31)");
    field("ramp_bend_m", self.ramp_bend_m, 0.0, 1.0,
          "length across the edge over which plateau turns into slope, evenly, the edge in its "
          "middle, in m; 0: "
          "a sharp edge (downhill, z beside that on flat ground: 0.22)");
    field("ramp_plateau_rad", self.ramp_plateau_rad, 0.0, 0.5,
          "inclination of the plateau in rad: it rises towards the slope (z and pitch in the "
          "downhill logs: 0.03 to 0.15)");
    field(
        "ramp_turn_rad", self.ramp_turn_rad, -1.5, 1.5,
        "angle from the x axis towards the y axis by which the board is turned, about its edge at "
        "y = 0, in rad (roll on the slope of the downhill logs: 0.24; z there: 0)");
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

  Grip GripOf() const { return {mu, rolling_resistance, slip, caster_factor, unevenness}; }
};

/// The surfaces of the paper by name: ground, cardboard, parchment, wet_parchment, uphill, downhill
/// and bump.
std::map<std::string, SurfaceOptions> PaperSurfaces();

/// A rectangle of the world with a grip of its own.
struct PatchOptions {
  double x_min_m = 0.0;
  double x_max_m = 0.1;
  double y_min_m = 0.0;
  double y_max_m = 0.1;
  double mu = 0.4;
  double rolling_resistance = 0.0;
  double slip = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("x_min_m", self.x_min_m, -100.0, 100.0, "left edge in m");
    field("x_max_m", self.x_max_m, -100.0, 100.0, "right edge in m");
    field("y_min_m", self.y_min_m, -100.0, 100.0, "lower edge in m");
    field("y_max_m", self.y_max_m, -100.0, 100.0, "upper edge in m");
    field("mu", self.mu, 0.0, 5.0, "friction coefficient of tyre on patch, no unit");
    field("rolling_resistance", self.rolling_resistance, 0.0, 0.5,
          "resistance to rolling as a share of the load on the wheel");
    field("slip", self.slip, 0.0, 0.5,
          "creep of a wheel at the limit of its friction, as a share of its speed");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  bool Covers(double x_m, double y_m) const {
    return x_m >= x_min_m && x_m <= x_max_m && y_m >= y_min_m && y_m <= y_max_m;
  }
};

struct TerrainOptions {
  std::string surface = "ground";
  std::map<std::string, SurfaceOptions> surfaces = PaperSurfaces();
  std::vector<PatchOptions> patches;
  std::optional<double> table_half_size_m;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("surface", self.surface,
          "name of the surface the robot drives on: ground, cardboard, parchment, wet_parchment, "
          "uphill, downhill, bump, or one of your own under surfaces");
    field("surfaces", self.surfaces, "the surfaces there are, by name");
    field("patches", self.patches, "rectangles with a grip of their own; the last one counts");
    field("table_half_size_m", self.table_half_size_m, 0.1, 100.0,
          "the ground ends at this |x| or |y| in m, and a robot falls off; none: it never ends");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  const SurfaceOptions& Chosen() const;
  /// The name that has to be one of Choices(), the names of `surfaces`; for proposals.
  std::string Choice() const { return surface; }
  std::vector<std::string> Choices() const;
};

/// A decoded image: samples[row * columns + column] in [0, 1], row 0 at the top, hence at large y.
struct HeightImage {
  int columns = 0;
  int rows = 0;
  std::vector<double> samples;
};

/// A square block that stands on the floor, its sides along x and y.
struct Block {
  double x_m = 0.0;  ///< of its middle
  double y_m = 0.0;
  double half_size_m = 0.0;
  double height_m = 0.0;
};

/// Points p with normal . (p - point) = 0; the ground lies below.
struct Plane {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;
};

/// The ground as a function of x and y in the world frame; heights in m above the floor.
class Terrain {
 public:
  /// Throws std::invalid_argument when the chosen surface is a heightfield and there is no image.
  explicit Terrain(const TerrainOptions& options,
                   std::shared_ptr<const HeightImage> image = nullptr);

  /// -infinity beyond the edge of the table.
  double HeightAt(double x_m, double y_m) const;
  /// Unit normal, upwards.
  Eigen::Vector3d NormalAt(double x_m, double y_m) const;
  Grip GripAt(double x_m, double y_m) const;
  /// The ground when it is one plane everywhere within `reach_m` of the point; a table ends at that
  /// distance in x or in y.
  std::optional<Plane> PlaneNear(double x_m, double y_m, double reach_m) const;
  /// The blocks that reach into a square of half this size about the point; none for a ground
  /// without blocks, where a table ends there, and where more than 8 of them stand in a row.
  std::optional<std::vector<Block>> BlocksNear(double x_m, double y_m, double reach_m) const;
  /// Whether height changes in steps all over the ground (bumps), so that it has no useful slope
  /// there.
  bool IsStepped() const { return surface_.shape == Shape::kBumps; }

 private:
  bool IsRamp() const {
    return surface_.shape == Shape::kRampUp || surface_.shape == Shape::kRampDown;
  }
  bool OnTable(double x_m, double y_m, double margin_m) const;
  /// How far downhill of the edge between plateau and slope a point lies, in m.
  double PastEdge(double x_m, double y_m) const;
  double RampHeight(double past_edge_m) const;
  double BumpHeight(double x_m, double y_m) const;
  double ImageHeight(double x_m, double y_m) const;

  SurfaceOptions surface_;
  Eigen::Vector2d downhill_;  ///< unit vector, in x and y
  std::vector<PatchOptions> patches_;
  double table_half_size_m_;
  std::shared_ptr<const HeightImage> image_;
};

/// Decodes the bytes of a PNG of any colour type, 8 or 16 bits deep, as samples from black 0 to
/// white 1; grey stays as it is, a colour counts by its luminance. Throws std::runtime_error when
/// they are no PNG; the caller knows whose they are.
HeightImage DecodeHeightImage(std::string_view png_bytes);

}  // namespace rift::simulation
