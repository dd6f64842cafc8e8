#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "enum_name.hpp"
#include "files.hpp"
#include "flags.hpp"
#include "keys_flag.hpp"
#include "logs.hpp"
#include "rift/commands/command.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/view/display.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "stop_signal.hpp"
#include "track_calibrate.hpp"
#include "track_names.hpp"
#include "track_output.hpp"
#include "track_request.hpp"
#include "track_run.hpp"
#include "track_world.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void Say(const std::string& line) {
  fmt::print(stderr, "{}\n", line);
  std::fflush(stderr);
}

experiment::TrackOptions OptionsOf(const TrackRequest& request) {
  const auto read = [&](const std::string& path) {
    return request.experiment.empty() ? std::string("{}") : ReadFile(path);
  };
  const std::string path = request.experiment.empty() ? "defaults" : request.experiment;
  experiment::TrackOptions options =
      experiment::LoadExperiment(path, request.overrides, read).track;
  if (request.fps) options.capture.fps = *request.fps;
  return options;
}

experiment::Experiment LoadPath(const std::string& path) {
  return experiment::LoadExperiment(path, {}, [](const std::string& p) { return ReadFile(p); });
}

/// A waypoint file or, told by its ending, a log.
TrackView::Content ContentOf(const TrackRequest& request) {
  TrackView::Content content{.record_to = request.record_waypoints};
  if (request.path.empty()) return content;
  if (fs::path(request.path).extension() == ".csv") {
    const trajectory::Log log = LoadLog(request.path, trajectory::Format::kAuto);
    for (const auto& pose : log.trajectory.poses) content.path_m.push_back(pose.Position());
    return content;
  }
  content.planned = LoadPath(request.path).waypoints;
  for (const auto& waypoint : content.planned) content.path_m.push_back(waypoint.Position());
  return content;
}

std::unique_ptr<TrackView> ViewFor(const TrackRequest& request, const vision::CameraModel& camera,
                                   TrackView::Content content) {
  if (!request.view && request.record_waypoints.empty()) return nullptr;
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    Say(fmt::format("{}; tracking goes on without{}", missing,
                    request.record_waypoints.empty() ? "" : ", no waypoints can be recorded"));
    return nullptr;
  }
  return std::make_unique<TrackView>(camera, std::move(content));
}

/// Files of other programs may lack the picture's size; then the first picture has to be trusted.
void TakeSizeFrom(vision::Capture& capture, const TrackRequest& request,
                  const experiment::TrackOptions& options, vision::CameraModel& camera) {
  if (camera.width_px > 0 && camera.height_px > 0) return;
  const auto frame = capture.Next(options.capture.open_timeout_s);
  if (!frame) {
    const vision::CaptureStatus status = capture.Status();
    throw std::runtime_error(fmt::format("camera {}: {}", NameOf(status.state), status.reason));
  }
  camera.width_px = frame->width_px;
  camera.height_px = frame->height_px;
  Say(fmt::format("note: {} does not say for which size it was made; {}x{} is taken as given",
                  request.calibration, camera.width_px, camera.height_px));
}

/// What was calibrated at one size is asked of the camera at that size.
vision::CaptureOptions CaptureFor(const vision::CameraModel& camera,
                                  vision::CaptureOptions options) {
  if (camera.width_px > 0) options.width_px = camera.width_px;
  if (camera.height_px > 0) options.height_px = camera.height_px;
  return options;
}

void CheckTracking(const TrackRequest& request) {
  if (request.camera.empty()) throw std::invalid_argument("--camera is missing");
  if (request.calibration.empty()) {
    throw std::invalid_argument(
        "--calibration is missing: rift track --calibrate makes one from pictures of a chessboard");
  }
  if (request.out.empty() && request.world.empty()) {
    throw std::invalid_argument("--out LOG.csv is missing: where shall the poses go?");
  }
  if (!request.out.empty()) CheckLogName(request);
  if (!request.images.empty() || !request.picture.empty()) {
    throw std::invalid_argument("--images and --picture belong to --calibrate");
  }
}

/// The comment lines that a file begins with, where people wrote what they know of the camera.
std::string HeadOf(const std::string& text) {
  std::size_t end = 0;
  while (end < text.size() && text[end] == '#')
    end = std::min(text.find('\n', end), text.size() - 1) + 1;
  return text.substr(0, end);
}

void SetAndStoreWorld(const TrackRequest& request, const WorldParts& parts,
                      vision::CameraModel& camera) {
  camera.world = SetWorld(parts, camera, request.world);
  WriteFile(request.calibration,
            HeadOf(ReadFile(request.calibration)) + vision::WriteCamera(camera));
  Say(fmt::format("world frame from {}, {:.2f} mm off at its points, is now in {}",
                  camera.world->origin, 1e3 * camera.world->residual_m, request.calibration));
}

int Report(const TrackRequest& request, const vision::CameraModel& camera,
           const experiment::TrackOptions& options, const TrackRun& run, int rows) {
  const fs::path run_file = RunFileOf(request.out);
  WriteFile(run_file, TrackJson(request, camera, options, run, rows));
  fmt::print("{}", TrackText(run, rows));
  const std::string log = rows > 0 ? "log: " + request.out : "no log: the tag was never seen";
  Say(fmt::format("{}; run: {}", log, run_file.string()));
  if (run.has_failed) return kRunTimeFailure;
  return rows > 0 ? kDone : kNotReached;
}

