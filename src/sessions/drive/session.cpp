#include "rift/sessions/drive/session.hpp"

#include <fmt/format.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <utility>

#include "folder.hpp"
#include "rift/experiment/task.hpp"
#include "rift/files/files.hpp"
#include "rift/hardware/camera_poses.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/report/json/json.hpp"
#include "rift/view/drive_view.hpp"
#include "rift/view/window.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/tracking/session.hpp"
#include "rift/vision/tracking/unseen_tag.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "standing_check.hpp"
#include "start_gate.hpp"
#include "view_loop.hpp"

namespace rift::sessions {
namespace {

// A window costs a decoded and drawn picture each time; the tracker needs the processor more.
constexpr std::chrono::milliseconds kRedraw{100};
// A robot at rest that was not seen for longer may stand elsewhere by now.
constexpr double kSeen_s = 0.5;

/// Throws std::invalid_argument, saying what to do, when the calibration has no world frame, or one
/// of another lens: the waypoints would mean nothing.
vision::CameraModel ReadCameraWithWorld(const std::string& calibration) {
  vision::CameraModel camera = vision::ReadCamera(files::ReadFile(calibration), calibration);
  if (const auto other = vision::WhyNotOfThisLens(camera)) {
    throw std::invalid_argument(fmt::format("{}: {}", calibration, *other));
  }
  if (camera.world) return camera;
  throw std::invalid_argument(fmt::format(
      "{}: the calibration has no world frame, so nobody knows where on the floor the waypoints "
      "are: lay reference tags on the floor and let rift track write it",
      calibration));
}

/// Throws hardware::StopAsked when `stopper` says so before a picture comes.
vision::Frame FirstPicture(vision::CameraSession& session, const hardware::Stopper& stopper) {
  std::optional<std::pair<hardware::StopReason, std::string>> stop;
  std::optional<vision::Frame> first =
      session.FirstPicture([&] { return !(stop = stopper()).has_value(); });
  if (!first) throw hardware::StopAsked{{stop->first, stop->second, 0.0}};
  return std::move(*first);
}

/// Holds the first picture against what a drive needs, and tells the operator what is amiss.
void CheckFirstPicture(const DriveSetup& setup, const Console& console,
                       vision::CameraSession& session, const hardware::Stopper& stopper) {
  const vision::Frame first = FirstPicture(session, stopper);
  if (session.capture().IsRecording()) {
    throw std::invalid_argument(fmt::format(
        "{} is a recording, and a robot is driven by what is seen now: name a device such as "
        "/dev/video0, or a stream such as http://camera/video",
        setup.address.camera));
  }
  const vision::TagOptions& tag = session.tag();
  const vision::Look look = session.LookAt(first, 1);
  if (look.robot_tags > 1) {
    throw std::runtime_error(fmt::format(
        "{} tags with the robot's id {} are in the picture: take away all but the robot's",
        look.robot_tags, tag.id));
  }
  const auto moved = vision::MovedWarning(look.moved_m, setup.session.moved_m);
  if (moved) console.say("warning: " + *moved);
  const auto unseen = vision::UnseenReferences(session.camera(), look);
  if (unseen) console.say("note: " + *unseen);
  if (look.robot_tags == 0) {
    console.say("the robot's tag is not in the picture yet: put the robot on its place");
  }
}

/// A program of --before-each may tell them, and may not.
void RequireAddress(const DriveAddress& address) {
  std::vector<std::string> missing;
  DriveAddress::Fields(address, [&](const char* key, const std::string& value, auto&&...) {
    if (value.empty()) missing.push_back(fmt::format("--{}", key));
  });
  if (missing.empty()) return;
  throw std::invalid_argument(
      fmt::format("{} {} missing, and --before-each told none: name {}, or let its program print "
                  "port, camera and calibration as one line of JSON",
                  fmt::join(missing, ", "), missing.size() == 1 ? "is" : "are",
                  missing.size() == 1 ? "it" : "them"));
}

bool HasArrived(const hardware::DriveRun& run) {
  return run.trial.outcome == trial::Outcome::kReached;
}

/// What was shown in place goes with it.
class ShownLine {
 public:
  explicit ShownLine(const Console& console) : console_(console) {}
  ~ShownLine() { console_.hide(); }
  ShownLine(const ShownLine&) = delete;
  ShownLine& operator=(const ShownLine&) = delete;

