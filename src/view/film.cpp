#include "rift/view/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

BodyShape ShapeOf(const simulation::BodyOptions& body) {
  return {.chassis_radius_m = body.chassis_radius_m,
          .chassis_height_m = body.chassis_height_m,
          .chassis_bottom_m = body.rim_clearance_m - body.wheel_radius_m,
          .wheel_radius_m = body.wheel_radius_m,
          .wheel_width_m = body.wheel_width_m,
          .track_m = body.track_m};
}

void ShowTask(Run& shown, const control::Task& task) {
  for (const control::Waypoint& waypoint : task.waypoints) {
    shown.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  for (const control::TimedPose& at : task.IdealPath()) {
    shown.reference_m.push_back(at.world_from_robot.Position());
  }
}

namespace {

// H.264 in 4:2:0 keeps one colour for two by two pixels.
void CheckEven(const char* field, int value) {
  if (value % 2 == 0) return;
  throw std::invalid_argument(fmt::format("{} is {}, but it must be even", field, value));
}

/// The poses whose positions are the trail: those measured, else the true ones.
const trajectory::Trajectory& Trail(const Run& run) {
  return run.logged.poses.empty() ? run.truth : run.logged;
}

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

/// The ground around everything that is shown, and what lies on it.
StaticScene MakeStaticScene(const Run& run, const ViewOptions& options) {
  StaticScene fixed;
  fixed.title = run.title;
  fixed.ground = Sample(run, ShownFloor(run, options.margin_m), options.ground_cell_m);
  fixed.top_m = Top_m(run, fixed.ground);
  fixed.waypoints = run.waypoints;
  fixed.reference_m = run.reference_m;
  fixed.patches = run.patches;
  fixed.body = run.body;
  for (const trajectory::StampedPose& pose : Trail(run).poses) {
    fixed.trail_m.push_back(pose.Position());
  }
  return fixed;
}

using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr double kMostPictures = 100'000;
constexpr double kSamePlace_m = 1e-6;

void Check(const Run& run) {
  if (run.truth.poses.empty()) throw std::invalid_argument("a film needs at least one true pose");
  for (const StampedPose& pose : run.truth.poses) {
    if (pose.Planar().IsFinite()) continue;
    throw std::invalid_argument(fmt::format(
        "a film needs the place and yaw of every true pose, but at {} s they are ({}, {}, {})",
        pose.t_s, pose.x_m, pose.y_m, pose.yaw_rad));
  }
}

// The newest row at this time or before; -1 when there is none yet.
int RowAt(const Trajectory& log, double t_s) {
  const auto after =
      std::upper_bound(log.poses.begin(), log.poses.end(), t_s,
                       [](double time_s, const StampedPose& pose) { return time_s < pose.t_s; });
  return static_cast<int>(after - log.poses.begin()) - 1;
}

double ChannelAt(const Trajectory& log, std::string_view name, int row) {
  for (const trajectory::Channel& channel : log.channels) {
    if (channel.name == name && row >= 0 && row < static_cast<int>(channel.values.size())) {
      return channel.values[row];
    }
  }
  return Scene::kUnknown;
}

double PowerAt(const Run& run, std::string_view name, double t_s) {
  const double held = ChannelAt(run.truth, name, RowAt(run.truth, t_s));
  return std::isfinite(held) ? held : ChannelAt(run.logged, name, RowAt(run.logged, t_s));
}

int TargetAt(const Run& run, double t_s) {
  const int row = RowAt(run.logged, t_s);
  if (row < 0) return -1;
  const StampedPose& pose = run.logged.poses[row];
  const Eigen::Vector2d target_m(pose.target_x_m, pose.target_y_m);
  const auto place =
      std::find_if(run.waypoints.begin(), run.waypoints.end(), [&](const geometry::NamedPoint& p) {
        return (p.p_in_world_m - target_m).norm() <= kSamePlace_m;
      });
  return place == run.waypoints.end() ? -1 : static_cast<int>(place - run.waypoints.begin());
}

double OrZero(double angle_rad) { return std::isfinite(angle_rad) ? angle_rad : 0.0; }

// Axle height: as known, else with the wheels on the ground.
double AxleHeight_m(const Run& run, const StampedPose& pose) {
  if (std::isfinite(pose.z_m)) return pose.z_m;
  const double ground_m = run.height_at ? run.height_at(pose.x_m, pose.y_m) : 0.0;
  return (std::isfinite(ground_m) ? ground_m : 0.0) + run.body.wheel_radius_m;
}

double Speed_mps(const Run& run, const StampedPose& a, const StampedPose& b) {
  if (!(b.t_s > a.t_s)) return Scene::kUnknown;
  const double climb_m = AxleHeight_m(run, b) - AxleHeight_m(run, a);
  return std::hypot(b.x_m - a.x_m, b.y_m - a.y_m, climb_m) / (b.t_s - a.t_s);
}

}  // namespace

void ViewOptions::Check() const {
  CheckEven("width_px", width_px);
  CheckEven("height_px", height_px);
}

Scene SceneAt(const Run& run, double t_s) {
  const auto& poses = run.truth.poses;
  const double at_s = poses.front().t_s + t_s;
  const int last = static_cast<int>(poses.size()) - 1;
  const int before = std::clamp(RowAt(run.truth, at_s), 0, std::max(last - 1, 0));
  const StampedPose& a = poses[before];
  const StampedPose& b = poses[std::min(before + 1, last)];
  const double share = b.t_s > a.t_s ? std::clamp((at_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0) : 0.0;
  const auto between = [share](double from, double to) { return from + share * (to - from); };
  const double turn_rad = geometry::WrapToPi(b.yaw_rad - a.yaw_rad);
  Scene scene;
  scene.t_s = t_s;
  scene.world_from_robot = {between(a.x_m, b.x_m), between(a.y_m, b.y_m),
                            geometry::WrapToPi(a.yaw_rad + share * turn_rad)};
  scene.z_m = between(AxleHeight_m(run, a), AxleHeight_m(run, b));
  scene.roll_rad = between(OrZero(a.roll_rad), OrZero(b.roll_rad));
  scene.pitch_rad = between(OrZero(a.pitch_rad), OrZero(b.pitch_rad));
  scene.speed_mps = Speed_mps(run, a, b);
  scene.power = {PowerAt(run, "power_left", at_s), PowerAt(run, "power_right", at_s)};
  scene.target = TargetAt(run, at_s);
  scene.trail_points = static_cast<size_t>(RowAt(Trail(run), at_s)) + 1;
  return scene;
}

Film MakeFilm(const Run& run, const ViewOptions& options) {
  options.Check();
  Check(run);
  const double duration_s = run.truth.poses.back().t_s - run.truth.poses.front().t_s;
  const double count = std::max(1.0, std::round(duration_s * options.fps));
  if (count > kMostPictures) {
    throw std::invalid_argument(
        fmt::format("a film of {} s at {} pictures a second has {} pictures, but at most {} are "
                    "possible: lower fps",
                    duration_s, options.fps, count, kMostPictures));
  }
  Film film{MakeStaticScene(run, options), {}, static_cast<double>(options.fps)};
  for (int i = 0; i + 1 < static_cast<int>(count); ++i) {
    film.scenes.push_back(SceneAt(run, i / film.fps));
  }
  film.scenes.push_back(SceneAt(run, duration_s));
  film.scenes.back().outcome = run.outcome.empty() ? "ended" : run.outcome;
  return film;
}

namespace {

// X11 key symbols (keysymdef.h); OpenCV's Qt and GTK windows both hand these on.
enum Key { kEscape = 27, kSpace = 32, kLeft = 0xFF51, kUp, kRight, kDown };
constexpr double kSlowest = 1.0 / 32.0;
constexpr double kFastest = 64.0;

}  // namespace

Playback AfterKey(Playback playback, int key) {
  if (key == 'q' || key == 'Q' || key == kEscape) playback.left = true;
  if (key == kSpace) playback.paused = !playback.paused;
  if (key == 'r' || key == 'R') {
    playback.t_s = playback.over_since_s = 0.0;
    playback.paused = false;
  }
  if (key == kUp || key == kRight) playback.speed = std::min(2.0 * playback.speed, kFastest);
  if (key == kDown || key == kLeft) playback.speed = std::max(0.5 * playback.speed, kSlowest);
  return playback;
}

Playback AfterTime(Playback playback, double dt_s, double duration_s) {
  if (playback.paused) return playback;
  if (playback.t_s >= duration_s) playback.over_since_s += dt_s;
  playback.t_s = std::min(playback.t_s + dt_s * playback.speed, duration_s);
  return playback;
}

}  // namespace rift::view
