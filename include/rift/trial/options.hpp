#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace rift::trial {

/// When the controller decides: at every control period on the newest pose, or once for each new
/// pose, holding the command in between.
enum class Pace { kEveryPeriod, kNewPose };

constexpr std::array<std::string_view, 2> EnumNames(Pace) { return {"every_period", "new_pose"}; }

/// Where the robot may be; a side that is unset is open.
struct Arena {
  std::optional<double> x_min_m;
  std::optional<double> x_max_m;
  std::optional<double> y_min_m;
  std::optional<double> y_max_m;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("x_min_m", self.x_min_m, -1e3, 1e3, "left edge; unset: open");
    field("x_max_m", self.x_max_m, -1e3, 1e3, "right edge; unset: open");
    field("y_min_m", self.y_min_m, -1e3, 1e3, "lower edge; unset: open");
    field("y_max_m", self.y_max_m, -1e3, 1e3, "upper edge; unset: open");
  }

  bool Contains(double x_m, double y_m) const;
};

struct TrialOptions {
  double control_period_s = 0.02;
  Pace pace = Pace::kEveryPeriod;
  /// The authors' robot first moves 0.39 s into a log, and 0.32 s of that are its loop delay.
  double settle_s = 0.1;
  double timeout_s = 20.0;
  double pose_stale_s = 0.4;
  double lost_after_s = 2.0;
  double fall_angle_deg = 60.0;
  double fall_confirm_s = 0.15;
  double log_period_s = 0.0;
  Arena arena;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("control_period_s", self.control_period_s, 1e-3, 1.0,
          "time from one decision to the next (authors: 50 Hz)");
    field("pace", self.pace, "decide every period on the newest pose, or once for each new pose");
    field("settle_s", self.settle_s, 0.0, 60.0, "zero power while the first poses come in");
    field("timeout_s", self.timeout_s, 1e-2, 3600.0, "a trial ends after this long");
    field("pose_stale_s", self.pose_stale_s, 1e-3, 10.0,
          "power is zero while the newest pose was captured longer ago than this");
    field("lost_after_s", self.lost_after_s, 1e-3, 60.0,
          "a trial ends as lost when no believable pose was captured for this long");
    field("fall_angle_deg", self.fall_angle_deg, 1.0, 180.0,
          "roll or pitch beyond this is a fall (trackers err by 35 degrees on flat ground)");
    field("fall_confirm_s", self.fall_confirm_s, 0.0, 10.0,
          "a fall must show in every pose for this long");
    field("log_period_s", self.log_period_s, 0.0, 10.0,
          "least time between two logged poses; 0 logs every new pose");
    field("arena", self.arena, "leaving it ends the trial");
  }

  /// Rules between fields; throws std::invalid_argument naming field, value and rule.
  void Check() const;
};

}  // namespace rift::trial
