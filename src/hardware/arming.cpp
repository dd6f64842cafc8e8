#include "rift/hardware/arming.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "drive_lag.hpp"
#include "rift/geometry/pose2.hpp"
#include "rift/hardware/wire.hpp"
#include "suspend_watch.hpp"

namespace rift::hardware {

struct OperatorKeys::Saved {
  termios settings;
};

OperatorKeys::OperatorKeys() {
  termios settings{};
  if (::isatty(STDIN_FILENO) == 0 || ::tcgetattr(STDIN_FILENO, &settings) != 0) return;
  saved_ = std::make_unique<Saved>(Saved{settings});
  settings.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);  // signals stay: Ctrl-C must work
  settings.c_iflag &= ~static_cast<tcflag_t>(IXON);           // Ctrl-S and Ctrl-Q are keys as well
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  ::tcsetattr(STDIN_FILENO, TCSANOW, &settings);
}

OperatorKeys::~OperatorKeys() {
  if (saved_) ::tcsetattr(STDIN_FILENO, TCSANOW, &saved_->settings);
}

std::optional<char> OperatorKeys::Pressed() {
  if (!saved_) return std::nullopt;
  pollfd wanted{STDIN_FILENO, POLLIN, 0};
  if (::poll(&wanted, 1, 0) <= 0) return std::nullopt;
  char key = 0;
  const ssize_t got = (wanted.revents & POLLIN) != 0 ? ::read(STDIN_FILENO, &key, 1) : 0;
  if (got == 1) return key;
  is_gone_ = got == 0 || (errno != EINTR && errno != EAGAIN);
  return std::nullopt;
}

Operator::Operator(bool says_yes) {
  if (says_yes) {
    phase_ = Phase::kStarted;
  } else if (!keys_.IsTerminal()) {
    throw std::invalid_argument(
        "stdin is no terminal, so no key can start the robot: give --yes to start it at once");
  }
}

bool Operator::MayArm(const std::function<void(const std::string&)>& say) {
  Phase expected = Phase::kWaiting;
  if (phase_.compare_exchange_strong(expected, Phase::kAsked)) {
    say("hands off? Enter starts the robot, then any key stops it (before: q gives up)");
  }
  return phase_ == Phase::kStarted;
}

hardware::Stopper Operator::Stopper() {
  return [this] { return Stop(); };
}

std::optional<std::pair<StopReason, std::string>> Operator::Stop() {
  if (const auto signal = signals_.Seen()) return std::pair(StopReason::kSignal, *signal + " came");
  if (window_closed_) return std::pair(StopReason::kOperator, std::string("the window was closed"));
  while (const std::optional<char> key = keys_.Pressed()) TakeKey(*key);
  if (keys_.IsGone()) {
    return std::pair(StopReason::kOperator,
                     std::string("the terminal went away, and no key could stop the robot"));
  }
  if (key_stops_) return std::pair(StopReason::kOperator, std::string("a key was pressed"));
  return std::nullopt;
}

// Enter counts once it was asked for; what was typed before must neither start nor stop.
void Operator::TakeKey(char key) {
  const bool is_enter = key == '\n' || key == '\r';
  Phase expected = Phase::kAsked;
  if (is_enter && phase_.compare_exchange_strong(expected, Phase::kStarted)) return;
  if (phase_ == Phase::kStarted || key == 'q') key_stops_ = true;
}