 private:
  const Console& console_;
};

}  // namespace

hardware::DriveTask DriveTaskOf(const experiment::Experiment& experiment) {
  return {experiment::TaskOf(experiment), experiment.control, experiment.trial,
          experiment.hardware};
}

std::vector<std::string> SteeringLines(const experiment::Experiment& experiment,
                                       const hardware::DriveRun& run) {
  return report::SteeringLines(report::SteeringOf(experiment, run), run.trial.limits);
}

bool WasEndedByPerson(const hardware::DriveRun& run) {
  using hardware::StopReason;
  const auto& stop = run.evidence.stop;
  return stop && (stop->reason == StopReason::kOperator || stop->reason == StopReason::kSignal);
}

bool WasEndedByFault(const hardware::DriveRun& run) {
  if (HasArrived(run) || WasEndedByPerson(run)) return false;
  const auto& stop = run.evidence.stop;
  const bool is_whole = !stop || stop->reason == hardware::StopReason::kFinished;
  return !is_whole || run.trial.outcome != trial::Outcome::kTimedOut;
}

/// All that a drive is made of, opened in the order in which it is cheap to fail.
class DriveSession::Drivers {
 public:
  /// `setup` and `console` must outlive it.
  Drivers(const DriveSetup& setup, const Console& console, const experiment::Experiment& experiment,
          const vision::CameraModel& camera, const hardware::Stopper& stopper)
      : setup_(setup),
        console_(console),
        port_(setup.address.port, experiment.hardware.line.baud,
              experiment.hardware.line.write_timeout_s),
        session_(setup.address.camera, camera, experiment.track.capture,
                 experiment::TagOn(experiment)),
        standing_(session_.camera(), session_.tag()) {
    CheckFirstPicture(setup, console, session_, stopper);
    const auto tracker = std::make_shared<vision::TagTracker>(session_.MakeTracker());
    poses_ = std::make_unique<hardware::CameraPoses>(
        session_.TakeCapture(),
        [this, tracker](const vision::Frame& frame) {
          vision::TrackResult found = tracker->Track(frame);
          if (found.sighting) standing_.Add(*found.sighting);
          return found;
        },
        clock_);
  }

  hardware::DriveRun Drive(const experiment::Experiment& experiment, hardware::Operator& person,
                           DriveLog& log) {
    has_started_ = false;
    may_start_ = setup_.yes;
    StartGate gate(experiment.hardware.start, experiment::TaskOf(experiment).Start(),
                   setup_.any_start || setup_.dry_run, PersonAtGate(person));
    hardware::DriveRun run = hardware::Drive(
        {.line = port_,
         .poses = *poses_,
         .clock = clock_,
         .stoppers = {person.Stopper(), WindowStopper(), log.Stopper()},
         .say = console_.say,
         .may_arm =
             [&] {
               RefuseTwoTags();
               SayIfOffFloor();
               // Not before the files are there: else a full disk stops a robot
               // that moves. The gate looks again when they are.
               has_started_ = gate.MayStart(clock_.Now_s(), SeenNow()) && log.IsReady();
               return has_started_.load();
             },
         .observer = &log,
         .why_unseen = [this] { return WhyUnseen(); },
         .dry_run = setup_.dry_run},
        DriveTaskOf(experiment));
    SayIfOffFloor();
    SayIfMoved();
    return run;
  }

  /// The window needs the main thread, so the robot is driven from another one.
  hardware::DriveRun DriveInView(const experiment::Experiment& experiment,
                                 hardware::Operator& person, DriveLog& log) {
    const std::string missing = view::MissingDisplay();
    if (!missing.empty()) {
      console_.say(missing + "; driving without --view");
      return Drive(experiment, person, log);
    }
    view::DriveView view(session_.camera(), experiment::TaskOf(experiment));
    key_in_window_ = false;
    const auto drive = [&] { return Drive(experiment, person, log); };
    const auto stop = [&person] { person.CloseWindow(); };
    const auto look = [&] {
      const hardware::CameraPoses::View seen = poses_->Seen();
      const view::DriveWish wish =
          view.Show(seen.frame.get(), seen.found.sighting, poses_->Status(),
                    PlacementNow(experiment), may_start_);
      if (wish == view::DriveWish::kStopByClosing) stop();
      if (wish == view::DriveWish::kStopByKey) key_in_window_ = true;
    };
    return sessions::DriveInView({.drive = drive, .look = look, .stop = stop, .redraw = kRedraw});
  }

  bool KeyInWindow() const { return key_in_window_; }
  const vision::CameraModel& camera() const { return session_.camera(); }
  vision::Ground ground() const { return session_.tag().ground; }

 private:
  StartGate::Person PersonAtGate(hardware::Operator& person) {
    StartGate::Person at_gate{.has_agreed =
                                  [this, &person] {
                                    may_start_ = person.MayArm(console_.say);
                                    return may_start_.load();
                                  },
                              .say = console_.say};
    if (!setup_.yes) at_gate.ask_again = [&person] { person.AskAgain(); };
    if (!setup_.yes) at_gate.show = console_.show;
    return at_gate;
  }

  hardware::Stopper WindowStopper() const {
    return [this]() -> std::optional<std::pair<hardware::StopReason, std::string>> {
      if (!key_in_window_) return std::nullopt;
      return std::pair(hardware::StopReason::kOperator,
                       std::string("a key was pressed in the window"));
    };
  }

  /// Throws std::runtime_error: of two tags with the robot's id nobody knows which one to steer.
  void RefuseTwoTags() const {
    const std::optional<vision::Sighting> seen = poses_->Seen().found.sighting;
    if (!seen || seen->tags_of_this_id < 2) return;
    throw std::runtime_error(fmt::format(
        "not armed: {} tags with the robot's id {} are in the picture: take away all but the "
        "robot's",
        seen->tags_of_this_id, session_.tag().id));
  }

