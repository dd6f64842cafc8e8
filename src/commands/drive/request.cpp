#include "request.hpp"

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <utility>

#include "rift/commands/drive/drive.hpp"
#include "rift/files/files.hpp"

namespace rift::commands {
namespace {

void AddDriveFlags(CLI::App& app, DriveRequest& request) {
  FlagMaker flags(app);
  app.add_option("EXPERIMENT", request.experiment,
                 "YAML file with the waypoints; its key hardware: holds "
                 "the link's settings and limits");
  AddSetFlag(app, request.overrides, "hardware.line.baud=115200");
  AddFlags(app, request.setup.address);
  // Of how the reference tags are watched, what matters before a start.
  vision::SessionOptions::Fields(request.setup.session, [&](std::string_view key, auto&&... field) {
    if (key == "moved_m") flags(key, std::forward<decltype(field)>(field)...);
  });
  flags("out", request.out, "DIR",
        "folder of the run; must not hold a file of one [out/NAME_drive]");
  AddFlags(app, request.copies);
  flags("view", request.setup.view,
        "show the camera's picture; any key in it, or closing it, stops the robot");
  flags("yes", request.setup.yes,
        "answers Enter to every question: starts without a person; a series ends with its first "
        "fault "
        "unless --before-each puts the scene back");
  flags("countdown", request.countdown_s, 0.0, 60.0, "S",
        "time between Enter and the start, in which any key cancels; 0: none "
        "(hardware.start.countdown_s)");
  flags("any_start", request.setup.any_start,
        "start even when the robot stands far off its start (hardware.start)");
  AddAnyWaypointsFlag(app, request.any_waypoints);
  flags("ping", request.ping,
        "only measure the link, with the motors at zero; flags of a drive are refused beside it");
  flags("dry_run", request.setup.dry_run,
        "all of a drive but motor power: the robot is sent zeros alone, and may be carried along "
        "the waypoints");
  flags("seconds", request.seconds, 0.01, 3600.0, "S",
        "ends a dry run after so long (trial.timeout_s)");
  AddFlags(app, request.series);
  flags("json", request.json, "print JSON instead of text");
  flags("replay", request.replay, "DIR",
        "show a drive that was, finished or interrupted, in a window: its folder");
  flags("video", request.video, "FILE.mp4",
        "with --replay: write a film instead; --view shows it as well");
  flags("force", request.force,
        "with --video, --tum or --mcap: replace a file that is there already");
}

void ExcludeFlags(CLI::App& app) {
  using flags::Exclude;
  app.get_option("--seconds")->needs(app.get_option("--dry-run"));
  app.get_option("--video")->needs(app.get_option("--replay"));
  Exclude(app, "--dry-run", {"--repeat", "--grid", "--identify", "--suggested"});
  Exclude(app, "--grid", {"--repeat", "--identify", "--suggested"});
  Exclude(app, "--suggested", {"EXPERIMENT", "--out", "--ping", "--identify", "--repeat"});
  // A ping is no drive: it sees no camera, moves nothing and leaves nothing.
  Exclude(app, "--ping",
          {"--camera", "--calibration", "--moved", "--out", "--view", "--yes", "--countdown",
           "--any-start", "--any-waypoints", "--dry-run", "--repeat", "--grid", "--identify",
           "--before-each"});
  // No robot, no camera: what belongs to them is refused beside it.
  Exclude(app, "--replay",
          {"EXPERIMENT", "--set", "--port", "--camera", "--calibration", "--moved", "--out",
           "--yes", "--countdown", "--any-start", "--any-waypoints", "--ping", "--dry-run",
           "--json", "--suggested", "--identify", "--repeat", "--grid", "--before-each"});
}

}  // namespace

void DriveRequest::Check() const {
  std::vector<std::filesystem::path> files = copies.Files();
  Refuse({{!video.empty() && !video.ends_with(".mp4"),
           "--video " + video + ": the name must end in .mp4"},
          {!files.empty() && (ping || series.IsSeries()),
           "--tum and --mcap are copies of one drive's log"},
          {force && files.empty() && video.empty(),
           "--force is for --video, --tum and --mcap: a drive that is there is never replaced"}});
  if (!video.empty()) files.emplace_back(video);
  CheckOutputs({}, {.files = files, .folder = replay, .force = force});
  if (!replay.empty()) return;
  RequireFolderName(out, "a drive");
  const bool has_task = !experiment.empty() || !series.suggested.empty();
  const bool is_told_later = series.IsSeries() && !series.before_each.empty();
  Refuse({{setup.address.port.empty() && !is_told_later,
           "--port is missing: name the robot's serial port, such as /dev/rfcomm0"},
          {!has_task && !overrides.empty(),
           "--set changes an experiment: name EXPERIMENT, its YAML file"},
          {series.identify && series.repeat == 1,
           "--identify with --repeat 1: a fit needs at least 2 drives"}});
  if (ping) return;
  Refuse({{!series.before_each.empty() && WordsOf(series.before_each).empty(),
           "--before-each '" + series.before_each + "' is blank: name the program to run"},
          {!series.before_each.empty() && !series.IsSeries(),
           "--before-each goes with --repeat, --grid, --identify or --suggested"},
          {!has_task, "EXPERIMENT is missing: name a YAML file with waypoints"},
          {setup.address.camera.empty() && !is_told_later,
           "--camera is missing: name a device such as /dev/video0, or an http:// stream"},
          {setup.address.calibration.empty() && !is_told_later,
           "--calibration is missing: name the camera's YAML file, which rift track --calibrate "
           "writes"}});
}

std::vector<std::string> WordsOf(const std::string& command) {
  return CLI::detail::split_up(command);
}

void AddDrive(CLI::App& app, int& exit_code, const std::function<int(const DriveRequest&)>& drive) {
  const auto request = std::make_shared<DriveRequest>();
  AddDriveFlags(app, *request);
  AddKeysFlag(app);
  ExcludeFlags(app);
  app.footer(
      "Enter starts the robot. Any key from then on (in the window of --view too), Ctrl-C, "
      "Ctrl-\\,\n"
      "Ctrl-Z, SIGTERM or SIGHUP stops it, and a series with it, for good, as do a tag or picture\n"
      "that stays away, a pose that jumps, and a radio that falls silent.\n"
      "Ends with 0 when the last waypoint was reached (a dry run: also when a person or its time\n"
      "ended it), 1 when it was not, the robot was stopped, or it did not acknowledge its stop\n"
      "(--ping: when the link is over its budget or cannot be measured), 2 for usage and input,\n"
      "3 when it could not begin or broke, or when its log could not be written: that stops the\n"
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
    request->experiment = files::FindInput(request->experiment);
    request->Check();
    exit_code = drive(*request);
  });
}

}  // namespace rift::commands
