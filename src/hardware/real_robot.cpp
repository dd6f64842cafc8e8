#include "rift/hardware/real_robot.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <thread>

#include "count_watch.hpp"
#include "motion_check.hpp"

namespace rift::hardware {
namespace {

constexpr double kTick_s = 0.001;
constexpr double kVoltPerMillivolt = 1e-3;
constexpr double kLastZeros_s = 0.3;
constexpr double kLongestPeriod_s = 0.1;  // of pictures; a pause is none
constexpr double kSettled_s = 2.5;        // the guard waits for no answer as long as that
constexpr double kReadingsEnd_s = 0.5;    // rift's listener answers plain lines each 0.2 s

}  // namespace

/// All that the trial loop and the thread share; every public function holds the lock.
class RealRobot::Core {
 public:
  Core(ByteLine& line, PoseSource& poses, Clock& clock, const RealRobotOptions& options)
      : clock_(clock),
        poses_(poses),
        is_threaded_(options.thread),
        is_dry_run_(options.dry_run),
        start_s_(clock.Now_s()),
        hardware_(options.hardware),
        guard_(options.hardware.guard, options.dry_run),
        motion_(options.hardware.evidence, options.hardware.odometry.drive.track_m),
        count_watch_(odometry::MetresPerCount(options.hardware.odometry)),
        link_(line, options.hardware.line, options.protocol, options.hardware.plain) {
    options.hardware.Check();
    if (is_threaded_) thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
  }

  void AddStopper(Stopper stopper) {
    const std::lock_guard lock(mutex_);
    stoppers_.push_back(std::move(stopper));
  }

  void Arm();
  trial::Sensed Sense();
  void Command(const control::WheelPower& power);
  void Stop() noexcept;
  bool HasNewPose() {
    const std::lock_guard lock(mutex_);
    return news_.newest && news_.newest->measured.captured_s != sensed_captured_s_;
  }
  void Wait(double dt_s);
  bool StopIsConfirmed();
  DriveState state() {
    const std::lock_guard lock(mutex_);
    return guard_.state();
  }
  DriveRecord Record();
  void SetCameraLatency(double latency_s) {
    const std::lock_guard lock(mutex_);
    camera_latency_s_ = latency_s;
    motion_.SetLatency(latency_s);
    motion_.Restart();
  }
  DriveNews TakeNews();
  double Now_s() { return clock_.Now_s(); }

 private:
  void Run(const std::stop_token& stop);
  void Update();
  void ReadInputs(double now_s);
  void Exchange(double now_s);
  void HandleAnswer(const RobotLink::Heard& heard, double now_s);
  void NoteWritten();
  void CheckMotion(double now_s);
  bool HasStopped() const { return stop_is_answered_ && count_watch_.Rest(); }
  void NoteReadingsEnd(double now_s);
  void FollowCommands(double now_s);
  void PassToLink(const control::WheelPower& power, bool is_first, double now_s);

  Clock& clock_;
  PoseSource& poses_;
  bool is_threaded_;
  bool is_dry_run_;
  double start_s_;
  std::mutex mutex_;
  HardwareOptions hardware_;
  DriveGuard guard_;
  MotionCheck motion_;
  CountWatch count_watch_;
  double camera_latency_s_ = 0.0;
  double commanded_s_ = 0.0;  ///< up to when `commanded_` was followed
  WheelTravel commanded_;     ///< of wheels that obey, where the robot tells nothing of its own
  RobotLink link_;
  bool line_is_lost_ = false;
  std::vector<Stopper> stoppers_;
  PoseNews news_;
  std::optional<double> sensed_captured_s_;
  double next_pose_s_ = 0.0;  ///< when it is expected
  std::optional<control::EncoderCounts> counts_;
  double counted_s_ = 0.0;       ///< when `counts_` was heard
  bool readings_ended_ = false;  ///< for this drive: wheels that tell now and then tell too little
  std::optional<double> stopped_at_s_;  ///< when zeros began for good
  bool stop_is_answered_ = false;
  bool waits_for_write_ =
      false;  ///< the newest command, which belongs to the last of record_.poses
  std::optional<double> written_s_;
  DriveRecord record_;
  size_t poses_taken_ = 0;  ///< of record_, by TakeNews()
  size_t encoders_taken_ = 0;
  std::jthread thread_;  // last: it ends before what it uses
};

void RealRobot::Core::Run(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    Update();
    clock_.Wait(kTick_s);
  }
}