  /// Empty where the newest picture shows no tag.
  std::string WhyUnseen() const {
    const std::shared_ptr<const vision::Frame> newest = poses_->Seen().frame;
    if (!newest) return "";
    const vision::TagOptions& tag = session_.tag();
    const std::vector<std::string> lines =
        report::UnseenLines(vision::LookForOthers(*newest, tag), tag.family, "--set track.tag.id=");
    return fmt::format("{}", fmt::join(lines, "; "));
  }

  /// A wrong side or height of the tag puts the robot elsewhere than it is seen to be.
  void SayIfOffFloor() {
    if (const auto warning = standing_.Take()) console_.say("warning: " + *warning);
  }

  /// Of a drive that is over, and before the next one of a series.
  void SayIfMoved() const {
    const std::shared_ptr<const vision::Frame> last = poses_->Seen().frame;
    if (!last) return;
    const auto moved =
        vision::MovedWarning(session_.LookAt(*last, 1).moved_m, setup_.session.moved_m);
    if (moved) console_.say("warning: after this drive " + *moved);
  }

  std::optional<geometry::Pose2> SeenNow() {
    const hardware::PoseNews news = poses_->Newest();
    if (!news.newest || clock_.Now_s() - news.newest->measured.captured_s > kSeen_s) return {};
    return news.newest->measured.world_from_robot;
  }

  std::string PlacementNow(const experiment::Experiment& experiment) {
    if (has_started_) return "";
    const std::optional<geometry::Pose2> seen = SeenNow();
    if (!seen) return "it is not seen";
    return PlacementText(PlacementOf(*seen, experiment::TaskOf(experiment).Start()));
  }

  const DriveSetup& setup_;
  const Console& console_;
  // For the window's thread: the robot is under way, and whether a person has let it start.
  std::atomic<bool> has_started_ = false, may_start_ = false;
  std::atomic<bool> key_in_window_ = false;  // by that thread
  hardware::SteadyClock clock_;
  hardware::SerialPort port_;
  vision::CameraSession session_;
  StandingCheck standing_;
  std::unique_ptr<hardware::CameraPoses> poses_;  // its thread tells standing_
};

DriveSession::DriveSession(DriveSetup setup, Console console)
    : setup_(std::move(setup)), console_(std::move(console)) {}
DriveSession::~DriveSession() = default;
void DriveSession::Close() { drivers_.reset(); }

void DriveSession::RequireLog() const {
  if (!log_failure_.empty()) throw std::runtime_error("the log is not whole: " + log_failure_);
}

void DriveSession::MoveTo(const DriveAddress& address) {
  Close();
  if (!address.port.empty()) setup_.address.port = address.port;
  if (!address.camera.empty()) setup_.address.camera = address.camera;
  if (!address.calibration.empty()) setup_.address.calibration = address.calibration;
}

hardware::DriveRun DriveSession::DriveInto(const std::filesystem::path& folder,
                                           const experiment::Experiment& experiment) {
  RequireAddress(setup_.address);
  RequireNoDrive(folder);
  const ShownLine line(console_);
  hardware::Operator person(setup_.yes);  // first, and last to go: a signal must not end a save
  log_failure_.clear();
  BegunFolder begun(folder);  // goes after the log, which removes what is its own
  DriveLog log(WriterInto(folder, experiment));
  // The next setting may be on a ramp, where the tag is not held to the floor.
  if (drivers_ && drivers_->ground() != experiment::TagOn(experiment).ground) Close();
  if (!drivers_) {
    try {
      drivers_ = std::make_unique<Drivers>(setup_, console_, experiment,
                                           ReadCameraWithWorld(setup_.address.calibration),
                                           person.Stopper());
    } catch (const hardware::StopAsked& asked) {
      stop_was_asked_ = true;
      return hardware::StoppedBeforeStart(asked.stop, setup_.dry_run);
    }
  }
  begun.Write(experiment, drivers_->camera());
  if (setup_.dry_run) console_.say("dry run: nothing moves, the robot is sent zeros alone");
  const hardware::DriveRun run = setup_.view ? drivers_->DriveInView(experiment, person, log)
                                             : drivers_->Drive(experiment, person, log);
  if (run.has_begun) begun.Keep();
  if (run.has_begun && !HasArrived(run)) console_.ring();
  if (run.has_begun) log_failure_ = CloseDrive(folder, experiment, run, log);
  const bool was_slow =
      run.evidence.stop && run.evidence.stop->reason == hardware::StopReason::kLogFailed;
  // Slow enough to stop the robot, even when it became whole in the end.
  if (was_slow && log_failure_.empty()) log_failure_ = run.evidence.stop->text;
  stop_was_asked_ = drivers_->KeyInWindow() || person.Stopper()().has_value();
  if (!HasArrived(run)) Close();
  return run;
}

}  // namespace rift::sessions
