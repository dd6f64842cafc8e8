#include "request.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/track/track.hpp"
#include "rift/vision/camera/jpeg.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void CheckLogName(const TrackRequest& request) {
  std::vector<fs::path> inputs;
  if (!request.experiment.empty()) inputs.emplace_back(request.experiment);
  const bool has_times = !request.times.empty() && request.times != vision::kTimesFromExif;
  if (has_times) inputs.emplace_back(request.times);
  sessions::CheckNames(request.job, std::move(inputs), request.copies.Files());
}

/// They are of one robot, and made of the log when it is whole.
void CheckCopies(const TrackRequest& request) {
  if (request.copies.Files().empty()) return;
  if (request.check || request.calibrate || request.out.empty() || request.IsPiped()) {
    throw std::invalid_argument("--tum and --mcap are copies of a log: give --out LOG.csv as well");
  }
  if (request.job.ids.size() > 1) {
    throw std::invalid_argument("--tum and --mcap hold one robot: give --id a single tag");
  }
}

void CheckTracking(const TrackRequest& request) {
  if (request.job.camera.empty()) {
    throw std::invalid_argument(
        "--camera is missing: name a device such as /dev/video0, a stream, a video, or a quoted "
        "pattern of pictures");
  }
  if (request.job.calibration.empty()) {
    throw std::invalid_argument(
        "--calibration is missing: rift track --calibrate makes one from pictures of a chessboard");
  }
  if (request.out.empty() && request.job.world.empty()) {
    throw std::invalid_argument("--out LOG.csv is missing: where shall the poses go?");
  }
  if (!request.out.empty()) CheckLogName(request);
  if (!request.images.empty() || !request.picture.empty()) {
    throw std::invalid_argument("--images and --picture belong to --calibrate");
  }
}

void CheckPrecisionCheck(const TrackRequest& request) {
  if (request.calibrate) throw std::invalid_argument("--check and --calibrate exclude each other");
  if (request.job.calibration.empty()) {
    throw std::invalid_argument("--calibration is missing: --check is about one camera");
  }
  if (!request.job.camera.empty() || !request.job.world.empty() || request.job.view) {
    throw std::invalid_argument(
        "--check opens no camera: --camera, --world and --view do not belong to it");
  }
  if (request.out.empty()) return;
  std::vector<fs::path> inputs{request.job.calibration};
  if (!request.experiment.empty()) inputs.emplace_back(request.experiment);
  CheckOutputs(inputs, {.files = {request.out}, .force = request.job.force});
}

void CheckPrinting(const TrackRequest& request) {
  if (!request.print_tag.empty() && !request.print_board.empty()) {
    throw std::invalid_argument("--print-tag and --print-board exclude each other");
  }
  if (request.check || request.calibrate || !request.job.camera.empty() || !request.out.empty()) {
    throw std::invalid_argument(
        "--print-tag and --print-board write a sheet and nothing else: --camera, --out, --check "
        "and "
        "--calibrate do not belong to them");
  }
  if (request.job.ids.size() > 1) {
    throw std::invalid_argument("--print-tag makes one tag: give --id a single one");
  }
  const std::string& sheet = request.print_tag.empty() ? request.print_board : request.print_tag;
  if (fs::path(sheet).extension() != ".svg") {
    throw std::invalid_argument(
        fmt::format("{}: a sheet to print is an SVG: give it a name that ends in .svg", sheet));
  }
  CheckOutputs({}, {.files = {sheet}, .force = request.job.force});
}

void CheckCalibrating(const TrackRequest& request) {
  if (request.images.empty() == request.job.camera.empty()) {
    throw std::invalid_argument(
        "--calibrate wants either --images DIR or --camera: photographs, or a camera to take them");
  }
  if (request.job.view && request.job.camera.empty()) {
    throw std::invalid_argument("--view shows a camera: --images are not taken in a window");
  }
  if (request.out.empty())
    throw std::invalid_argument("--out CAM.yaml is missing: where shall the calibration go?");
  CheckOutputs({}, {.files = {request.out, PictureOf(request)}, .force = request.job.force});
}