namespace {

constexpr double kTurn_s = 0.02;
constexpr double kFirstPose_s = 10.0;
constexpr double kConfirm_s = 1.0;
constexpr double kNearStart_m = 0.1;  // by hand, the authors were up to 0.07 m off

void RequireBudget(const PingResult& ping, const PingOptions& options) {
  const std::vector<std::string> broken = BrokenBudget(ping, options);
  if (broken.empty()) return;
  throw std::runtime_error(
      fmt::format("not armed, the link breaks its budget: {}", fmt::join(broken, "; ")));
}

/// A power beyond the guard's limit ends the drive when it is asked for; a person hears of it
/// before.
void WarnOfPowerLimit(const DriveParts& parts, const DriveTask& task) {
  const std::optional<control::Program>& program = task.task.program;
  const double most =
      program ? program->MostPower() : std::min(1.0, task.control.v_max + task.control.w_max);
  const double limit = task.hardware.guard.max_power;
  if (most <= limit) return;
  parts.say(fmt::format(
      "the {} can ask for the power {:g}, and the limit (hardware.guard.max_power) is {:g}: a "
      "command above it is not sent and ends the drive",
      program ? "program" : "controller (control.v_max + control.w_max)", most, limit));
}

/// Forward alone counts for a controller: what it steers by turns the robot and does not carry it.
double StrongestForward(const DriveTask& task) {
  return task.task.program ? task.task.program->MostPower() : task.control.v_max;
}

double PrintStoppingDistance(const DriveParts& parts, const DriveTask& task,
                             const PingResult& ping) {
  StoppingOptions options = task.hardware.stopping;
  if (ping.IsMeasured()) options.delay_s = ping.OneWay_s();
  // The camera is not measured yet: it may be as late as its budget.
  const double stale_s = task.hardware.guard.pose_stale_s;
  const double camera_s = task.hardware.evidence.max_latency_s;
  const double blind_s = stale_s + camera_s;
  const double power = StrongestForward(task);
  const double distance_m = StoppingDistance_m(options, power, blind_s);
  const std::string until = blind_s > options.robot_watchdog_s
                                ? fmt::format(
                                      "{:.3f} s an old pose is driven by + {:.3f} s the "
                                      "camera may be late",
                                      stale_s, camera_s)
                                : fmt::format("{:.3f} s watchdog", options.robot_watchdog_s);
  parts.say(
      fmt::format("worst stopping distance {:.3f} m: at power {:g}, {:.2f} m/s x ({} + {:.3f} s "
                  "delay) + braking",
                  distance_m, power, options.full_power_speed_mps * power, until, options.delay_s));
  if (!ping.IsMeasured()) {
    parts.say(
        "the robot is spoken to in plain lines: its link cannot be measured, a stop cannot be "
        "acknowledged, and without rift's listener the last command holds for ever if the link "
        "breaks");
  }
  return distance_m;
}

std::string BeforeStart(const DriveStop& stop) { return "stopped before the start: " + stop.text; }

/// Asks whoever may stop a drive each time something waits: a hello and a ping take seconds.
class AskingClock : public Clock {
 public:
  explicit AskingClock(const DriveParts& parts) : parts_(parts) {}
  double Now_s() override { return parts_.clock.Now_s(); }
  void Wait(double dt_s) override {
    for (const Stopper& stopper : parts_.stoppers) {
      if (const auto stop = stopper()) throw StopAsked{{stop->first, stop->second, 0.0}};
    }
    parts_.clock.Wait(dt_s);
  }

