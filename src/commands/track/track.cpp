#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <stdexcept>

#include "log.hpp"
#include "request.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/track/track.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/json/precision.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/view/calibration_view.hpp"
#include "rift/view/track_view.hpp"
#include "rift/view/track_window.hpp"
#include "rift/view/window.hpp"
#include "rift/view/world_clicks.hpp"
#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/calibration/chessboard.hpp"
#include "rift/vision/calibration/live_views.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/rendering/precision_map.hpp"
#include "rift/vision/rendering/print_sheet.hpp"
#include "rift/vision/tracking/tag_family.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "rift/vision/tracking/track_run.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "rift/vision/tracking/world_setting.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

experiment::Experiment ExperimentOf(const TrackRequest& request) {
  const auto read = [&](const std::string& path) {
    return request.experiment.empty() ? std::string("{}") : files::ReadFile(path);
  };
  const std::string path = request.experiment.empty() ? "defaults" : request.experiment;
  return experiment::LoadExperiment(path, request.overrides, read);
}

experiment::TrackOptions OptionsOf(const TrackRequest& request,
                                   const experiment::Experiment& experiment) {
  experiment::TrackOptions options = experiment.track;
  options.tag = TagOn(experiment);
  if (request.fps) options.capture.fps = *request.fps;
  if (!request.times.empty()) options.capture.times = request.times;
  if (!request.ids.empty()) options.tag.id = request.ids.front();
  if (request.tag_height_m) options.tag.height_m = *request.tag_height_m;
  return options;
}

/// The path is a waypoint file or, told by its ending, a log.
view::TrackView::Content ContentOf(const TrackRequest& request) {
  view::TrackView::Content content;
  if (!request.record_waypoints.empty()) {
    content.save = [file = request.record_waypoints](const auto& waypoints) {
      files::WriteFile(file, report::WaypointsYaml(waypoints));
    };
  }
  if (request.path.empty()) return content;
  if (fs::path(request.path).extension() == ".csv") {
    const trajectory::Log log = trajectory::ReadLog(files::ReadFile(request.path), request.path);
    for (const auto& pose : log.trajectory.poses) content.path_m.push_back(pose.Position());
    return content;
  }
  content.planned = ReadExperiment(request.path).waypoints;
  for (const auto& waypoint : content.planned) content.path_m.push_back(waypoint.Position());
  return content;
}

std::unique_ptr<view::TrackView> ViewFor(const TrackRequest& request,
                                         const vision::CameraModel& camera,
                                         const std::vector<int>& tag_ids,
                                         view::TrackView::Content content) {
  if (!request.view && request.record_waypoints.empty()) return nullptr;
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    terminal::Say(
        fmt::format("{}; tracking goes on without{}", missing,
                    request.record_waypoints.empty() ? "" : ", no waypoints can be recorded"));
    return nullptr;
  }
  return std::make_unique<view::TrackView>(camera, tag_ids, std::move(content));
}

/// Files of other programs may lack the picture's size; then the first picture has to be trusted.
void TakeSize(const TrackRequest& request, vision::CameraSession& session) {
  if (session.camera().width_px > 0 && session.camera().height_px > 0) return;
  session.FirstPicture();
  terminal::Say(
      fmt::format("note: {} does not say for which size it was made; {}x{} is taken as given",
                  request.calibration, session.camera().width_px, session.camera().height_px));
}

vision::WorldFrame WorldFor(const TrackRequest& request, const vision::WorldSetting& setting) {
  if (request.world == "first") return WorldFromRobot(setting);
  const vision::FloorMarks marks =
      vision::ReadFloorMarks(files::ReadFile(request.world), request.world);
  try {
    return marks.tags.empty() ? view::WorldFromClicks(setting, marks.points)
                              : WorldFromFloorTags(setting, marks.tags);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--world {}: {}", request.world, error.what()));
  }
}

/// Throws std::invalid_argument when the file holds a better frame than the new one.
void RefuseWorse(const TrackRequest& request, const vision::CameraModel& camera,
                 const vision::WorldFrame& next) {
  if (request.force || !camera.world) return;
  const auto reason = vision::IsWorseThan(next, *camera.world);
  if (!reason) return;
  throw std::invalid_argument(
      fmt::format("--world: {} is left as it is, since {}: give --force to "
                  "replace it all the same",
                  request.calibration, *reason));
}

