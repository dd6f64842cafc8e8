#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "rift/simulation/tilt_ambiguity.hpp"
#include "rift/statistics/random.hpp"
#include "rift/trial/robot.hpp"

namespace rift::simulation {

/// Where the robot really is: the middle of its axle in the world frame.
struct TruePose {
  double t_s = 0.0;
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double roll_rad = 0.0;   ///< about the robot's x axis, forward
  double pitch_rad = 0.0;  ///< about its y axis, left; nose down is positive
  double yaw_rad = 0.0;    ///< world_from_robot = Rz(yaw) Ry(pitch) Rx(roll)

  geometry::Pose2 Planar() const { return {x_m, y_m, yaw_rad}; }
};

struct MocapOptions {
  double rate_hz = 18.9;
  double frame_jitter_s = 0.003;
  std::optional<double> host_period_s;
  double host_period_spread_s = 0.0;
  double host_wander_s = 0.0;
  double host_jitter_s = 0.0016;
  double host_late_share = 0.0;
  double host_late_s = 0.011;
  double exposure_s = 0.010;
  double processing_s = 0.070;
  double arrival_jitter_s = 0.0;
  double noise_across_m = 0.00035;
  double blur_across_s = 0.0016;
  double noise_along_m = 0.0001;
  double stamp_jitter_s = 0.010;
  double noise_yaw_rad = 0.0016;
  double blur_yaw_rad_per_mps = 0.032;
  double yaw_tail_dof = 6.0;
  double noise_spread = 0.0;
  double noise_z_m = 0.001;
  double noise_tilt_rad = 0.02;
  double dropout = 0.0;
  double tag_ahead_m = 0.0;
  double tag_above_m = 0.0;
  AmbiguityOptions ambiguity;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("rate_hz", self.rate_hz, 0.0, 1000.0,
          "frames a second (trials: 53 ms between frames); 0: every reading is the pose at that "
          "moment and there is no delay (authors' Webots)");
    field("frame_jitter_s", self.frame_jitter_s, 0.0, 0.1,
          "scatter of the moment of a frame about its tick in s (trials: 48 to 64 ms apart)");
    field(
        "host_period_s", self.host_period_s, 0.005, 2.0,
        "the host fetches a picture this often and stamps its pose when it is done, as the "
        "authors' "
        "does (median; 0.051 to 0.063 in the logs); the driver holds one picture, the first since "
        "the last was fetched, so a stamp is two turns of the host later, less up to a frame "
        "(logs: "
        "the way between two rows follows the turn two before, slope 1.06 +- 0.13, not the last, "
        "-0.06); none: every frame is measured, stamped when captured");
    field("host_period_spread_s", self.host_period_spread_s, 0.0, 0.2,
          "standard deviation of host_period_s from run to run in s (logs of a surface: 0.0024 to "
          "0.0034)");
    field("host_wander_s", self.host_wander_s, 0.0, 0.01,
          "step of the random walk of the period from turn to turn in s (logs: the medians of "
          "both halves differ by 0.001)");
    field("host_jitter_s", self.host_jitter_s, 0.0, 0.2,
          "standard deviation of a turn about the period in s (logs, turns that are not late: "
          "0.0016)");
    field("host_late_share", self.host_late_share, 0.0, 1.0,
          "share of the turns that take host_late_s longer; each run draws its own, evenly from 0 "
          "to twice this (logs: 0.1)");
    field("host_late_s", self.host_late_s, 0.0, 0.2,
          "by how much a late turn is longer in s (logs: 0.011 on every surface)");
    field("exposure_s", self.exposure_s, 0.0, 0.2,
          "shutter time in s; the pose is that of its middle (estimate)");
    field(
        "processing_s", self.processing_s, 0.0, 2.0,
        "from the end of the exposure to the pose in s (camera and detection: 0.06 to 0.1); with a "
        "host's period to the driver alone");
    field(
        "arrival_jitter_s", self.arrival_jitter_s, 0.0, 0.2,
        "with a host's period, how much later than the quickest a frame is with the driver, in s: "
        "root mean square, half-normal (logs: 0.007, by which frames the rows are)");
    field("noise_across_m", self.noise_across_m, 0.0, 0.1,
          "scatter across the heading at rest in m (trials: 0.00035)");
    field("blur_across_s", self.blur_across_s, 0.0, 0.1,
          "further scatter across for each m/s of speed, in m per m/s (trials: 0.6 mm at 0.3 m/s)");
    field("noise_along_m", self.noise_along_m, 0.0, 0.1,
          "scatter along the heading at rest in m (trials: 0.0001)");
    field("stamp_jitter_s", self.stamp_jitter_s, 0.0, 0.1,
          "scatter of the time stamp in s (trials: 3.5 mm along the motion at 0.3 m/s)");
    field("noise_yaw_rad", self.noise_yaw_rad, 0.0, 1.0,
          "scatter of the yaw at rest in rad (trials: 0.09 deg)");
    field("blur_yaw_rad_per_mps", self.blur_yaw_rad_per_mps, 0.0, 10.0,
          "further scatter of the yaw for each m/s of speed (trials: 0.56 deg at 0.3 m/s)");
    field("yaw_tail_dof", self.yaw_tail_dof, 2.1, 1e6,
          "degrees of freedom of Student's t for the yaw (trials: 99 % within 1.7 deg, hence 6)");
    field(
        "noise_spread", self.noise_spread, 0.0, 3.0,
        "standard deviation from run to run of the logarithm of the three scatters while the robot "
        "stands: where in its pixels a standing tag lies (logs: 1.2)");
    field("noise_z_m", self.noise_z_m, 0.0, 0.1, "scatter of the height in m (estimate)");
    field("noise_tilt_rad", self.noise_tilt_rad, 0.0, 1.0,
          "scatter of roll and pitch in rad (estimate)");
    field("dropout", self.dropout, 0.0, 1.0, "share of the frames without a detection");
    field("tag_ahead_m", self.tag_ahead_m, -0.2, 0.2,
          "tag centre ahead of the axle's middle in m (identify)");
    field("tag_above_m", self.tag_above_m, -0.2, 0.2,
          "tag centre above the axle's middle in m (identify)");
    field("ambiguity", self.ambiguity, "a tag whose tilt is mirrored at the line of sight");
  }
};

