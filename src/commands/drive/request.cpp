#include "request.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <utility>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/drive/drive.hpp"

namespace rift::commands {
namespace {

/// No robot, no camera: what belongs to them is refused beside it.
void AddReplayFlags(CLI::App& app, DriveRequest& request) {
  CLI::Option* replay =
      app.add_option("--replay", request.replay,
                     "show a drive that was, finished or interrupted, in a window: its folder");
  replay->type_name("DIR");
  for (const char* other : {"EXPERIMENT", "--set", "--port", "--camera", "--calibration", "--out",
                            "--yes", "--ping", "--json", "--suggested", "--identify"}) {
    replay->excludes(app.get_option(other));
  }
  app.add_option("--video", request.video,
                 "with --replay: write a film instead; --view shows it as well")
      ->needs(replay)
      ->type_name("FILE.mp4");
  app.add_flag("--force", request.force,
               "with --video, --tum or --mcap: replace a file that is there already");
}

void AddSeriesFlags(CLI::App& app, DriveRequest& request) {
  CLI::Option* dry_run =
      app.add_flag("--dry-run", request.setup.dry_run,
                   "all of a drive but motor power: the robot is sent zeros alone, and may be "
                   "carried along the waypoints");
  app.add_option("--seconds", request.seconds, "ends a dry run after so long (trial.timeout_s)")
      ->type_name("S")
      ->check(InRange(0.01, 3600.0))
      ->needs(dry_run);
  CLI::Option* repeat =
      app.add_option("--repeat", request.repeat,
                     "drive so many times, into DIR/1, DIR/2, ...; the same command goes on after "
                     "a break")
          ->type_name("N")
          ->check(InRange(1, 1000))
          ->excludes(dry_run);
  CLI::Option* grid = app.add_flag(
      "--grid", request.grid,
      "drive every setting of the experiment's space, reference.trials times each, and "
      "report on them against the simulator; the same command goes on after a break");
  grid->excludes(dry_run)->excludes(repeat);
  app.add_flag("--identify", request.identify,
               "drive a program that tells what waypoint drives cannot, instead of the waypoints, "
               "and write DIR/sweep.yaml, which fits the simulated robot to it; half a minute on "
               "1 m by 1 m, as often as --repeat says [5]")
      ->excludes(dry_run)
      ->excludes(grid);
  CLI::Option* suggested =
      app.add_option("--suggested", request.suggested,
                     "drive the experiments that rift sweep --suggest wrote into its folder, into "
                     "DIR/suggested; the same sweep takes their logs in");
  suggested->type_name("DIR")->excludes(dry_run)->excludes(repeat)->excludes(grid);
  for (const char* other : {"EXPERIMENT", "--out", "--ping", "--identify"}) {
    suggested->excludes(app.get_option(other));
  }
  app.add_option(
         "--before-each", request.before_each,
         "program to run before each trial of --repeat, --grid, --identify or --suggested; {trial} "
         "and the "
         "settings' names such as {surface} are filled in. It ends with 0, or prints "
         "port, camera and calibration as a line of JSON and is ended after the trial")
      ->type_name("COMMAND");
}

void AddDriveFlags(CLI::App& app, DriveRequest& request) {
  app.add_option("EXPERIMENT", request.experiment,
                 "YAML file with the waypoints; its key hardware: holds "
                 "the link's settings and limits");
  AddSetFlag(app, request.overrides, "hardware.line.baud=115200");
  app.add_option("--port", request.setup.address.port,
                 "the robot's serial port, such as /dev/rfcomm0")
      ->type_name("TTY");
  app.add_option("--camera", request.setup.address.camera,
                 "the camera above the floor: /dev/video0, or an http:// or rtsp:// stream")
      ->type_name("DEVICE|URL");
  app.add_option("--calibration", request.setup.address.calibration,
                 "the camera's lens and where it hangs, as rift track writes them")
      ->type_name("FILE.yaml");
  // Of how the reference tags are watched, what matters before a start.
  FlagMaker make_flag(app);
  vision::SessionOptions::Fields(request.setup.session, [&](std::string_view key, auto&&... field) {
    if (key == "moved_m") make_flag(key, std::forward<decltype(field)>(field)...);
  });
  app.add_option("--out", request.out, "folder of the run; must not hold one [out/NAME_drive]")
      ->type_name("DIR");
  AddLogCopyFlags(app, request.copies);
  app.add_flag("--view", request.setup.view,
               "show the camera's picture; closing it stops the robot");
  app.add_flag("--yes", request.setup.yes,
               "answers Enter to every question: starts without a person");
  app.add_option("--countdown", request.countdown_s,
                 "time between Enter and the start, in which any key cancels; 0: none "
                 "(hardware.start.countdown_s)")
      ->type_name("S")
      ->check(InRange(0.0, 60.0));
  app.add_flag("--any-start", request.setup.any_start,
               "start even when the robot stands far off its start (hardware.start)");
  AddAnyWaypointsFlag(app, request.any_waypoints);
  app.add_flag("--ping", request.ping, "only measure the link, with the motors at zero");
  AddSeriesFlags(app, request);
  app.add_flag("--json", request.json, "print JSON instead of text");
  AddReplayFlags(app, request);
}

}  // namespace

void DriveRequest::Check() const {
  if (!video.empty() && !video.ends_with(".mp4")) {
    throw std::invalid_argument("--video " + video + ": the name must end in .mp4");
  }
  std::vector<std::filesystem::path> files = copies.Files();
  if (!files.empty() && (ping || IsSeries())) {
    throw std::invalid_argument("--tum and --mcap are copies of one drive's log");
  }
  if (!video.empty()) files.emplace_back(video);
  if (force && files.empty()) {
    throw std::invalid_argument(
        "--force is for --video, --tum and --mcap: a drive that is there is never replaced");
  }
  CheckOutputs({}, {.files = files, .folder = replay, .force = force});
  if (!replay.empty()) return;
  RequireFolderName(out, "a drive");
  const bool is_told_later = IsSeries() && !before_each.empty();
  if (setup.address.port.empty() && !is_told_later) {
    throw std::invalid_argument(
        "--port is missing: name the robot's serial port, such as /dev/rfcomm0");
  }
  if (experiment.empty() && suggested.empty() && !overrides.empty()) {
    throw std::invalid_argument("--set changes an experiment: name EXPERIMENT, its YAML file");
  }
  if (identify && repeat == 1) {
    throw std::invalid_argument("--identify with --repeat 1: a fit needs at least 2 drives");
  }
  if (ping) return;
  if (!before_each.empty() && !IsSeries()) {
    throw std::invalid_argument(
        "--before-each goes with --repeat, --grid, --identify or --suggested");
  }
  if (experiment.empty() && suggested.empty()) {
    throw std::invalid_argument("EXPERIMENT is missing: name a YAML file with waypoints");
  }
  if (is_told_later) return;
  if (setup.address.camera.empty()) {
    throw std::invalid_argument(
        "--camera is missing: name a device such as /dev/video0, or an http:// stream");
  }
  if (setup.address.calibration.empty()) {
    throw std::invalid_argument(
        "--calibration is missing: name the camera's YAML file, which rift track --calibrate "
        "writes");
  }
}

std::vector<std::string> WordsOf(const std::string& command) {
  return CLI::detail::split_up(command);
}

void AddDrive(CLI::App& app, int& exit_code, const std::function<int(const DriveRequest&)>& drive) {
  const auto request = std::make_shared<DriveRequest>();
  AddDriveFlags(app, *request);
  AddKeysFlag(app);
  app.footer(
      "Enter starts the robot. Any key, Ctrl-C, SIGTERM or SIGHUP stops it for good, as do a tag "
      "or\n"
      "picture that stays away, a pose that jumps, and a radio that falls silent.\n"
      "Ends with 0 when the last waypoint was reached, 1 when it was not or the robot was stopped\n"
      "(--ping: when the link is over its budget or cannot be measured), 2 for usage and input, 3\n"
      "when it could not begin or broke, or when its log could not be written: that stops the "
      "robot.\n"
      "Example: rift drive --ping --port /dev/rfcomm0\n"
      "         rift drive configs/waypoints/paper.yaml --port /dev/rfcomm0 --camera /dev/video0 "
      "\\\n"
      "             --calibration cam.yaml --out out/real1\n"
      "         rift drive --replay out/real1\n"
      "         rift drive EXPERIMENT --grid --set reference.trials=3 --port ... (whole table)\n"
      "         rift drive EXPERIMENT --identify --out out/identify --port ... (then: rift sweep "
      "out/identify/sweep.yaml --write-robot robot.yaml)\n"
      "         rift drive --suggested out/sweep --port ... (what rift sweep --suggest wrote)\n"
      "         rift drive configs/twin.yaml --repeat 3 --yes --before-each \\\n"
      "             'rift simulate configs/twin.yaml --twin --force --seed {trial} --out "
      "out/twin{trial}'");
  app.callback([request, drive, &exit_code] {
    request->experiment = FindInput(request->experiment);
    request->Check();
    exit_code = drive(*request);
  });
}

}  // namespace rift::commands
