#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rift/control/diff_drive.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/geometry/pose2.hpp"

/// Prescribed trajectories, driven without looking (paper, sections 4.4 and 5.2).
namespace rift::control {

/// One piece of a program: `{straight_m: 1}`, `{turn_deg: 90}` on the spot,
/// `{turn_deg: 90, radius_m: 0.3}` along an arc, or `{hold_s: 1}`.
struct Segment {
  std::optional<double> straight_m;
  std::optional<double> turn_deg;
  std::optional<double> radius_m;
  std::optional<double> hold_s;
  std::optional<double> power;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("straight_m", self.straight_m, -1e3, 1e3, "straight ahead in metres; below 0: backwards");
    field("turn_deg", self.turn_deg, -36000.0, 36000.0,
          "turn in degrees, counter-clockwise positive; on the spot unless radius_m is set");
    field("radius_m", self.radius_m, 1e-3, 1e3, "the turn goes along an arc of this radius");
    field("hold_s", self.hold_s, 0.0, 3600.0, "stand still for this long");
    field("power", self.power, 1e-3, 1.0, "of this segment; unset: the program's");
  }
  /// Throws std::invalid_argument unless it is exactly one kind of segment.
  void Check() const;
};

/// A list of segments and how fast they are driven. Without segments there is no program.
struct ProgramOptions {
  double power = 0.25;
  std::optional<double> speed_mps;
  int laps = 1;
  double rest_s = 1.0;
  std::vector<Segment> segments;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("power", self.power, 1e-3, 1.0,
          "of the faster wheel as a share of full power (paper: 0.25, 0.5, 0.75)");
    field("speed_mps", self.speed_mps, 1e-3, 100.0,
          "of the faster wheel, instead of power: what the ideal robot needs for it is sent");
    field("laps", self.laps, 1, 1000, "how often the segments are driven");
    field("rest_s", self.rest_s, 0.0, 60.0,
          "zero power at the end, while the robot coasts and late poses come in");
    field("segments", self.segments, "straight_m, turn_deg (with radius_m: an arc) or hold_s each");
  }
};

/// A program made exact: which powers at which time, and where a robot that rolls without slip at
/// the speed its power asks for would be.
class Program {
 public:
  /// `drive`: the ideal robot. Throws std::invalid_argument when there is no segment, nothing
  /// moves, or a wheel would need more than full power.
  Program(const ProgramOptions& options, const DiffDriveOptions& drive,
          const geometry::Pose2& world_from_start);

  /// Of the segments, without the rest at the end.
  double Duration_s() const { return pieces_.back().end_s; }
  double Rest_s() const { return rest_s_; }
  /// Along the path of the middle of the axle; turns on the spot have none.
  double Length_m() const { return length_m_; }
  /// The mean power over [from_s, to_s] of the program, so that a command that is held over the end
  /// of a segment turns the wheels as far as both segments ask for. Zero outside.
  WheelPower MeanPower(double from_s, double to_s) const;
  /// The largest power of either wheel.
  double MostPower() const;
  /// world_from_robot of the ideal robot; at the ends outside of the program.
  geometry::Pose2 PoseAt(double t_s) const;
  /// The segment at a time: its index over all laps; the last one from its end on.
  size_t PieceAt(double t_s) const;
  /// Start and the ends of the segments: what is shown as waypoints.
  const std::vector<Waypoint>& waypoints() const { return waypoints_; }
  /// Times from 0 to Duration_s(), at most `step_s` apart, the ends of all segments among them.
  std::vector<double> Times(double step_s) const;

 private:
  struct Piece {
    double start_s = 0.0;
    double end_s = 0.0;
    WheelPower power;
    double length_m = 0.0;  ///< below 0: backwards
    double turn_rad = 0.0;
    geometry::Pose2 world_from_start;
  };

  void Add(const Segment& segment, double full_speed_mps, const ProgramOptions& options,
           double track_m);

  std::vector<Piece> pieces_;
  std::vector<Waypoint> waypoints_;
  double length_m_ = 0.0;
  double rest_s_ = 0.0;
};

}  // namespace rift::control
