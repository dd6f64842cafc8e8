#include "request.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <memory>
#include <set>
#include <utility>

#include "rift/commands/track/track.hpp"
#include "rift/files/files.hpp"
#include "rift/vision/camera/jpeg.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void CheckLogName(const TrackRequest& request) {
  std::vector<fs::path> inputs;
  if (!request.experiment.empty()) inputs.emplace_back(request.experiment);
  const std::string& times = request.job.times;
  if (!times.empty() && times != vision::kTimesFromExif) inputs.emplace_back(times);
  sessions::CheckNames(request.job, std::move(inputs), request.copies.Files());
}

/// They are of one robot, and made of the log when it is whole.
void CheckCopies(const TrackRequest& request) {
  if (request.copies.Files().empty()) return;
  Refuse({{request.check || request.calibrate || request.out.empty() || request.IsPiped(),
           "--tum and --mcap are copies of a log: give --out LOG.csv as well"},
          {request.job.ids.size() > 1, "--tum and --mcap hold one robot: give --id a single tag"}});
}

void RefusePicturesOfBoard(const TrackRequest& request) {
  Refuse({{!request.images.empty() || !request.picture.empty(),
           "--images and --picture belong to --calibrate"}});
}

void CheckTracking(const TrackRequest& request) {
  const sessions::TrackingJob& job = request.job;
  Refuse({{job.camera.empty(),
           "--camera is missing: name a device such as /dev/video0, a stream, a video, or a quoted "
           "pattern of pictures"},
          {job.calibration.empty(),
           "--calibration is missing: rift track --calibrate makes one from pictures of a "
           "chessboard"},
          {request.out.empty() && job.world.empty(),
           "--out LOG.csv is missing: where shall the poses go?"}});
  if (!request.out.empty()) CheckLogName(request);
  RefusePicturesOfBoard(request);
}

void CheckPrecisionCheck(const TrackRequest& request) {
  const sessions::TrackingJob& job = request.job;
  Refuse({{request.calibrate, "--check and --calibrate exclude each other"},
          {job.calibration.empty(), "--calibration is missing: --check is about one camera"},
          {!job.camera.empty() || !job.world.empty() || job.view,
           "--check opens no camera: --camera, --world and --view do not belong to it"}});
  RefusePicturesOfBoard(request);
  if (request.out.empty()) return;
  std::vector<fs::path> inputs{job.calibration};
  if (!request.experiment.empty()) inputs.emplace_back(request.experiment);
  CheckOutputs(inputs, {.files = {request.out}, .force = job.force});
}

void CheckPrinting(const TrackRequest& request) {
  const sessions::TrackingJob& job = request.job;
  const std::string& sheet = request.print_tag.empty() ? request.print_board : request.print_tag;
  Refuse({{!request.print_tag.empty() && !request.print_board.empty(),
           "--print-tag and --print-board exclude each other"},
          {request.check || request.calibrate || !job.camera.empty() || !request.out.empty(),
           "--print-tag and --print-board write a sheet and nothing else: --camera, --out, --check "
           "and --calibrate do not belong to them"},
          {job.ids.size() > 1, "--print-tag makes one tag: give --id a single one"},
          {fs::path(sheet).extension() != ".svg",
           sheet + ": a sheet to print is an SVG: give it a name that ends in .svg"}});
  CheckOutputs({}, {.files = {sheet}, .force = job.force});
}

void CheckCalibrating(const TrackRequest& request) {
  const sessions::TrackingJob& job = request.job;
  Refuse({{request.images.empty() == job.camera.empty(),
           "--calibrate wants either --images DIR or --camera: photographs, or a camera to take "
           "them"},
          {job.view && job.camera.empty(),
           "--view shows a camera: --images are not taken in a window"},
          {request.out.empty(), "--out CAM.yaml is missing: where shall the calibration go?"}});
  CheckOutputs({}, {.files = {request.out, PictureOf(request)}, .force = job.force});
  std::string ending = PictureOf(request).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
  Refuse({{ending != ".png" && ending != ".jpg" && ending != ".jpeg",
           request.picture + ": a picture is a PNG or JPEG: give it a name that ends in .png or "
                             ".jpg"}});
}

void CheckIds(const std::vector<int>& ids) {
  std::set<int> seen;
  for (const int id : ids) {
    Refuse({{!seen.insert(id).second,
             fmt::format("--id: {} is named twice: each robot has its own", id)}});
  }
}