/// An overhead camera that measures the tag's pose. What it sees arrives later than it was seen;
/// frame k has its own random values, so nothing depends on how often anyone looks. With a host's
/// period, the camera's frames are a grid that the host's loop samples, through the one picture
/// that the driver holds.
class Mocap {
 public:
  Mocap(const MocapOptions& options, std::uint64_t seed);

  /// The robot moved from `before` to `after`, with before.t_s <= after.t_s: takes every frame due
  /// in between, the pose interpolated to its moment.
  void Observe(const TruePose& before, const TruePose& after);
  /// The newest pose that has arrived by `now_s`, captured_s being when it was seen; none before
  /// the first. Ask in order of time.
  std::optional<trial::PoseMeasurement> Newest(double now_s);

 private:
  struct Arrival {
    double at_s;
    trial::PoseMeasurement measurement;
  };

  double FrameTime_s(std::uint64_t frame) const;
  double Latency_s() const { return 0.5 * options_.exposure_s + options_.processing_s; }
  void TakeFrame(const TruePose& pose, double speed_mps, std::uint64_t frame);
  void RunHost(double until_s);
  void BeginTurn(double now_s);
  void EndTurn();
  bool IsMirrored(const Eigen::Isometry3d& world_from_tag, double speed_mps,
                  std::uint64_t frame) const;
  trial::PoseMeasurement Measure(const TruePose& pose, double speed_mps, std::uint64_t frame) const;

  MocapOptions options_;  ///< with what this run drew of the host's period and its late turns
  statistics::CounterRandom noise_;
  statistics::CounterRandom host_noise_;
  double standing_factor_;    ///< of this run's scatters while it stands
  double standing_mirrored_;  ///< in [0, 1): how often its tag is mirrored while it stands
  double phase_s_;
  std::uint64_t next_frame_ = 0;
  double last_stamp_s_;
  double host_done_s_ = 0.0;  ///< when the host's turn ends; infinite while it waits for a picture
  std::uint64_t host_turns_ = 0;
  double host_wandered_s_ = 0.0;
  std::deque<Arrival> in_camera_;                      ///< captured, not yet with the driver
  std::optional<trial::PoseMeasurement> with_driver_;  ///< the next that the host will fetch
  std::optional<trial::PoseMeasurement> in_work_;      ///< stamped when the host's turn ends
  std::deque<Arrival> on_the_way_;
  std::optional<trial::PoseMeasurement> newest_;
};

}  // namespace rift::simulation