void RealRobot::Core::Wait(double dt_s) {
  clock_.Wait(dt_s);
  if (!is_threaded_) Update();
}

void RealRobot::Core::Update() {
  const std::lock_guard lock(mutex_);
  const double now_s = clock_.Now_s();
  ReadInputs(now_s);
  Exchange(now_s);
}

// What throws here ends the drive, not the process: the zeros must still be sent.
void RealRobot::Core::ReadInputs(double now_s) {
  try {
    for (const Stopper& stopper : stoppers_) {
      if (const auto stop = stopper()) guard_.Stop(stop->first, stop->second, now_s);
    }
    PoseNews news = poses_.Newest();
    guard_.SeePose(news, now_s);
    const bool is_new = news.newest && (!news_.newest || news.newest->measured.captured_s >
                                                             news_.newest->measured.captured_s);
    if (is_new && news.newest->measured.world_from_robot.IsFinite()) {
      motion_.SeePose(news.newest->measured, news.repeats_since_s);
    }
    if (guard_.state() != DriveState::kStopped || news.newest) news_ = std::move(news);
  } catch (const std::exception& error) {
    guard_.Stop(StopReason::kException, error.what(), now_s);
  }
}

void RealRobot::Core::Exchange(double now_s) {
  guard_.Tick(now_s, line_is_lost_ ? 0.0 : link_.Lag_s(now_s));
  if (line_is_lost_) return;
  if (guard_.state() == DriveState::kStopped && !stopped_at_s_) stopped_at_s_ = now_s;
  if (guard_.state() != DriveState::kStopped) stopped_at_s_.reset();
  link_.Put(guard_.Allowed(), false);
  try {
    link_.Tick(now_s);
  } catch (const LineGone& gone) {
    line_is_lost_ = true;
    guard_.Stop(StopReason::kPortGone, gone.what(), now_s);
    return;
  }
  NoteWritten();
  for (const RobotLink::Heard& heard : link_.TakeHeard()) HandleAnswer(heard, now_s);
  NoteReadingsEnd(now_s);
  FollowCommands(now_s);
  CheckMotion(now_s);
}

// Only what an armed robot does on its own counts: before, it may be carried to its start, and in a
// dry run along the waypoints.
void RealRobot::Core::CheckMotion(double now_s) {
  const std::optional<Disagreement> found = motion_.Check();
  if (!found || is_dry_run_ || guard_.state() != DriveState::kArmed) return;
  guard_.Stop(found->reason, found->text, now_s);
}

// Of a plain robot nothing else tells that its answers stopped.
void RealRobot::Core::NoteReadingsEnd(double now_s) {
  const double end_s = std::max(kReadingsEnd_s, hardware_.guard.link_lag_s);
  if (!counts_ || readings_ended_ || now_s - counted_s_ <= end_s) return;
  readings_ended_ = true;
  commanded_s_ = 0.0;
  motion_.Restart();  // poses that wait for wheels have none
}

// A robot that never answers, or no more, is taken to obey.
void RealRobot::Core::FollowCommands(double now_s) {
  constexpr double kEvery_s = 0.02;
  if ((counts_ && !readings_ended_) || now_s - commanded_s_ < kEvery_s) return;
  const double elapsed_s = commanded_s_ > 0.0 ? now_s - commanded_s_ : 0.0;
  commanded_s_ = now_s;
  const MilliPower power = link_.last_sent() ? link_.last_sent()->power : MilliPower{};
  const double m_per_milli = 1e-3 * hardware_.stopping.full_power_speed_mps * elapsed_s;
  commanded_.t_s = now_s + hardware_.stopping.delay_s;
  commanded_.left_m += m_per_milli * power.left;
  commanded_.right_m += m_per_milli * power.right;
  motion_.SeeWheels(commanded_, false);
}

void RealRobot::Core::NoteWritten() {
  if (!link_.last_sent() || link_.last_sent()->at_s == written_s_) return;
  written_s_ = link_.last_sent()->at_s;
  motion_.SeeCommand(!link_.last_sent()->power.IsZero(), *written_s_ + hardware_.guard.link_lag_s);
  count_watch_.SeeCommand(link_.last_sent()->power, *written_s_);
  if (!waits_for_write_) return;
  record_.poses.back().written_s = *written_s_ - start_s_;
  waits_for_write_ = false;
}

