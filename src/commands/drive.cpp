#include "drive.hpp"

#include <fmt/format.h>

#include <future>
#include <memory>
#include <stdexcept>

#include "files.hpp"
#include "print.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/hardware/arming.hpp"
#include "rift/hardware/camera_poses.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/report/json/json.hpp"
#include "rift/view/drive_view.hpp"
#include "rift/view/window.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/tracking/session.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

// A window costs a decoded and drawn picture each time; the tracker needs the processor more.
constexpr std::chrono::milliseconds kRedraw{100};

experiment::Experiment LoadFor(const DriveRequest& request) {
  return experiment::LoadExperiment(request.experiment, request.overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

int PingRobot(const DriveRequest& request) {
  hardware::HardwareOptions options;
  if (!request.experiment.empty()) options = LoadFor(request).hardware;
  hardware::SerialPort port(request.port, options.line.baud, options.line.write_timeout_s);
  hardware::SteadyClock clock;
  const hardware::PingResult ping = hardware::MeasureLink(port, clock, options);
  request.json ? PrintData(report::PingJson(ping, options))
               : PrintText(report::PingText(ping, options));
  const bool is_good = ping.IsMeasured() && hardware::BrokenBudget(ping, options.ping).empty();
  return is_good ? kDone : kNotReached;
}

experiment::Experiment LoadTask(const DriveRequest& request) {
  experiment::Experiment experiment = LoadFor(request);
  try {
    control::CheckWaypoints(experiment.waypoints);
  } catch (const std::invalid_argument& no_task) {
    throw std::invalid_argument(fmt::format("{}: {}", request.experiment, no_task.what()));
  }
  return experiment;
}

// A robot's run cannot be repeated to the byte as a simulated one can.
fs::path NewFolder(const DriveRequest& request, const experiment::Experiment& experiment) {
  fs::path folder =
      request.out.empty() ? OutputOf("", experiment.name + "_drive") : fs::path(request.out);
  if (!fs::exists(folder / "trajectory.csv")) return folder;
  throw std::invalid_argument(fmt::format(
      "{} holds a run already, and a robot does not repeat itself: choose another --out",
      folder.string()));
}

/// Throws std::invalid_argument, saying what to do, when the calibration has no world frame: the
/// waypoints would mean nothing.
vision::CameraModel ReadCameraWithWorld(const std::string& calibration) {
  vision::CameraModel camera = vision::ReadCamera(files::ReadFile(calibration), calibration);
  if (camera.world) return camera;
  throw std::invalid_argument(fmt::format(
      "{}: the calibration has no world frame, so nobody knows where on the floor the waypoints "
      "are: lay reference tags on the floor and let rift track write it",
      calibration));
}

/// Holds the first picture against what a drive needs, and tells the operator what is amiss.
void CheckFirstPicture(const DriveRequest& request, vision::CameraSession& session) {
  const vision::Frame first = session.FirstPicture();
  if (session.capture().IsRecording()) {
    throw std::invalid_argument(fmt::format(
        "{} is a recording, and a robot is driven by what is seen now: name a device such as "
        "/dev/video0, or a stream such as http://camera/video",
        request.camera));
  }
  const vision::TagOptions& tag = session.tag();
  const vision::Look look = session.LookAt(first, tag.acquire_decimate);
  if (look.robot_tags > 1) {
    throw std::runtime_error(fmt::format(
        "{} tags with the robot's id {} are in the picture: take away all but the robot's",
        look.robot_tags, tag.id));
  }
  const auto moved = vision::MovedWarning(look.moved_m, request.session.moved_m);
  if (moved) Say("warning: " + *moved);
  if (look.robot_tags == 0) {
    Say("the robot's tag is not in the picture yet: put the robot on its place");
  }
}

/// All that a drive is made of, opened in the order in which it is cheap to fail.
class Drivers {
 public:
  Drivers(const DriveRequest& request, const experiment::Experiment& experiment,
          const vision::CameraModel& camera, DriveLog& log)
      : experiment_(experiment),
        log_(log),
        person_(request.yes),
        port_(request.port, experiment.hardware.line.baud,
              experiment.hardware.line.write_timeout_s),
        session_(request.camera, camera, experiment.track.capture, experiment.track.tag) {
    CheckFirstPicture(request, session_);
    const auto tracker = std::make_shared<vision::TagTracker>(session_.MakeTracker());
    poses_ = std::make_unique<hardware::CameraPoses>(
        session_.TakeCapture(),
        [tracker](const vision::Frame& frame) { return tracker->Track(frame); }, clock_);
  }

  hardware::DriveRun Drive() {
    return hardware::Drive({.line = port_,
                            .poses = *poses_,
                            .clock = clock_,
                            .stoppers = {person_.Stopper(), log_.Stopper()},
                            .say = Say,
                            .may_arm = [this] { return person_.MayArm(Say); },
                            .observer = &log_},
                           TaskOf(experiment_));
  }

  /// The window needs the main thread, so the robot is driven from another one.
  hardware::DriveRun DriveInView() {
    const std::string missing = view::MissingDisplay();
    if (!missing.empty()) {
      Say(missing + "; driving without --view");
      return Drive();
    }
    view::DriveView view(session_.camera(), experiment_.waypoints);
    auto drive = std::async(std::launch::async, [this] { return Drive(); });
    while (drive.wait_for(kRedraw) != std::future_status::ready) {
      const hardware::CameraPoses::View seen = poses_->Seen();
      const bool goes_on = view.Show(seen.frame.get(), seen.found.sighting, poses_->Status());
      if (!goes_on) person_.CloseWindow();
    }
    return drive.get();
  }

  const vision::CameraModel& camera() const { return session_.camera(); }

 private:
  const experiment::Experiment& experiment_;
  DriveLog& log_;
  hardware::Operator person_;
  hardware::SteadyClock clock_;
  hardware::SerialPort port_;
  vision::CameraSession session_;
  std::unique_ptr<hardware::CameraPoses> poses_;
};

/// The log was slow enough to stop the robot, even when it became whole in the end.
bool WasStoppedByLog(const hardware::DriveRun& run) {
  return run.evidence.stop && run.evidence.stop->reason == hardware::StopReason::kLogFailed;
}

int DriveRobot(const DriveRequest& request) {
  const experiment::Experiment experiment = LoadTask(request);
  const fs::path folder = NewFolder(request, experiment);
  DriveLog log(WriterInto(folder, experiment));
  Drivers drivers(request, experiment, ReadCameraWithWorld(request.calibration), log);
  BeginDriveFolder(folder, experiment, drivers.camera());
  const hardware::DriveRun run = request.view ? drivers.DriveInView() : drivers.Drive();
  const std::string failure = run.has_begun ? CloseDrive(folder, experiment, run, log) : "";
  const bool is_whole = failure.empty();
  if (run.has_begun && is_whole) Say("log: " + (folder / "trajectory.csv").string());
  const auto state = is_whole ? report::RunState::kFinished : report::RunState::kInterrupted;
  request.json ? PrintData(report::DriveJson(experiment, run, state))
               : PrintText(report::DriveText(run));
  if (!is_whole) throw std::runtime_error("the log is not whole: " + failure);
  if (WasStoppedByLog(run)) throw std::runtime_error(run.evidence.stop->text);
  return run.trial.outcome == trial::Outcome::kReached ? kDone : kNotReached;
}

}  // namespace

hardware::DriveTask TaskOf(const experiment::Experiment& experiment) {
  return {experiment.waypoints, experiment.control, experiment.trial, experiment.hardware};
}

void BeginDriveFolder(const std::filesystem::path& folder, const experiment::Experiment& experiment,
                      const vision::CameraModel& camera) {
  files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(folder / "camera.yaml", vision::WriteCamera(camera));
}

DriveLog::Write WriterInto(const std::filesystem::path& folder,
                           const experiment::Experiment& experiment) {
  const auto files = std::make_shared<DriveFiles>(folder, report::InterruptedDriveJson(experiment));
  return [files](const DriveRows& rows, std::atomic<unsigned>& progress) {
    files->Write(rows, progress);
  };
}

// A disk that failed is not written to again: it may hang.
std::string CloseDrive(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const hardware::DriveRun& run,
                       DriveLog& log) {
  std::string failure = log.Close(run.evidence);
  if (failure.empty()) {
    files::WriteFile(folder / "summary.json", report::DriveJson(experiment, run));
  }
  return failure;
}

int Drive(const DriveRequest& request) {
  if (!request.replay.empty()) return ReplayDrive(request);
  return request.ping ? PingRobot(request) : DriveRobot(request);
}

}  // namespace rift::commands