int TrackFor(const TrackRequest& request) {
  CheckTracking(request);
  experiment::TrackOptions options = OptionsOf(request);
  TrackView::Content content = ContentOf(request);
  vision::CameraModel camera =
      vision::ReadCamera(ReadFile(request.calibration), request.calibration);
  options.capture = CaptureFor(camera, options.capture);
  const StopSignal stop;
  const auto is_stopped = [&stop] { return stop.IsAsked(); };
  std::unique_ptr<vision::Capture> capture = vision::OpenCapture(request.camera, options.capture);
  TakeSizeFrom(*capture, request, options, camera);
  if (!request.world.empty()) {
    SetAndStoreWorld(request, {*capture, options, request.session, is_stopped, Say}, camera);
    if (request.out.empty()) return kDone;
  }
  // What was read so far of a recording belongs to its log as well.
  if (capture->IsRecording()) capture = vision::OpenCapture(request.camera, options.capture);
  TrackLog log(request.out);
  const std::unique_ptr<TrackView> view = ViewFor(request, camera, std::move(content));
  const TrackRun run = Track({*capture, camera, options, request.session, log, view.get(),
                              request.duration_s, is_stopped, Say});
  return Report(request, camera, options, run, log.Rows());
}

int CalibrateAndSave(const TrackRequest& request) {
  if (request.images.empty() == request.camera.empty()) {
    throw std::invalid_argument("--calibrate wants either --images DIR or --camera");
  }
  if (request.out.empty()) throw std::invalid_argument("--out CAM.yaml is missing");
  request.board.Check();
  const experiment::TrackOptions options = OptionsOf(request);
  const StopSignal stop;
  vision::Calibration calibration = CalibrateFor(
      request, options, [&stop] { return stop.IsAsked(); }, Say);
  fmt::print("{}", CalibrationText(calibration));
  const fs::path picture = request.picture.empty() ? fs::path(request.out).replace_extension(".png")
                                                   : fs::path(request.picture);
  vision::DrawCalibration(calibration, picture);
  Say(fmt::format("picture: {}", picture.string()));
  if (calibration.verdict == vision::CalibrationVerdict::kRefuse) {
    Say(fmt::format("{} is not written: the verdict is refuse", request.out));
    return kNotReached;
  }
  calibration.camera.name = fs::path(request.out).stem().string();
  WriteFile(request.out, CalibrationComment(calibration) + vision::WriteCamera(calibration.camera));
  Say(fmt::format("calibration: {}", request.out));
  return kDone;
}

/// `13x9`
void ReadBoard(const std::string& text, vision::Board& board) {
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &board.columns, &board.rows, &rest) != 2) {
    throw CLI::ValidationError(
        fmt::format("--board '{}': inner corners across and down, such as 13x9", text));
  }
}

void AddCalibrationFlags(CLI::App& app, TrackRequest& request) {
  app.add_flag("--calibrate", request.calibrate, "make the calibration of a camera instead");
  app.add_option_function<std::string>(
         "--board", [&request](const std::string& text) { ReadBoard(text, request.board); },
         "inner corners of the chessboard (squares less one)")
      ->type_name("WxH")
      ->default_str("13x9");
  app.add_option("--square", request.board.square_m, "side of a square of it")
      ->type_name("m")
      ->capture_default_str();
  app.add_option("--images", request.images, "its photographs")->type_name("DIR|'GLOB'");
  app.add_option("--picture", request.picture,
                 "where residuals and coverage are drawn [beside --out, .png]")
      ->type_name("FILE.png");
}

void AddTrackingFlags(CLI::App& app, TrackRequest& request) {
  app.add_option("EXPERIMENT", request.experiment, "YAML file; its key track: holds the settings");
  app.add_option("--set", request.overrides, "sets one key, such as track.tag.id=3")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--camera", request.camera,
                 "device, stream, video, or quoted pattern of pictures in the order of their names")
      ->type_name("/dev/video0|URL|FILE|'GLOB'");
  app.add_option("--calibration", request.calibration,
                 "of the camera: ROS camera_info, OpenCV's, the authors', or from --calibrate")
      ->type_name("CAM.yaml");
  app.add_option("--out", request.out, "the log; with --calibrate, the calibration")
      ->type_name("FILE");
  app.add_option("--fps", request.fps, "asked of a device; rate of a pattern of pictures")
      ->check(InRange(0.1, 1000.0))
      ->type_name("hz");
  app.add_option("--duration", request.duration_s, "ends after this long")
      ->check(InRange(0.0, 1e9))
      ->type_name("s");
  app.add_option("--world", request.world,
                 "sets the world frame first and keeps it in the calibration: from the robot's "
                 "first pose, or from a file with tags: (id, x_m, y_m) to be seen or points: "
                 "(name, x_m, y_m) to be clicked")
      ->type_name("first|FILE.yaml");
  app.add_flag("--view", request.view, "show it in a window");
  app.add_option("--path", request.path, "what the view holds the robot's trail against")
      ->type_name("WAYPOINTS.yaml|LOG.csv");
  app.add_option("--record-waypoints", request.record_waypoints,
                 "write the waypoints made in the window, for simulate and drive")
      ->type_name("FILE.yaml");
}

}  // namespace

void AddTrack(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<TrackRequest>();
  AddTrackingFlags(app, *request);
  AddFlags(app, request->session);
  AddCalibrationFlags(app, *request);
  AddKeysFlag(app);
  app.footer(
      "Ctrl-C ends it. Ends with 1 when the tag was never seen or the calibration is refused, with "
      "3\n"
      "when the camera fails (unplugged, frozen, black, busy, wrong format).\n"
      "Example: rift track --calibrate --board 13x9 --square 0.025 --images photos --out cam.yaml\n"
      "         rift track --camera /dev/video0 --calibration cam.yaml --world first --out "
      "log.csv");
  app.callback([request, &exit_code] {
    exit_code = request->calibrate ? CalibrateAndSave(*request) : TrackFor(*request);
  });
}

}  // namespace rift::commands
