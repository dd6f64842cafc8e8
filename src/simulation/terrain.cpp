#include "rift/simulation/terrain.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
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

Eigen::Vector2d Downhill(const SurfaceOptions& board) {
  const double sign = board.shape == Shape::kRampUp ? -1.0 : 1.0;
  return sign * Eigen::Vector2d(std::cos(board.ramp_turn_rad), std::sin(board.ramp_turn_rad));
}

constexpr double kEndless_m = std::numeric_limits<double>::infinity();
constexpr double kSlopeBase_m = 1e-4;
constexpr double kMostBlocks = 8.0;  // in a row: more are a texture, which heights alone tell

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
  SurfaceOptions uphill = Surface(Shape::kRampUp, 0.7, 0.01, 0.01);
  uphill.ramp_edge_x_m = 0.31;  // where the axle is when z of the uphill logs stops to rise
  return {{"ground", Surface(Shape::kFlat, 0.8, 0.01, 0.01)},
          {"cardboard", Surface(Shape::kFlat, 0.8, 0.02, 0.01)},
          {"parchment", Surface(Shape::kFlat, 0.4, 0.01, 0.02)},
          {"wet_parchment", Surface(Shape::kFlat, 0.3, 0.02, 0.04)},
          {"uphill", uphill},
          {"downhill", Surface(Shape::kRampDown, 0.7, 0.01, 0.01)},
          {"bump", Surface(Shape::kBumps, 0.85, 0.02, 0.01)}};
}

void PatchOptions::Check() const {
  if (x_min_m >= x_max_m) {
    throw std::invalid_argument(
        fmt::format("x_min_m is {}, but it must lie below x_max_m, {}", x_min_m, x_max_m));
  }
  if (y_min_m >= y_max_m) {
    throw std::invalid_argument(
        fmt::format("y_min_m is {}, but it must lie below y_max_m, {}", y_min_m, y_max_m));
  }
}

void TerrainOptions::Check() const { Chosen(); }

const SurfaceOptions& TerrainOptions::Chosen() const {
  const auto found = surfaces.find(surface);
  if (found != surfaces.end()) return found->second;
  throw std::invalid_argument(fmt::format("surface is '{}', but it must be one of: {}", surface,
                                          fmt::join(Choices(), ", ")));
}

std::vector<std::string> TerrainOptions::Choices() const {
  std::vector<std::string> names;
  for (const auto& [name, options] : surfaces) names.push_back(name);
  return names;
}

Terrain::Terrain(const TerrainOptions& options, std::shared_ptr<const HeightImage> image)
    : surface_(options.Chosen()),
      downhill_(Downhill(surface_)),
      patches_(options.patches),
      table_half_size_m_(options.table_half_size_m.value_or(kEndless_m)),
      image_(std::move(image)) {
  if (surface_.shape != Shape::kHeightfield) return;
  if (!image_ || image_->columns < 2 || image_->rows < 2 ||
      image_->samples.size() != static_cast<size_t>(image_->columns) * image_->rows) {
    throw std::invalid_argument(
        "surface '" + options.surface +
        "' is a heightfield, but no image of at least 2 x 2 pixels is given");
  }
}

double Terrain::HeightAt(double x_m, double y_m) const {
  if (!OnTable(x_m, y_m, 0.0)) return -kEndless_m;
  switch (surface_.shape) {
    case Shape::kFlat:
      return 0.0;
    case Shape::kRampUp:
    case Shape::kRampDown:
      return RampHeight(PastEdge(x_m, y_m));
    case Shape::kBumps:
      return BumpHeight(x_m, y_m);
    case Shape::kHeightfield:
      return ImageHeight(x_m, y_m);
  }
  return 0.0;
}

Eigen::Vector3d Terrain::NormalAt(double x_m, double y_m) const {
  if (surface_.shape == Shape::kFlat || !OnTable(x_m, y_m, 2.0 * kSlopeBase_m)) {
    return Eigen::Vector3d::UnitZ();
  }
  const auto slope = [](double before_m, double after_m) {
    return (after_m - before_m) / (2.0 * kSlopeBase_m);
  };
  Eigen::Vector2d rise;
  if (IsRamp()) {  // along its fall line, so that a turned board is the same board
    const double past_edge_m = PastEdge(x_m, y_m);
    rise = downhill_ *
           slope(RampHeight(past_edge_m - kSlopeBase_m), RampHeight(past_edge_m + kSlopeBase_m));
  } else {
    rise = {slope(HeightAt(x_m - kSlopeBase_m, y_m), HeightAt(x_m + kSlopeBase_m, y_m)),
            slope(HeightAt(x_m, y_m - kSlopeBase_m), HeightAt(x_m, y_m + kSlopeBase_m))};
  }
  return Eigen::Vector3d(-rise.x(), -rise.y(), 1.0).normalized();
}

Grip Terrain::GripAt(double x_m, double y_m) const {
  for (auto patch = patches_.rbegin(); patch != patches_.rend(); ++patch) {
    if (patch->Covers(x_m, y_m)) {
      return {patch->mu, patch->rolling_resistance, patch->slip, 1.0, surface_.unevenness};
    }
  }
  return surface_.GripOf();
}