void RealRobot::Core::HandleAnswer(const RobotLink::Heard& heard, double now_s) {
  counts_ = control::EncoderCounts{heard.answer.left, heard.answer.right};
  counted_s_ = now_s;
  const double battery_v = kVoltPerMillivolt * heard.answer.battery_mv;
  const double sent_s = heard.sent ? heard.sent->at_s : heard.at_s;
  const double read_s = 0.5 * (sent_s + heard.at_s);
  // Two plain answers may come at once, and times of readings rise.
  if (record_.encoders.empty() || read_s - start_s_ > record_.encoders.back().t_s) {
    record_.encoders.push_back({read_s - start_s_, *counts_, battery_v});
  }
  const double m_per_count = odometry::MetresPerCount(hardware_.odometry);
  if (!readings_ended_) {
    motion_.SeeWheels({read_s, m_per_count * static_cast<double>(counts_->left),
                       m_per_count * static_cast<double>(counts_->right)},
                      true);
  }
  const std::optional<std::string> jump =
      count_watch_.SeeCounts(heard.answer.left, heard.answer.right, read_s);
  if (jump && guard_.state() == DriveState::kArmed) {
    guard_.Stop(StopReason::kRobotStopped, *jump, now_s);
  }
  // In a dry run it is carried along the waypoints.
  const std::optional<std::string> disobeys = count_watch_.CheckStanding();
  if (disobeys && !is_dry_run_ && guard_.state() == DriveState::kArmed) {
    guard_.Stop(StopReason::kRobotDisobeys, *disobeys, now_s);
  }
  if (!heard.sent) {  // a plain answer says neither to what nor how often the robot stopped
    if (link_.protocol() == Protocol::kPlain) guard_.HearRobot(0, battery_v, now_s);
    return;
  }
  record_.rejected_by_robot = heard.answer.rejected;
  record_.round_trips_s.push_back(heard.at_s - sent_s);
  for (auto pose = record_.poses.rbegin(); pose != record_.poses.rend(); ++pose) {
    if (pose->written_s >= 0.0 && pose->written_s <= sent_s - start_s_) {
      if (pose->answered_s < 0.0) pose->answered_s = heard.at_s - start_s_;
      break;
    }
  }
  guard_.HearRobot(heard.answer.stops, battery_v, now_s);
  if (stopped_at_s_ && heard.sent->power.IsZero() && sent_s >= *stopped_at_s_) {
    stop_is_answered_ = true;
  }
}

void RealRobot::Core::Arm() {
  const std::lock_guard lock(mutex_);
  if (line_is_lost_) throw std::runtime_error("cannot arm: the serial port went away");
  guard_.Arm(clock_.Now_s());
  motion_.Restart();
  count_watch_.Restart(clock_.Now_s());
  readings_ended_ = false;
  stop_is_answered_ = false;
  stopped_at_s_.reset();
}

trial::Sensed RealRobot::Core::Sense() {
  const std::lock_guard lock(mutex_);
  trial::Sensed sensed;
  const double now_s = clock_.Now_s();
  sensed.now_s = now_s - start_s_;
  sensed.encoders = counts_;
  guard_.NoteTime(now_s);  // the trial may wake before the thread that tends the line
  if (guard_.stop()) sensed.fault = guard_.stop()->text;
  if (!news_.newest) return sensed;
  sensed.pose = news_.newest->measured;
  sensed.pose->captured_s -= start_s_ + camera_latency_s_;
  if (sensed_captured_s_ != news_.newest->measured.captured_s) {
    const double period_s =
        news_.newest->measured.captured_s - sensed_captured_s_.value_or(-INFINITY);
    next_pose_s_ = clock_.Now_s() + std::min(period_s, kLongestPeriod_s);
    sensed_captured_s_ = news_.newest->measured.captured_s;
    waits_for_write_ = false;
    record_.poses.push_back({sensed.pose->captured_s, news_.newest->arrived_s - start_s_,
                             news_.newest->ready_s - start_s_, sensed.now_s});
  }
  return sensed;
}

