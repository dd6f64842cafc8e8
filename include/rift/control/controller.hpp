#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/control/options.hpp"
#include "rift/control/pose_filter.hpp"
#include "rift/control/program.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/geometry/pose2.hpp"

namespace rift::control {

/// One look at the world. All times are on one clock, which the controller never reads itself.
struct PoseInput {
  double now_s = 0.0;
  double dt_s = 0.0;        ///< since the last decision; clamped to [dt_min_s, dt_max_s]
  double captured_s = 0.0;  ///< when the picture behind the pose was taken
  geometry::Pose2 world_from_robot;
};

/// Something about each limit of the controller.
template <class T>
struct ForEachLimit {
  T v_min{};
  T v_max{};
  T cruise_cap{};
  T through_cruise{};
  T w_min{};
  T w_max{};
  T normalised{};
  T slew{};

  /// Calls field(name, member) for every limit.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("v_min", self.v_min);
    field("v_max", self.v_max);
    field("cruise_cap", self.cruise_cap);
    field("through_cruise", self.through_cruise);
    field("w_min", self.w_min);
    field("w_max", self.w_max);
    field("normalised", self.normalised);
    field("slew", self.slew);
  }
};

/// Which limits changed what the two loops asked for.
using Limits = ForEachLimit<bool>;

/// What to do now, and why. Always finite, each power within [-1, 1].
struct Decision {
  WheelPower power;
  size_t waypoint = 0;        ///< index of the waypoint driven to; the last one when finished
  bool pose_refused = false;  ///< the pose given was no believable one; the last good one was used
  bool set_clock = false;     ///< zero power: this step only sets the clock
  bool reached = false;       ///< `waypoint` was reached at this step and the robot stops there
  bool finished = false;      ///< the last waypoint has been reached; power stays zero
  double v = 0.0;             ///< forward and steering power after their limits
  double w = 0.0;
  double raw_v = 0.0;  ///< what the loops asked for
  double raw_w = 0.0;
  double distance_m = 0.0;         ///< to the waypoint
  double heading_error_rad = 0.0;  ///< direction of the waypoint minus yaw, in [-pi, pi]
  Limits limits;
};

/// What decides in a trial: poses in, powers out.
class Controller {
 public:
  Controller() = default;
  virtual ~Controller() = default;
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  /// Takes in a pose and decides. A pose that is not finite or jumps is not used: the last good
  /// one is, and zero power comes out while there is none.
  virtual Decision Step(const PoseInput& input) = 0;
  /// Takes in a pose without deciding; false when it is refused. Step() does this by itself.
  virtual bool Observe(const PoseInput& input) = 0;
  /// Tells what was really sent.
  virtual void NoteSent(double now_s, const WheelPower& power) = 0;

  /// Start, and what is driven to in this order.
  virtual const std::vector<Waypoint>& waypoints() const = 0;
  /// Index of the waypoint driven to; the last one when finished.
  virtual size_t active() const = 0;
  /// Where the robot is to be: the waypoint it drives to, or its place on a prescribed path.
  virtual Eigen::Vector2d Target_m() const = 0;
  /// The last pose believed.
  virtual const std::optional<TimedPose>& pose() const = 0;
};

/// What a robot is to do: drive to waypoints, looking, or a program, without looking.
struct Task {
  Task() = default;
  Task(std::vector<Waypoint> to) : waypoints(std::move(to)) {}
  /// The program's waypoints are its start and the ends of its segments.
  Task(const Program& along) : waypoints(along.waypoints()), program(along) {}

  std::vector<Waypoint> waypoints;
  std::optional<Program> program;

  /// world_from_robot before the first move. Throws like StartPose.
  geometry::Pose2 Start() const;
  /// Of a robot that keeps to its task exactly: the polyline through the waypoints, a second from
  /// each to the next and with NaN for the yaw, or the path of the program.
  std::vector<TimedPose> IdealPath() const;
};

/// The controller of a task. Throws std::invalid_argument on options or a task that break their
/// rules.
std::unique_ptr<Controller> MakeController(const Task& task, const NavigatorOptions& options);

}  // namespace rift::control
