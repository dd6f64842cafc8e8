#pragma once

#include <deque>
#include <optional>
#include <string>

#include "backlog_check.hpp"
#include "rift/hardware/drive_guard.hpp"
#include "rift/hardware/options.hpp"
#include "rift/trial/robot.hpp"

namespace rift::hardware {

/// How far the wheels have rolled since some start, as far as the robot has told.
struct WheelTravel {
  double t_s = 0.0;
  double left_m = 0.0;
  double right_m = 0.0;
};

/// How pose and wheels, or pictures and commands, contradict each other.
struct Disagreement {
  StopReason reason = StopReason::kPoseStands;
  std::string text;  ///< one line for people
};

/// Crosses what the camera shows with what the wheels do: a picture that is old, repeated, out of
/// order or of another tag shows a motion that the wheels do not make. Knows no clock.
class MotionCheck {
 public:
  /// `track_m`: distance between the wheels.
  MotionCheck(const EvidenceOptions& options, double track_m)
      : options_(options), track_m_(track_m), backlog_(options) {}

  /// How much older poses are than their stamps say, and than those of the last seconds were.
  void SetLatency(double latency_s);
  /// Forgets all it has seen.
  void Restart();
  /// Times must rise. `is_measured`: by encoders; else it is what the commands ask for.
  void SeeWheels(const WheelTravel& wheels, bool is_measured);
  /// Whether the newest command asks a wheel to turn, and when the robot has heard it at the
  /// latest.
  void SeeCommand(bool turns, double heard_s);
  /// `repeats_since_s`: as PoseNews has it.
  void SeePose(const trial::PoseMeasurement& pose,
               const std::optional<double>& repeats_since_s = std::nullopt);
  /// What is wrong with all that was seen up to now; none while pose and wheels agree.
  std::optional<Disagreement> Check();

 private:
  struct Sample {
    double t_s = 0.0;
    geometry::Pose2 pose;  ///< its yaw runs on through +-pi
    WheelTravel wheels;    ///< at the same time
    std::optional<double> repeats_since_s;
  };

  /// Commands tell less of the wheels than encoders do.
  double Loosened(double limit) const { return is_measured_ ? limit : 3.0 * limit; }
  double Speed_mps(const Sample& now) const;
  std::optional<WheelTravel> WheelsAt(double t_s) const;
  std::optional<Disagreement> CheckSample(const Sample& now);
  std::optional<Disagreement> CheckBlindDrive() const;
  std::optional<Disagreement> CheckRepeats(const Sample& now) const;
  std::optional<Disagreement> CheckPoseStands(const Sample& now);
  std::optional<Disagreement> CheckWheelsStand(const Sample& now);
  double Forward_m(const Sample& before, const Sample& now) const;
  std::optional<Disagreement> CheckOrder(const Sample& before, const Sample& now);
  std::optional<Disagreement> CheckBacklog(const Sample& before, const Sample& now);
  std::optional<Disagreement> CheckWindow(const Sample& now);
  std::optional<Disagreement> CheckLag(const Sample& now);
  std::optional<double> Lag_s() const;

  EvidenceOptions options_;
  double track_m_;
  BacklogCheck backlog_;
  double latency_s_ = 0.0;
  bool is_latency_known_ = false;
  bool is_measured_ = true;
  std::optional<double> turning_since_s_;  ///< by the commands, without a zero between
  double driven_blind_s_ = 0.0;            ///< up to the newest pose, on one and the same picture
  std::deque<WheelTravel> wheels_;
  std::deque<Sample> waiting_;  ///< for the wheels at their time
  std::deque<Sample> samples_;
  std::optional<Sample> pose_anchor_;   ///< where the pose last moved
  std::optional<Sample> wheel_anchor_;  ///< where the wheels last moved
  std::deque<double> backward_s_;       ///< when the pose ran against the wheels
  double looked_for_lag_s_ = 0.0;
  int lags_ = 0;  ///< looks in a row that found one
};

}  // namespace rift::hardware
