#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/control/waypoint.hpp"
#include "rift/hardware/latency.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/pose_source.hpp"
#include "rift/hardware/real_robot.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/hardware/signal_watch.hpp"
#include "rift/trial/trial.hpp"

namespace rift::hardware {

/// Single key presses from the terminal, without Enter and without echo; nothing where stdin is no
/// terminal. The terminal is as before afterwards.
class OperatorKeys {
 public:
  OperatorKeys();
  ~OperatorKeys();
  OperatorKeys(const OperatorKeys&) = delete;
  OperatorKeys& operator=(const OperatorKeys&) = delete;

  bool IsTerminal() const { return saved_ != nullptr; }
  /// A key pressed since the last call, without waiting.
  std::optional<char> Pressed();
  /// The terminal was closed, as far as the last Pressed() saw: no key comes any more.
  bool IsGone() const { return is_gone_; }

 private:
  struct Saved;
  std::unique_ptr<Saved> saved_;
  bool is_gone_ = false;
};

/// Whoever starts and stops a drive: keys of the terminal, signals, the closed window. While it
/// lives, signals do not end the process.
class Operator {
 public:
  /// `says_yes`: the robot may start at once. Throws std::invalid_argument when it may not and
  /// stdin is no terminal, since nobody could ever press a key.
  explicit Operator(bool says_yes);

  /// Asks `say` for the start the first time; then whether it was given.
  bool MayArm(const std::function<void(const std::string&)>& say);
  /// Takes a start back that was given: the next Enter gives it.
  void AskAgain() { phase_ = Phase::kAsked; }
  /// Why the robot must stop; called by the link's thread.
  hardware::Stopper Stopper();
  /// From the window, in place of a key.
  void CloseWindow() { window_closed_ = true; }

 private:
  enum class Phase { kWaiting, kAsked, kStarted };

  std::optional<std::pair<StopReason, std::string>> Stop();
  void TakeKey(char key);

  SignalWatch signals_;
  OperatorKeys keys_;
  std::atomic<Phase> phase_ = Phase::kWaiting;
  std::atomic<bool> window_closed_ = false;
  bool key_stops_ = false;  // the link's thread alone
};

/// What the robot is to do, and within which limits.
struct DriveTask {
  control::Task task;
  control::NavigatorOptions control;
  trial::TrialOptions trial;
  HardwareOptions hardware;
};

/// What a drive is made of and whom it talks to.
struct DriveParts {
  ByteLine& line;
  PoseSource& poses;
  Clock& clock;
  /// Asked many times a second: a key, a signal.
  std::vector<Stopper> stoppers;
  /// One line for the operator.
  std::function<void(const std::string&)> say;
  /// Asked until it is true: may the robot move now?
  std::function<bool()> may_arm;
  /// Of the trial; may be none.
  DriveObserver* observer = nullptr;
  /// What is said of a robot that is not seen; asked once, may be none.
  std::function<std::string()> why_unseen;
  bool threads = true;   ///< false where `clock` is no real one
  bool dry_run = false;  ///< all of a drive but power: the robot is sent zeros alone
};

struct DriveRun {
  bool has_begun = false;  ///< false: a person stopped it before the start
  bool dry_run = false;    ///< the powers of the trial were decided on and never sent
  PingResult ping;
  std::optional<LatencyResult> latency;  ///< none: not measured
  /// Of the camera, over the whole drive by its own turns; none without encoders or turns.
  std::optional<double> camera_latency_s;
  trial::TrialResult trial;
  DriveRecord evidence;
  double stopping_distance_m = 0.0;
};

/// Thrown by what waits before a start and is told to stop.
struct StopAsked {
  DriveStop stop;
};

/// A drive that ended so, of which nothing was measured.
DriveRun StoppedBeforeStart(const DriveStop& stop, bool dry_run);

/// Hello, ping, stopping distance, the first pose, the operator's yes, the trial, the stop.
/// Throws std::runtime_error when the drive cannot begin (link over its budget, robot not seen,
/// camera or port gone); std::invalid_argument for waypoints that are no task.
DriveRun Drive(const DriveParts& parts, const DriveTask& task);

/// The link alone: hello and ping, with the motors at zero.
PingResult MeasureLink(ByteLine& line, Clock& clock, const HardwareOptions& options);

}  // namespace rift::hardware