void SetAndSaveWorld(const TrackRequest& request, const std::function<bool()>& is_stopped,
                     vision::CameraSession& session) {
  const vision::WorldFrame found =
      WorldFor(request, {session, request.session, is_stopped, terminal::Say});
  RefuseWorse(request, session.camera(), found);
  session.SetWorld(found);
  files::WriteFile(
      request.calibration,
      vision::WriteCamera(session.camera(),
                          vision::CommentOfCamera(files::ReadFile(request.calibration))));
  const vision::WorldFrame& world = *session.camera().world;
  terminal::Say(fmt::format("world frame from {}, {:.2f} mm off at its points, is now in {}",
                            world.origin, 1e3 * world.residual_m, request.calibration));
}

int EndOf(const vision::TrackRun& run) {
  if (run.has_failed) return terminal::kRunTimeFailure;
  return run.rows > 0 ? terminal::kDone : terminal::kNotReached;
}

int Report(const TrackRequest& request, const vision::CameraModel& camera,
           const experiment::TrackOptions& options, const vision::TrackRun& run) {
  const fs::path run_file = RunFileOf(request.out);
  if (request.IsPiped()) return EndOf(run);
  files::WriteFile(run_file,
                   report::TrackJson({request.camera, request.calibration,
                                      statistics::Hash128Text(files::ReadFile(request.calibration)),
                                      request.session},
                                     camera, options, run, run.rows));
  terminal::PrintText(report::TrackText(run, run.rows));
  const std::string log = run.rows > 0 ? "log: " + request.out : "no log: the tag was never seen";
  terminal::Say(fmt::format("{}; run: {}", log, run_file.string()));
  if (!run.found_instead.empty()) {
    terminal::Say(report::FoundInsteadText(run.found_instead, options.tag.family));
  }
  if (run.rows > 0 && !request.copies.Files().empty()) {
    WriteLogCopies(request.copies,
                   trajectory::ReadLog(files::ReadFile(request.out), request.out).trajectory);
  }
  return EndOf(run);
}

/// What is wrong with the poses to come, while it can still be changed.
void SayWhatToExpect(const TrackRequest& request, const vision::CameraSession& session) {
  if (!session.camera().world) {
    terminal::Say(fmt::format(
        "note: {} holds no world frame: the poses are in the camera's own frame (z below 0, no "
        "floor to hold the tag to); rift track --world sets one",
        request.calibration));
  }
  const auto small = vision::SmallTagWarning(session.camera(), session.tag());
  if (small) terminal::Say("warning: " + *small);
}

/// An old log beside the run file of a new one would be taken for its own.
void RemoveOld(const fs::path& log) {
  fs::remove(log);
  fs::remove(RunFileOf(log));
}

std::vector<int> FurtherIds(const TrackRequest& request) {
  if (request.ids.empty()) return {};
  return {request.ids.begin() + 1, request.ids.end()};
}

int TrackRobot(const TrackRequest& request) {
  experiment::TrackOptions options = OptionsOf(request, ExperimentOf(request));
  view::TrackView::Content content = ContentOf(request);
  const vision::CameraModel camera =
      vision::ReadCamera(files::ReadFile(request.calibration), request.calibration);
  const terminal::StopSignal stop;
  const auto is_stopped = [&stop] { return stop.IsAsked(); };
  vision::CameraSession session(request.camera, camera, options.capture, options.tag);
  options.capture = session.options();
  for (const int id : request.ids) vision::RequireTagId(id, options.tag.family);
  TakeSize(request, session);
  if (!request.world.empty()) {
    SetAndSaveWorld(request, is_stopped, session);
    if (request.out.empty()) return terminal::kDone;
  }
  SayWhatToExpect(request, session);
  if (request.force && !request.IsPiped()) RemoveOld(request.out);
  session.Restart();  // what was read so far of a recording belongs to its log as well
  TrackLog log(request.out);
  std::vector<int> tag_ids = FurtherIds(request);
  tag_ids.insert(tag_ids.begin(), session.tag().id);
  const auto view = ViewFor(request, session.camera(), tag_ids, std::move(content));
  vision::TrackParts parts{.session = session,
                           .options = request.session,
                           .further_ids = FurtherIds(request),
                           .log = [&log](double t_s, const auto& s) { return log.Add(t_s, s); },
                           .duration_s = request.duration_s,
                           .is_stopped = is_stopped,
                           .say = terminal::Say};
  if (view) parts.show = [&view](const auto&... moment) { return view->Show(moment...); };
  const vision::TrackRun run = RunTracking(parts);
  log.Close();
  return Report(request, session.camera(), options, run);
}