void CheckIds(const std::vector<int>& ids) {
  std::set<int> seen;
  for (const int id : ids) {
    if (!seen.insert(id).second) {
      throw std::invalid_argument(
          fmt::format("--id: {} is named twice: each robot has its own", id));
    }
  }
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
  AddSetFlag(app, request.overrides, "track.tag.id=3");
  app.add_option(
         "--camera", request.job.camera,
         "device, stream, video, or quoted pattern of pictures in the order of the numbers in "
         "their names")
      ->type_name("/dev/video0|URL|FILE|'GLOB'");
  app.add_option("--calibration", request.job.calibration,
                 "of the camera: ROS camera_info, OpenCV's, the authors', or from --calibrate")
      ->type_name("CAM.yaml");
  app.add_option("--out", request.out,
                 "the log, - for stdout, the log alone; with --calibrate, the calibration")
      ->type_name("FILE|-");
  AddLogCopyFlags(app, request.copies);
  app.add_flag("--force", request.job.force,
               "replace files that are there already, and a better world frame of the calibration");
  app.add_option("--id", request.job.ids,
                 "the robot's tag [track.tag.id]; several robots go into one log, a row each")
      ->delimiter(',')
      ->check(InRange(0, vision::kLastTagId))
      ->type_name("N,N,...");
  app.add_option("--tag-height", request.tag_height_m,
                 "of the tag above the floor "
                 "[track.tag.height_m]")
      ->check(InRange(0.0, 2.0))
      ->type_name("m");
  app.add_option("--times", request.times,
                 "when the pictures of a pattern were taken: a line each, seconds, or name and "
                 "seconds; exif: as their EXIF data say [the numbers in their names, at --fps a "
                 "second]")
      ->type_name("FILE|exif");
  app.add_option("--fps", request.fps, "asked of a device; rate of a pattern of pictures")
      ->check(InRange(0.1, 1000.0))
      ->type_name("hz");
  app.add_option("--duration", request.job.duration_s, "ends after this long")
      ->check(InRange(0.0, 1e9))
      ->type_name("s");
  app.add_option("--world", request.job.world,
                 "sets the world frame first and keeps it in the calibration: from the robot's "
                 "first pose, or from a file with tags: (id, x_m, y_m) to be seen or points: "
                 "(name, x_m, y_m) to be clicked")
      ->type_name("first|FILE.yaml");
  app.add_flag("--check", request.check,
               "say how precise poses will be over the floor and which tag is too small, tried on "
               "rendered pictures (twin.camera: blur, noise); --out keeps the map as JSON");
  app.add_option("--print-tag", request.print_tag,
                 "write the sheet of the robot's tag (track.tag: family, id, size_m) to print")
      ->type_name("FILE.svg");
  app.add_option("--print-board", request.print_board,
                 "the same of a chessboard (--board, --square)")
      ->type_name("FILE.svg");
  app.add_flag("--view", request.job.view,
               "show it in a window; with --calibrate and a camera, where to hold the board next");
  app.add_option("--path", request.job.path, "what the view holds the robot's trail against")
      ->type_name("WAYPOINTS.yaml|LOG.csv");
  app.add_option("--record-waypoints", request.job.record_waypoints,
                 "write the waypoints made in the window, for simulate and drive")
      ->type_name("FILE.yaml");
}

}  // namespace

fs::path PictureOf(const TrackRequest& request) {
  return request.picture.empty() ? fs::path(request.out).replace_extension(".png")
                                 : fs::path(request.picture);
}

void TrackRequest::Check() const {
  CheckCopies(*this);
  if (IsPrinting()) {
    CheckPrinting(*this);
  } else if (check) {
    CheckPrecisionCheck(*this);
  } else {
    calibrate ? CheckCalibrating(*this) : CheckTracking(*this);
  }
  CheckIds(job.ids);
}

void AddTrack(CLI::App& app, int& exit_code, const std::function<int(const TrackRequest&)>& track) {
  const auto request = std::make_shared<TrackRequest>();
  AddTrackingFlags(app, *request);
  AddFlags(app, request->job.session);
  AddCalibrationFlags(app, *request);
  AddKeysFlag(app);
  app.footer(
      "Ctrl-C ends it. Ends with 1 when the tag was never seen or the calibration is refused, with "
      "3\n"
      "when the camera fails (unplugged, frozen, black, busy, wrong format).\n"
      "Example: rift track --calibrate --board 13x9 --square 0.025 --images photos --out cam.yaml\n"
      "         rift track --camera /dev/video0 --calibration cam.yaml --world first --out "
      "log.csv\n"
      "         rift track --check --calibration cam.yaml\n"
      "         rift track --print-tag tag.svg --set track.tag.size_m=0.05");
  app.callback([request, track, &exit_code] {
    request->job.calibration = FindInput(request->job.calibration);
    request->job.log = request->out;
    request->Check();
    exit_code = track(*request);
  });
}

}  // namespace rift::commands
