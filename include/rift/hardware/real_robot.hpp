#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rift/hardware/drive_guard.hpp"
#include "rift/hardware/options.hpp"
#include "rift/hardware/pose_source.hpp"
#include "rift/hardware/robot_link.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/odometry/odometry.hpp"
#include "rift/trial/robot.hpp"
#include "rift/trial/trial.hpp"

namespace rift::hardware {

/// A pose and when it went through each stage; times on the robot's clock (RealRobot::Sense), -1
/// where the stage was never reached.
struct PoseStages {
  double captured_s = -1.0;
  double arrived_s = -1.0;    ///< picture in memory
  double ready_s = -1.0;      ///< tag found
  double sensed_s = -1.0;     ///< taken by the trial loop
  double commanded_s = -1.0;  ///< decided on
  double written_s = -1.0;    ///< on the line
  double answered_s = -1.0;   ///< the robot said it obeys
};

/// A reading's time is the middle of the round trip of the command it answered.
using odometry::EncoderReading;

/// What is recorded of a drive beside its trial.
struct DriveRecord {
  Protocol protocol = Protocol::kAuto;
  std::optional<DriveStop> stop;
  /// Whether the robot obeyed the stop and its counts rest; none: it speaks plain and cannot say.
  std::optional<bool> stop_acknowledged;
  std::vector<PoseStages> poses;
  std::vector<EncoderReading> encoders;
  std::vector<double> round_trips_s;
  size_t sent = 0;
  size_t answered = 0;
  unsigned rejected_by_robot = 0;  ///< modulo 256
};

/// Of a DriveRecord what will change no more.
struct DriveNews {
  std::vector<PoseStages> poses;
  std::vector<EncoderReading> encoders;
};

/// Told what a drive records while the robot drives, under the same terms as its base.
class DriveObserver : public trial::Observer {
 public:
  virtual void Recorded(const DriveNews& news) = 0;
};

/// Why a drive is to be stopped from outside, when that is so: a key, a signal.
using Stopper = std::function<std::optional<std::pair<StopReason, std::string>>()>;

struct RealRobotOptions {
  HardwareOptions hardware;
  Protocol protocol = Protocol::kFramed;  ///< plain or framed, as FindProtocol said
  /// Link and guard run in a thread of their own, so that zeros go out even while the trial loop
  /// hangs; without it they run in Advance(), which fake clocks need.
  bool thread = true;
  bool dry_run = false;  ///< the robot is sent zeros alone: see DriveGuard
};

/// The robot on the floor behind the interface of the simulated one: camera poses in, powers out,
/// with a DriveGuard between. `line`, `poses` and `clock` must outlive it.
class RealRobot : public trial::Robot {
 public:
  RealRobot(ByteLine& line, PoseSource& poses, Clock& clock, const RealRobotOptions& options);
  /// Sends zeros for a while, whatever happened before.
  ~RealRobot() override;

  void AddStopper(Stopper stopper);
  /// Throws std::runtime_error unless the robot is seen and answers; see DriveGuard::Arm.
  void Arm();

  /// fault: why the guard has stopped the drive.
  trial::Sensed Sense() override;
  /// A power that is refused stops the drive; it is never made to fit.
  void Command(const control::WheelPower& power) override;
  /// Waits in real time; returns early when there is a new pose to decide on.
  void Advance(double dt_s) override;
  void Stop() noexcept override;

  /// How much earlier pictures were taken than their stamps say: what Sense gives is put right.
  void SetCameraLatency(double latency_s);

  /// After Stop(): sends zeros until the robot has obeyed one and its counts rest, `timeout_s` at
  /// most.
  void ConfirmStop(double timeout_s);
  DriveState state() const;
  DriveRecord Record() const;
  /// What has settled in the record since the last call.
  DriveNews TakeNews();

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace rift::hardware
