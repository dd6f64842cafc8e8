#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/control/options.hpp"
#include "rift/control/pid.hpp"
#include "rift/control/pose_filter.hpp"
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

/// Drives a robot along waypoints: a distance loop gives the forward power, a heading loop the
/// steering power (paper 4.1; the details are those of the authors' Webots logs). Its decisions
/// depend on what it was told and on nothing else.
///
/// At a waypoint with stop one decision is zero power, then the next leg begins; both loops are
/// reset at every waypoint.
class Navigator {
 public:
  /// Throws std::invalid_argument on options or waypoints that break their rules.
  Navigator(const NavigatorOptions& options, std::vector<Waypoint> waypoints);

  /// Takes in a pose and decides. A pose that is not finite or jumps is not used: the last good
  /// one is, and zero power comes out while there is none.
  Decision Step(const PoseInput& input);

  /// Takes in a pose without deciding; false when it is refused. Step() does this by itself.
  bool Observe(const PoseInput& input);

  /// Tells what was really sent, which slew limit and latency compensation build on.
  void NoteSent(double now_s, const WheelPower& power);

  bool finished() const { return active_ == waypoints_.size(); }
  size_t active() const { return finished() ? waypoints_.size() - 1 : active_; }
  const std::vector<Waypoint>& waypoints() const { return waypoints_; }
  /// The last pose believed.
  const std::optional<TimedPose>& pose() const { return gate_.last(); }

 private:
  bool Arrive(Decision& decision, const geometry::Pose2& world_from_robot);
  void Aim(Decision& decision, const geometry::Pose2& world_from_robot) const;
  void DecideSpeed(Decision& decision, double dt_s);
  void DecideSteering(Decision& decision, double dt_s);
  void DecidePower(Decision& decision, double dt_s) const;

  NavigatorOptions options_;
  std::vector<Waypoint> waypoints_;
  size_t active_ = 1;
  Pid distance_loop_;
  Pid heading_loop_;
  PoseGate gate_;
  double arrived_s_ = 0.0;
  PosePredictor predictor_;
  WheelPower last_sent_;
};

}  // namespace rift::control
