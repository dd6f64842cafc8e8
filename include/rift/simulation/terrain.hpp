#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rift/simulation/surface.hpp"

namespace rift::simulation {

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
    field("surface", self.surface, "name of the surface the robot drives on");
    field("surfaces", self.surfaces, "the surfaces there are, by name");
    field("patches", self.patches, "rectangles with a grip of their own; the last one counts");
    field("table_half_size_m", self.table_half_size_m, 0.1, 100.0,
          "the ground ends at this |x| or |y| in m, and a robot falls off; none: it never ends");
  }
  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;

  const SurfaceOptions& Chosen() const;
};

/// A decoded image: samples[row * columns + column] in [0, 1], row 0 at the top, hence at large y.
struct HeightImage {
  int columns = 0;
  int rows = 0;
  std::vector<double> samples;
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
  /// The ground when it is one plane everywhere within `reach_m` of the point in x and in y.
  std::optional<Plane> PlaneNear(double x_m, double y_m, double reach_m) const;
  /// Whether height changes in steps (bumps, edge of a table), so that it has no useful slope
  /// there.
  bool IsStepped() const { return surface_.shape == Shape::kBumps; }

 private:
  bool OnTable(double x_m, double y_m, double margin_m) const;
  double RampHeight(double x_m) const;
  double BumpHeight(double x_m, double y_m) const;
  double ImageHeight(double x_m, double y_m) const;

  SurfaceOptions surface_;
  std::vector<PatchOptions> patches_;
  double table_half_size_m_;
  std::shared_ptr<const HeightImage> image_;
};

}  // namespace rift::simulation