/// `13x9`
void ReadBoard(const std::string& text, vision::Board& board) {
  const char* const end = text.data() + text.size();
  const auto across = std::from_chars(text.data(), end, board.columns);
  const bool has_x = across.ec == std::errc() && across.ptr != end && *across.ptr == 'x';
  const auto down = has_x ? std::from_chars(across.ptr + 1, end, board.rows) : across;
  if (!has_x || down.ec != std::errc() || down.ptr != end) {
    throw CLI::ValidationError(
        fmt::format("--board '{}': inner corners across and down, such as 13x9", text));
  }
}

void AddCalibrationFlags(CLI::App& app, TrackRequest& request) {
  FlagMaker flags(app);
  flags("calibrate", request.calibrate, "make the calibration of a camera instead");
  app.add_option_function<std::string>(
         "--board", [&request](const std::string& text) { ReadBoard(text, request.board); },
         "inner corners of the chessboard (squares less one)")
      ->type_name("WxH")
      ->default_str("13x9");
  app.add_option("--square", request.board.square_m, "side of a square of it")
      ->type_name("m")
      ->capture_default_str();
  flags("images", request.images, "DIR|'GLOB'", "its photographs");
  flags("picture", request.picture, "FILE.png",
        "where residuals and coverage are drawn [beside --out, .png]");
}

void AddTrackingFlags(CLI::App& app, TrackRequest& request) {
  sessions::TrackingJob& job = request.job;
  FlagMaker flags(app);
  app.add_option("EXPERIMENT", request.experiment, "YAML file; its key track: holds the settings");
  AddSetFlag(app, request.overrides, "track.tag.id=3");
  flags("camera", job.camera, "/dev/video0|URL|FILE|'GLOB'",
        "device, stream, video, or quoted pattern of pictures in the order of the numbers in their "
        "names");
  flags("calibration", job.calibration, "CAM.yaml",
        "of the camera: ROS camera_info, OpenCV's, the authors', or from --calibrate");
  flags("out", request.out, "FILE|-",
        "the log, - for stdout, the log alone; with --calibrate, the calibration");
  AddFlags(app, request.copies);
  flags("force", job.force,
        "replace files that are there already, and a better world frame of the calibration");
  app.add_option("--id", job.ids,
                 "the robot's tag [track.tag.id]; several robots go into one log, a row each")
      ->delimiter(',')
      ->check(InRange(0, vision::kLastTagId))
      ->type_name("N,N,...");
  AddFlags(app, job);
  flags("duration_s", job.duration_s, 0.0, 1e9, "s",
        "ends after this long, of a recording by its own time");
  flags("world", job.world, "first|FILE.yaml",
        "sets the world frame first and keeps it in the calibration: from the robot's first pose, "
        "or from a file with tags: (id, x_m, y_m) to be seen or points: (name, x_m, y_m) to be "
        "clicked");
  flags("check", request.check,
        "say how precise poses will be over the floor and which tag is too small, tried on "
        "rendered pictures (twin.camera: blur, noise); --out keeps the map as JSON");
  flags("print_tag", request.print_tag, "FILE.svg",
        "write the sheet of the robot's tag (track.tag: family, id, size_m) to print");
  flags("print_board", request.print_board, "FILE.svg",
        "the same of a chessboard (--board, --square)");
  flags("view", job.view,
        "show it in a window; with --calibrate and a camera, where to hold the board next");
  flags("path", job.path, "WAYPOINTS.yaml|LOG.csv",
        "what the view holds the robot's trail against");
  flags("record_waypoints", job.record_waypoints, "FILE.yaml",
        "write the waypoints made in the window, for simulate and drive");
}

}  // namespace

fs::path PictureOf(const TrackRequest& request) {
  return request.picture.empty() ? fs::path(request.out).replace_extension(".png")
                                 : fs::path(request.picture);
}

fs::path RefusedPictureOf(const TrackRequest& request) {
  return request.picture.empty() ? fs::path(request.out).replace_extension(".refused.png")
                                 : PictureOf(request);
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
      "Ctrl-C ends it. Ends with 1 when the tag was never seen in a log or the calibration is\n"
      "refused, with 3 when the camera fails (unplugged, frozen, black, busy, wrong format).\n"
      "Example: rift track --calibrate --board 13x9 --square 0.025 --images photos --out cam.yaml\n"
      "         rift track --camera /dev/video0 --calibration cam.yaml --world first --out "
      "log.csv\n"
      "         rift track --check --calibration cam.yaml\n"
      "         rift track --print-tag tag.svg --set track.tag.size_m=0.05");
  app.callback([request, track, &exit_code] {
    request->job.calibration = files::FindInput(request->job.calibration);
    request->job.log = request->out;
    request->Check();
    exit_code = track(*request);
  });
}

}  // namespace rift::commands
