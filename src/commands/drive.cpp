#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <future>
#include <memory>

#include "drive_camera.hpp"
#include "drive_files.hpp"
#include "drive_operator.hpp"
#include "drive_output.hpp"
#include "drive_run.hpp"
#include "drive_view.hpp"
#include "files.hpp"
#include "keys_flag.hpp"
#include "rift/commands/command.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/view/display.hpp"
#include "rift/vision/camera/camera_source.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

struct DriveRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string port;
  std::string camera;
  std::string calibration;
  std::string out;
  bool view = false;
  bool yes = false;
  bool ping = false;
  bool json = false;
};

void Say(const std::string& line) { fmt::print(stderr, "{}\n", line); }

experiment::Experiment LoadFor(const DriveRequest& request) {
  return experiment::LoadExperiment(request.experiment, request.overrides,
                                    [](const std::string& path) { return ReadFile(path); });
}

int PingRobot(const DriveRequest& request) {
  hardware::HardwareOptions options;
  if (!request.experiment.empty()) options = LoadFor(request).hardware;
  hardware::SerialPort port(request.port, options.line.baud, options.line.write_timeout_s);
  hardware::SteadyClock clock;
  const hardware::PingResult ping = MeasureLink(port, clock, options);
  fmt::print("{}", request.json ? PingJson(ping, options) : PingText(ping, options));
  const bool is_good = ping.IsMeasured() && hardware::BrokenBudget(ping, options.ping).empty();
  return is_good ? kDone : kNotReached;
}

void RequireAll(const DriveRequest& request) {
  if (request.experiment.empty()) {
    throw std::invalid_argument("EXPERIMENT is missing: name a YAML file with waypoints");
  }
  if (request.camera.empty()) {
    throw std::invalid_argument(
        "--camera is missing: name a device such as /dev/video0, or an http:// stream");
  }
  if (request.calibration.empty()) {
    throw std::invalid_argument(
        "--calibration is missing: name the camera's YAML file, which rift track --calibrate "
        "writes");
  }
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

/// All that a drive is made of, opened in the order in which it is cheap to fail.
class Drivers {
 public:
  Drivers(const DriveRequest& request, const experiment::Experiment& experiment,
          const vision::CameraModel& camera)
      : experiment_(experiment),
        person_(request.yes),
        port_(request.port, experiment.hardware.line.baud,
              experiment.hardware.line.write_timeout_s),
        camera_(OpenDriveCamera(request.camera, camera, experiment)) {
    for (const std::string& warning : WarningsOf(camera_)) Say(warning);
    poses_ = std::make_unique<hardware::CameraPoses>(
        std::move(camera_.capture),
        [tracker = std::make_shared<vision::TagTracker>(camera_.model, experiment.track.tag,
                                                        vision::SteadyNow_s)](
            const vision::Frame& frame) { return tracker->Track(frame); },
        clock_);
  }

  DriveRun Drive() {
    return commands::Drive({.line = port_,
                            .poses = *poses_,
                            .clock = clock_,
                            .stoppers = {person_.Stopper()},
                            .say = Say,
                            .may_arm = [this] { return person_.MayArm(Say); }},
                           experiment_);
  }

  /// The window needs the main thread, so the robot is driven from another one.
  DriveRun DriveInView() {
    const std::string missing = view::MissingDisplay();
    if (!missing.empty()) {
      Say(missing + "; driving without --view");
      return Drive();
    }
    view::TrackWindow window("rift drive");
    std::future<DriveRun> drive = std::async(std::launch::async, [this] { return Drive(); });
    ShowUntilOver(drive, window, *poses_, camera_.model, experiment_, person_);
    return drive.get();
  }

  const vision::CameraModel& camera() const { return camera_.model; }

 private:
  const experiment::Experiment& experiment_;
  DriveOperator person_;
  hardware::SteadyClock clock_;
  hardware::SerialPort port_;
  DriveCamera camera_;
  std::unique_ptr<hardware::CameraPoses> poses_;
};

int DriveRobot(const DriveRequest& request) {
  RequireAll(request);
  const experiment::Experiment experiment = LoadTask(request);
  const fs::path folder = NewFolder(request, experiment);
  Drivers drivers(request, experiment, ReadDriveCamera(request.calibration));
  BeginDriveFolder(folder, experiment, drivers.camera());
  const DriveRun run = request.view ? drivers.DriveInView() : drivers.Drive();
  if (run.has_begun) {
    SaveDrive(folder, experiment, run);
    Say("log: " + (folder / "trajectory.csv").string());
  }
  fmt::print("{}", request.json ? DriveJson(experiment, run) : DriveText(run));
  return run.trial.outcome == trial::Outcome::kReached ? kDone : kNotReached;
}

void AddDriveFlags(CLI::App& app, DriveRequest& request) {
  CLI::Option* experiment = app.add_option("EXPERIMENT", request.experiment,
                                           "YAML file with the waypoints; its key hardware: holds "
                                           "the link's settings and limits");
  app.add_option("--set", request.overrides, "sets one key, such as hardware.line.baud=115200")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false)
      ->needs(experiment);
  app.add_option("--port", request.port, "the robot's serial port, such as /dev/rfcomm0")
      ->required()
      ->type_name("TTY");
  app.add_option("--camera", request.camera,
                 "the camera above the floor: /dev/video0, or an http:// or rtsp:// stream")
      ->type_name("DEVICE|URL");
  app.add_option("--calibration", request.calibration,
                 "the camera's lens and where it hangs, as rift track writes them")
      ->type_name("FILE.yaml");
  app.add_option("--out", request.out, "folder of the run; must not hold one [out/NAME_drive]")
      ->type_name("DIR");
  app.add_flag("--view", request.view, "show the camera's picture; closing it stops the robot");
  app.add_flag("--yes", request.yes, "start at once instead of when Enter is pressed");
  app.add_flag("--ping", request.ping, "only measure the link, with the motors at zero");
  app.add_flag("--json", request.json, "print JSON instead of text");
}

}  // namespace

void AddDrive(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<DriveRequest>();
  AddDriveFlags(app, *request);
  AddKeysFlag(app);
  app.footer(
      "Enter starts the robot. Any key, Ctrl-C, SIGTERM or SIGHUP stops it for good, as do a tag "
      "or\n"
      "picture that stays away, a pose that jumps, and a radio that falls silent.\n"
      "Ends with 0 when the last waypoint was reached, 1 when it was not or the robot was stopped\n"
      "(--ping: when the link is over its budget or cannot be measured), 2 for usage and input, 3\n"
      "when it could not begin or broke.\n"
      "Example: rift drive --ping --port /dev/rfcomm0\n"
      "         rift drive configs/waypoints/paper.yaml --port /dev/rfcomm0 --camera /dev/video0 "
      "\\\n"
      "             --calibration cam.yaml --out out/real1");
  app.callback([request, &exit_code] {
    exit_code = request->ping ? PingRobot(*request) : DriveRobot(*request);
  });
}

}  // namespace rift::commands