 private:
  const DriveParts& parts_;
};

/// Lets the link run until `is_so`; false when a person stopped the drive meanwhile. Throws when
/// anything else did.
bool WaitUntil(RealRobot& robot, const std::function<bool()>& is_so) {
  while (!is_so()) {
    robot.Advance(kTurn_s);
    if (robot.state() != DriveState::kStopped) continue;
    const DriveStop stop = *robot.Record().stop;
    if (stop.reason == StopReason::kOperator || stop.reason == StopReason::kSignal) {
      return false;
    }
    throw std::runtime_error(BeforeStart(stop));
  }
  return true;
}

bool WaitForFirstPose(const DriveParts& parts, RealRobot& robot) {
  const double start_s = robot.Sense().now_s;
  return WaitUntil(robot, [&] {
    const trial::Sensed sensed = robot.Sense();
    if (!sensed.pose && sensed.now_s - start_s > kFirstPose_s) {
      const std::string why = parts.why_unseen ? parts.why_unseen() : "";
      throw std::runtime_error(
          fmt::format("the robot was not seen within {} s: {}", kFirstPose_s,
                      why.empty() ? "is its tag in the picture, flat and well lit?" : why));
    }
    return sensed.pose.has_value();
  });
}

void SayWhereItStands(const DriveParts& parts, RealRobot& robot, const DriveTask& task) {
  const geometry::Pose2 pose = robot.Sense().pose->world_from_robot;
  const geometry::Pose2 start = task.task.Start();
  const double off_m = (pose.Position() - start.Position()).norm();
  parts.say(
      fmt::format("the robot stands at x {:.3f} m, y {:.3f} m, {:.3f} m from the first "
                  "waypoint{}",
                  pose.x_m, pose.y_m, off_m,
                  off_m > kNearStart_m ? ": far off, is the world frame right?" : ""));
}

/// By how much the poses of a drive lag its encoders, on top of what was subtracted already.
std::optional<double> LatencyOver(const DriveRun& run, const odometry::OdometryOptions& odometry) {
  std::vector<Angle> seen;
  for (const trajectory::StampedPose& pose : run.trial.trajectory.poses) {
    AddAngle(seen, pose.t_s, pose.yaw_rad);
  }
  const std::optional<double> lag_s =
      LagOverDrive(seen, WheelTurns(run.evidence.encoders, odometry::YawPerCount_rad(odometry)));
  if (!lag_s) return std::nullopt;
  const bool was_measured = run.latency && run.latency->delay.camera_s;
  return *lag_s + (was_measured ? std::max(0.0, *run.latency->delay.camera_s) : 0.0);
}

std::string PartText(const char* name, const std::optional<double>& part_s) {
  return part_s ? fmt::format("{} {:.0f} ms", name, 1e3 * *part_s)
                : fmt::format("{} unknown", name);
}

std::string CameraText(const LoopDelay& delay) {
  if (!delay.camera_most_s) return PartText("camera", delay.camera_s);
  return PartText("camera at most", delay.camera_most_s);
}

/// What a command takes to the motors at least: half of the round trip where one was measured, else
/// the time of its bytes on the line alone. hardware.stopping.delay_s is no such bound, since it is
/// a cautious guess upwards.
double LeastWay_s(const PingResult& ping, const HardwareOptions& options) {
  if (ping.IsMeasured()) return ping.OneWay_s();
  const auto bytes = static_cast<double>(PlainLine({}, options.plain).size());
  return bytes * ByteTime_s(options.line.baud);
}

void RequireCameraInTime(const LoopDelay& delay, double budget_s) {
  if (delay.camera_s && std::abs(*delay.camera_s) > budget_s) {
    throw std::runtime_error(fmt::format(
        "the camera's pictures are {:.3f} s late, and the budget (hardware.evidence.max_latency_s) "
        "is {:.3f} s: ask it for fewer pixels or a shorter exposure, or read it without a server "
        "between",
        *delay.camera_s, budget_s));
  }
  if (delay.camera_most_s && *delay.camera_most_s > budget_s) {
    throw std::runtime_error(fmt::format(
        "the camera's pictures may be {:.3f} s late (the loop delay less what the line takes; this "
        "robot tells its wheels too seldom, or not at all, to know more by), and the budget "
        "(hardware.evidence.max_latency_s) is {:.3f} s: ask it for fewer pixels or a shorter "
        "exposure, read it without a server between, have a 3pi+ run src/firmware at its line's "
        "full speed, or raise the budget by what the robot itself is known to take",
        *delay.camera_most_s, budget_s));
  }
}

/// The turn on the spot, and what follows from it.
std::optional<LatencyResult> MeasureCamera(RealRobot& robot, const DriveParts& parts,
                                           const DriveTask& task, const PingResult& ping) {
  if (!task.hardware.turn.enabled) return std::nullopt;
  const double one_way_s = ping.IsMeasured() ? ping.OneWay_s() : task.hardware.stopping.delay_s;
  parts.say("the robot turns a few degrees to and fro, to see how late the camera is");
  TurnOptions turn = task.hardware.turn;  // the guard would stop what is above its limit
  turn.most_power = std::min(turn.most_power, task.hardware.guard.max_power);
  turn.power = std::min(turn.power, turn.most_power);
  std::optional<LatencyResult> found =
      MeasureLatency(robot, task.hardware.odometry, turn, one_way_s);
  if (!found) return std::nullopt;
  LoopDelay& delay = found->delay;
  if (!delay.camera_s) {
    delay.camera_most_s = std::max(0.0, *delay.total_s - LeastWay_s(ping, task.hardware));
  }
  parts.say(fmt::format("loop delay {:.0f} ms: {}, {}, {}, {}", 1e3 * delay.total_s.value_or(0.0),
                        CameraText(delay), PartText("host", delay.host_s),
                        PartText("link", delay.link_s), PartText("robot", delay.robot_s)));
  RequireCameraInTime(delay, task.hardware.evidence.max_latency_s);
  // A bound is no time to take from stamps: the guard goes on allowing for the whole budget.
  if (delay.camera_s) robot.SetCameraLatency(std::max(0.0, *delay.camera_s));
  return found;
}

/// rift's own listener stops by itself. Of another robot only its owner can say so.
void RequireWatchdog(const DriveParts& parts, Protocol protocol, const HardwareOptions& options) {
  if (protocol != Protocol::kPlain || options.plain.watchdog == Watchdog::kRobot) return;
  if (options.plain.watchdog == Watchdog::kUnknown) {
    throw std::invalid_argument(fmt::format(
        "the robot speaks plain, and nobody said what stops it when the link breaks: copy "
        "src/firmware to a 3pi+, or set hardware.plain.watchdog to robot where the robot stops by "
        "itself within hardware.stopping.robot_watchdog_s ({} s) of the last command, to none "
        "where nothing does and you drive it all the same",
        options.stopping.robot_watchdog_s));
  }
  parts.say(
      "nothing stops this robot when the link breaks (hardware.plain.watchdog: none): keep a hand "
      "at its switch");
}

/// Hands on what the trial records, and with each row what the robot has recorded since the last.
class Forward : public trial::Observer {
 public:
  Forward(RealRobot& robot, DriveObserver* to) : robot_(robot), to_(to) {}