void RealRobot::Core::Command(const control::WheelPower& power) {
  const std::lock_guard lock(mutex_);
  const double now_s = clock_.Now_s();
  guard_.Command(power, now_s);
  const bool is_first = !record_.poses.empty() && record_.poses.back().commanded_s < 0.0;
  if (is_first) {
    record_.poses.back().commanded_s = now_s - start_s_;
    waits_for_write_ = true;
  }
  PassToLink(guard_.Allowed(), is_first, now_s);
  Exchange(now_s);
}

// At 9600 baud the line carries hardly more than one command for each picture: a second command
// for an old pose must not delay the first one for the next pose.
void RealRobot::Core::PassToLink(const control::WheelPower& power, bool is_first, double now_s) {
  const bool is_zero = power == control::WheelPower{};
  if (is_first || is_zero || now_s + link_.Occupied_s() <= next_pose_s_) {
    link_.Put(power, is_first);
  } else {
    link_.PutForLater(power);
  }
}

void RealRobot::Core::Stop() noexcept {
  try {
    const std::lock_guard lock(mutex_);
    const double now_s = clock_.Now_s();
    if (std::uncaught_exceptions() > 0) {
      guard_.Stop(StopReason::kException, "the trial ended with an error", now_s);
    } else {
      guard_.Stop(StopReason::kFinished, "the trial is over", now_s);
    }
    Exchange(now_s);
  } catch (...) {  // out of memory while a reason was written: the state is stopped all the same
  }
}

// A robot whose motors are stuck answers as well.
bool RealRobot::Core::StopIsConfirmed() {
  const std::lock_guard lock(mutex_);
  return HasStopped();
}

DriveRecord RealRobot::Core::Record() {
  const std::lock_guard lock(mutex_);
  DriveRecord record = record_;
  record.protocol = link_.protocol();
  record.stop = guard_.stop();
  if (record.stop) record.stop->at_s -= start_s_;
  if (link_.protocol() == Protocol::kFramed) record.stop_acknowledged = HasStopped();
  record.sent = link_.sent_count();
  record.answered = link_.answered_count();
  return record;
}

// An answer settles its pose and all before it; what has none by kSettled_s gets none.
DriveNews RealRobot::Core::TakeNews() {
  const std::lock_guard lock(mutex_);
  const double old_s = clock_.Now_s() - start_s_ - kSettled_s;
  const auto is_open = [old_s](const PoseStages& pose) {
    return pose.answered_s < 0.0 && pose.captured_s > old_s;
  };
  size_t settled = record_.poses.size();
  while (settled > poses_taken_ && is_open(record_.poses[settled - 1])) --settled;
  const auto poses = record_.poses.begin();
  DriveNews news{{poses + poses_taken_, poses + settled},
                 {record_.encoders.begin() + encoders_taken_, record_.encoders.end()}};
  poses_taken_ = settled;
  encoders_taken_ = record_.encoders.size();
  return news;
}

RealRobot::RealRobot(ByteLine& line, PoseSource& poses, Clock& clock,
                     const RealRobotOptions& options)
    : core_(std::make_unique<Core>(line, poses, clock, options)) {}

RealRobot::~RealRobot() {
  Stop();
  if (!core_->StopIsConfirmed()) ConfirmStop(kLastZeros_s);
}

void RealRobot::AddStopper(Stopper stopper) { core_->AddStopper(std::move(stopper)); }
void RealRobot::Arm() { core_->Arm(); }
trial::Sensed RealRobot::Sense() { return core_->Sense(); }
void RealRobot::Command(const control::WheelPower& power) { core_->Command(power); }
void RealRobot::Stop() noexcept { core_->Stop(); }
void RealRobot::SetCameraLatency(double latency_s) { core_->SetCameraLatency(latency_s); }
DriveState RealRobot::state() const { return core_->state(); }
DriveRecord RealRobot::Record() const { return core_->Record(); }
DriveNews RealRobot::TakeNews() { return core_->TakeNews(); }

void RealRobot::Advance(double dt_s) {
  const double end_s = core_->Now_s() + dt_s;
  double now_s = core_->Now_s();
  while (now_s < end_s) {
    core_->Wait(std::min(kTick_s, end_s - now_s));
    if (core_->HasNewPose()) return;
    now_s = core_->Now_s();
  }
}

void RealRobot::ConfirmStop(double timeout_s) {
  const double end_s = core_->Now_s() + timeout_s;
  while (core_->Now_s() < end_s && !core_->StopIsConfirmed()) core_->Wait(kTick_s);
}

}  // namespace rift::hardware