std::unique_ptr<view::CalibrationView> CalibrationWindowFor(const TrackRequest& request) {
  if (!request.view) return nullptr;
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    terminal::Say(missing + "; what picture to take next is said here");
    return nullptr;
  }
  return std::make_unique<view::CalibrationView>();
}

vision::Calibration CalibrateFor(const TrackRequest& request) {
  request.board.Check();
  const experiment::TrackOptions options = OptionsOf(request, ExperimentOf(request));
  const terminal::StopSignal stop;
  const auto is_stopped = [&stop] { return stop.IsAsked(); };
  std::vector<vision::BoardView> views;
  if (request.images.empty()) {
    const auto window = CalibrationWindowFor(request);
    vision::LiveListener listener{
        .is_stopped = is_stopped, .say = terminal::Say, .give_up_s = request.session.give_up_s};
    if (window) listener.show = [&window](const auto& scene) { return window->Show(scene); };
    const auto capture = vision::OpenCapture(request.camera, options.capture);
    views = ViewsFromCamera(*capture, request.board, options.calibration, listener);
  } else {
    views = ViewsFromFiles(vision::ImageFiles(request.images), request.board,
                           {is_stopped, terminal::Say});
  }
  return Calibrate(views, request.board, options.calibration);
}

int CalibrateAndSave(const TrackRequest& request) {
  vision::Calibration calibration = CalibrateFor(request);
  terminal::PrintText(report::CalibrationText(calibration));
  const fs::path picture = PictureOf(request);
  vision::DrawCalibration(calibration, picture);
  terminal::Say(fmt::format("picture: {}", picture.string()));
  if (calibration.verdict == vision::CalibrationVerdict::kRefuse) {
    terminal::Say(fmt::format("{} is not written: the verdict is refuse", request.out));
    return terminal::kNotReached;
  }
  calibration.camera.name = fs::path(request.out).stem().string();
  files::WriteFile(request.out, vision::WriteCamera(calibration.camera,
                                                    report::CalibrationComment(calibration)));
  terminal::Say(fmt::format("calibration: {}", request.out));
  return terminal::kDone;
}

/// What tracking will be worth, before anything is driven. No camera is opened.
int CheckPrecision(const TrackRequest& request) {
  const experiment::Experiment experiment = ExperimentOf(request);
  const vision::TagOptions tag = OptionsOf(request, experiment).tag;
  const vision::CameraModel camera =
      vision::ReadCamera(files::ReadFile(request.calibration), request.calibration);
  const vision::SyntheticCameraOptions& look = experiment.twin.camera;
  vision::PrecisionMap map;
  {
    const terminal::LiveLine progress;
    map = PredictPrecision(camera, tag, look, {}, [](int done, int all) {
      terminal::LiveLine::Show(fmt::format("trying the tag at place {} of {}", done, all));
    });
  }
  terminal::PrintText(report::PrecisionText(map, tag));
  if (request.out.empty()) return terminal::kDone;
  files::WriteFile(request.out, report::PrecisionJson(map, tag, look));
  terminal::Say(fmt::format("map: {}", request.out));
  return terminal::kDone;
}

int PrintSheet(const TrackRequest& request) {
  if (!request.print_board.empty()) {
    files::WriteFile(request.print_board, vision::ChessboardSheet(request.board));
    terminal::Say(fmt::format("to print at 100 %: {}", request.print_board));
    return terminal::kDone;
  }
  const vision::TagOptions tag = OptionsOf(request, ExperimentOf(request)).tag;
  files::WriteFile(request.print_tag, vision::TagSheet(tag.id, tag.size_m, tag.family));
  terminal::Say(fmt::format("to print at 100 %: {}, {} id {}, side {:g} m", request.print_tag,
                            vision::NameOf(tag.family), tag.id, tag.size_m));
  return terminal::kDone;
}

}  // namespace

int Track(const TrackRequest& request) {
  if (request.IsPrinting()) return PrintSheet(request);
  if (request.check) return CheckPrecision(request);
  return request.calibrate ? CalibrateAndSave(request) : TrackRobot(request);
}

}  // namespace rift::commands