  void Row(const trajectory::StampedPose& pose, std::span<const double> channels) override {
    if (to_ == nullptr) return;
    to_->Row(pose, channels);
    to_->Recorded(robot_.TakeNews());
  }
  void Sent(const trial::SentCommand& command) override {
    if (to_ != nullptr) to_->Sent(command);
  }

 private:
  RealRobot& robot_;
  DriveObserver* to_;
};

}  // namespace

PingResult MeasureLink(ByteLine& line, Clock& clock, const HardwareOptions& options) {
  const Protocol protocol = FindProtocol(line, clock, options.line, options.plain);
  return Ping(line, clock, options.line, protocol, options.ping);
}

DriveRun StoppedBeforeStart(const DriveStop& stop, bool dry_run) {
  DriveRun run{.dry_run = dry_run};
  run.evidence.stop = stop;
  run.trial.reason = BeforeStart(stop);
  return run;
}

DriveRun Drive(const DriveParts& parts, const DriveTask& task) {
  control::CheckWaypoints(task.task.waypoints);
  DriveRun run{.dry_run = parts.dry_run};
  try {
    AskingClock clock(parts);
    run.ping = MeasureLink(parts.line, clock, task.hardware);
  } catch (const StopAsked& asked) {
    return StoppedBeforeStart(asked.stop, parts.dry_run);
  }
  parts.say(fmt::format("the robot speaks {}",
                        EnumNames(run.ping.protocol)[static_cast<std::size_t>(run.ping.protocol)]));
  RequireWatchdog(parts, run.ping.protocol, task.hardware);
  RequireBudget(run.ping, task.hardware.ping);
  WarnOfPowerLimit(parts, task);
  run.stopping_distance_m = PrintStoppingDistance(parts, task, run.ping);

  RealRobot robot(parts.line, parts.poses, parts.clock,
                  {task.hardware, run.ping.protocol, parts.threads, parts.dry_run});
  for (const Stopper& stopper : parts.stoppers) robot.AddStopper(stopper);
  if (WaitForFirstPose(parts, robot)) {
    SayWhereItStands(parts, robot, task);
    run.has_begun = WaitUntil(robot, parts.may_arm);
  }
  if (run.has_begun) {
    robot.Arm();
    robot.AddStopper(SuspendStopper(task.hardware.guard.host_stall_s));
    if (!parts.dry_run) run.latency = MeasureCamera(robot, parts, task, run.ping);
    Forward forward(robot, parts.observer);
    run.trial = trial::RunTrial(robot, task.task, task.control, task.trial, &forward);
  } else {
    run.trial.reason = BeforeStart(*robot.Record().stop);
  }
  robot.ConfirmStop(kConfirm_s);
  run.evidence = robot.Record();
  run.camera_latency_s = LatencyOver(run, task.hardware.odometry);
  return run;
}

}  // namespace rift::hardware