std::optional<Plane> Terrain::PlaneNear(double x_m, double y_m, double reach_m) const {
  if (!OnTable(x_m, y_m, reach_m)) return std::nullopt;
  if (surface_.shape == Shape::kFlat) {
    return Plane{{x_m, y_m, 0.0}, Eigen::Vector3d::UnitZ()};
  }
  if (!IsRamp()) return std::nullopt;
  const double past_edge_m = PastEdge(x_m, y_m);
  const double bend_m = 0.5 * surface_.ramp_bend_m;
  const double foot_m = surface_.ramp_top_m / std::tan(surface_.ramp_rad);
  const double back_m = surface_.ramp_plateau_rad > 0.0
                            ? surface_.ramp_top_m / std::tan(surface_.ramp_plateau_rad)
                            : kEndless_m;
  const bool sloped = past_edge_m > bend_m + reach_m && past_edge_m < foot_m - reach_m;
  const bool plateau = past_edge_m < -bend_m - reach_m && past_edge_m > reach_m - back_m;
  const bool floor = past_edge_m > foot_m + reach_m || past_edge_m < -back_m - reach_m;
  if (!sloped && !plateau && !floor) return std::nullopt;
  const double fall_rad = floor ? 0.0 : sloped ? surface_.ramp_rad : -surface_.ramp_plateau_rad;
  const Eigen::Vector2d level = std::sin(fall_rad) * downhill_;
  return Plane{{x_m, y_m, RampHeight(past_edge_m)}, {level.x(), level.y(), std::cos(fall_rad)}};
}

std::optional<std::vector<Block>> Terrain::BlocksNear(double x_m, double y_m,
                                                      double reach_m) const {
  if (surface_.shape != Shape::kBumps || !OnTable(x_m, y_m, reach_m)) return std::nullopt;
  const double pitch_m = surface_.bump_pitch_m, half_m = 0.5 * surface_.bump_size_m;
  if (2.0 * (reach_m + half_m) > kMostBlocks * pitch_m) return std::nullopt;
  const auto first = [&](double p_m) {
    return std::lround(std::ceil((p_m - reach_m - half_m) / pitch_m));
  };
  const auto last = [&](double p_m) {
    return std::lround(std::floor((p_m + reach_m + half_m) / pitch_m));
  };
  std::vector<Block> blocks;
  for (long i = first(x_m); i <= last(x_m); ++i) {
    for (long j = first(y_m); j <= last(y_m); ++j) {
      blocks.push_back({static_cast<double>(i) * pitch_m, static_cast<double>(j) * pitch_m, half_m,
                        surface_.bump_height_m});
    }
  }
  return blocks;
}

bool Terrain::OnTable(double x_m, double y_m, double margin_m) const {
  return std::max(std::abs(x_m), std::abs(y_m)) + margin_m <= table_half_size_m_;
}

double Terrain::PastEdge(double x_m, double y_m) const {
  return downhill_.dot(Eigen::Vector2d(x_m - surface_.ramp_edge_x_m, y_m));
}

double Terrain::RampHeight(double past_edge_m) const {
  const double fall = std::tan(surface_.ramp_rad), rise = std::tan(surface_.ramp_plateau_rad);
  const double into_bend_m = past_edge_m + 0.5 * surface_.ramp_bend_m;
  double height_m = surface_.ramp_top_m + past_edge_m * (past_edge_m < 0.0 ? rise : -fall);
  if (into_bend_m > 0.0 && into_bend_m < surface_.ramp_bend_m) {
    height_m = surface_.ramp_top_m + past_edge_m * rise -
               0.5 * (fall + rise) * into_bend_m * into_bend_m / surface_.ramp_bend_m;
  }
  return std::max(0.0, height_m);
}

double Terrain::BumpHeight(double x_m, double y_m) const {
  const auto on_block = [this](double p_m) {
    return std::abs(std::remainder(p_m, surface_.bump_pitch_m)) <= 0.5 * surface_.bump_size_m;
  };
  return on_block(x_m) && on_block(y_m) ? surface_.bump_height_m : 0.0;
}

double Terrain::ImageHeight(double x_m, double y_m) const {
  const double pixel_m = surface_.image_width_m / (image_->columns - 1);
  const double column = (x_m - surface_.image_x_m) / pixel_m + 0.5 * (image_->columns - 1);
  const double row = (surface_.image_y_m - y_m) / pixel_m + 0.5 * (image_->rows - 1);
  if (!(column >= 0.0 && column <= image_->columns - 1 && row >= 0.0 && row <= image_->rows - 1)) {
    return 0.0;
  }
  const int left = std::min(static_cast<int>(column), image_->columns - 2);
  const int top = std::min(static_cast<int>(row), image_->rows - 2);
  const double right_share = column - left, bottom_share = row - top;
  const double* corner = &image_->samples[static_cast<size_t>(top) * image_->columns + left];
  const double upper = corner[0] + right_share * (corner[1] - corner[0]);
  const double* below = corner + image_->columns;
  const double lower = below[0] + right_share * (below[1] - below[0]);
  return surface_.image_height_m * (upper + bottom_share * (lower - upper));
}

}  // namespace rift::simulation
