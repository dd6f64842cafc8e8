#include "stage.hpp"

#include <algorithm>
#include <cmath>

namespace rift::view {
namespace {

constexpr int kMostCells = 1200;  // a side; more than a window has pixels

struct Box {
  Eigen::Vector2d low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};

  void Cover(const Eigen::Vector2d& p_m) {
    if (!p_m.allFinite()) return;
    low = low.cwiseMin(p_m);
    high = high.cwiseMax(p_m);
  }
};

Box ShownFloor(const Run& run, double margin_m) {
  Box box;
  for (const geometry::NamedPoint& place : run.waypoints) box.Cover(place.p_in_world_m);
  for (const Eigen::Vector2d& p_m : run.reference_m) box.Cover(p_m);
  for (const trajectory::StampedPose& pose : run.truth.poses) box.Cover(pose.Position());
  const Eigen::Vector2d margin = Eigen::Vector2d::Constant(margin_m + run.body.chassis_radius_m);
  return {box.low - margin, box.high + margin};
}

Ground Sample(const Run& run, const Box& box, double finest_m) {
  const Eigen::Vector2d extent_m = box.high - box.low;
  Ground ground;
  ground.x_min_m = box.low.x();
  ground.y_min_m = box.low.y();
  ground.cell_m = std::max(finest_m, extent_m.maxCoeff() / kMostCells);
  ground.columns = static_cast<int>(std::ceil(extent_m.x() / ground.cell_m)) + 1;
  ground.rows = static_cast<int>(std::ceil(extent_m.y() / ground.cell_m)) + 1;
  ground.height_m.assign(static_cast<size_t>(ground.columns) * ground.rows, 0.0F);
  if (!run.height_at) return ground;
  for (int row = 0; row < ground.rows; ++row) {
    for (int column = 0; column < ground.columns; ++column) {
      const double x_m = ground.x_min_m + column * ground.cell_m;
      const double y_m = ground.y_min_m + row * ground.cell_m;
      ground.height_m[static_cast<size_t>(row) * ground.columns + column] =
          static_cast<float>(run.height_at(x_m, y_m));
    }
  }
  return ground;
}

double Top_m(const Run& run, const Ground& ground) {
  double top_m = 0.0;
  for (const float height_m : ground.height_m) top_m = std::max(top_m, double{height_m});
  const BodyShape& body = run.body;
  return top_m + body.wheel_radius_m + body.chassis_bottom_m + body.chassis_height_m +
         body.chassis_radius_m;
}

}  // namespace

Stage MakeStage(const Run& run, const ViewOptions& options) {
  Stage stage;
  stage.title = run.title;
  stage.ground = Sample(run, ShownFloor(run, options.margin_m), options.ground_cell_m);
  stage.top_m = Top_m(run, stage.ground);
  stage.waypoints = run.waypoints;
  stage.reference_m = run.reference_m;
  stage.patches = run.patches;
  stage.body = run.body;
  for (const trajectory::StampedPose& pose : Trail(run).poses) {
    stage.trail_m.push_back(pose.Position());
  }
  return stage;
}

}  // namespace rift::view
