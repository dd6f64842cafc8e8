#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>
#include <vector>

#include "request.hpp"
#include "rift/commands/track/track.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/files/outputs.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/json/precision.hpp"
#include "rift/sessions/track/calibration.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/rendering/precision_map.hpp"
#include "rift/vision/rendering/print_sheet.hpp"
#include "rift/vision/tracking/tag_family.hpp"

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

int EndOf(const vision::TrackRun& run) {
  if (run.has_failed) return terminal::kRunTimeFailure;
  return run.rows > 0 ? terminal::kDone : terminal::kNotReached;
}

int Report(const TrackRequest& request, const vision::TrackRun& run,
           const vision::TagOptions& tag) {
  if (request.IsPiped()) return EndOf(run);
  terminal::PrintText(report::TrackText(run, run.rows));
  if (run.frames == 0 && fs::exists(request.out)) {
    terminal::Say(fmt::format("no picture came: {} is left as it was", request.out));
    return EndOf(run);
  }
  const std::string log = run.rows > 0 ? "log: " + request.out : "no log: the tag was never seen";
  terminal::Say(fmt::format("{}; run: {}", log, sessions::RunFileOf(request.out).string()));
  for (const std::string& line : report::UnseenLines(run.instead, tag.family, "--id ")) {
    terminal::Say(line);
  }
  if (run.rows > 0 && !request.copies.Files().empty()) {
    request.copies.Write(trajectory::ReadLog(files::ReadFile(request.out), request.out).trajectory);
  }
  return EndOf(run);
}

void PrintRows(std::string_view rows) {
  terminal::PrintData(rows);
  if (const int error = terminal::FlushResults(); error != 0) {
    throw std::runtime_error(fmt::format("cannot write to stdout: {}", strerror(error)));
  }
}

/// Pictures are not taken again, so that --force replaces none of a folder or a pattern.
void RefusePictures(const std::string& pictures, const std::vector<fs::path>& outputs) {
  std::vector<fs::path> inputs;
  for (const std::string& file : vision::ImageFiles(pictures)) inputs.emplace_back(file);
  files::CheckOutputs(inputs, {.files = outputs, .force = true});
}

void RefusePicturesOfCamera(const TrackRequest& request) {
  const sessions::TrackingJob& job = request.job;
  if (vision::KindOf(job.camera) != vision::SourceKind::kImages) return;
  std::vector<fs::path> outputs = request.copies.Files();
  if (!job.record_waypoints.empty()) outputs.emplace_back(job.record_waypoints);
  if (!request.out.empty() && !job.IsPiped()) {
    outputs.insert(outputs.end(), {request.out, sessions::RunFileOf(request.out)});
  }
  RefusePictures(job.camera, outputs);
}

int TrackRobot(const TrackRequest& request) {
  RefusePicturesOfCamera(request);
  sessions::TrackingJob job = request.job;
  job.options = request.job.OptionsFor(ExperimentOf(request));
  sessions::TrackingInputs inputs = sessions::ReadInputs(job);
  const terminal::StopSignal stop;
  int exit_code = terminal::kDone;
  sessions::Track(
      job, std::move(inputs),
      {.is_stopped = [&stop] { return stop.IsAsked(); }, .say = terminal::Say, .print = PrintRows},
      [&](const vision::TrackRun& run, const vision::TagOptions& tag) {
        exit_code = Report(request, run, tag);
      });
  return exit_code;
}

vision::Calibration CalibrateFor(const TrackRequest& request) {
  request.board.Check();
  // The picture beside --out is left out: the same command may have drawn it among them before.
  std::vector<fs::path> outputs{request.out};
  if (!request.picture.empty()) outputs.emplace_back(request.picture);
  const std::string& camera = request.job.camera;
  if (!request.images.empty()) {
    RefusePictures(request.images, outputs);
  } else if (vision::KindOf(camera) == vision::SourceKind::kImages) {
    RefusePictures(camera, outputs);
  }
  const sessions::CalibrationJob job{.images = request.images,
                                     .camera = request.job.camera,
                                     .board = request.board,
                                     .options = request.job.OptionsFor(ExperimentOf(request)),
                                     .give_up_s = request.job.session.give_up_s,
                                     .view = request.job.view};
  const terminal::StopSignal stop;
  return sessions::Calibrate(
      job, [&stop] { return stop.IsAsked(); }, terminal::Say);
}

int CalibrateAndSave(const TrackRequest& request) {
  vision::Calibration calibration = CalibrateFor(request);
  terminal::PrintText(report::CalibrationText(calibration));
  const bool is_refused = calibration.verdict == vision::CalibrationVerdict::kRefuse;
  if (!is_refused) {  // first: whether its picture can be drawn or not
    calibration.camera.name = fs::path(request.out).stem().string();
    files::WriteFile(request.out, vision::WriteCamera(calibration.camera,
                                                      report::CalibrationComment(calibration)));
    terminal::Say(fmt::format("calibration: {}", request.out));
  }
  const fs::path picture = is_refused ? RefusedPictureOf(request) : PictureOf(request);
  vision::DrawCalibration(calibration, picture);
  terminal::Say(fmt::format("picture: {}", picture.string()));
  if (!is_refused) return terminal::kDone;
  terminal::Say(fmt::format("{} is not written: the verdict is refuse", request.out));
  return terminal::kNotReached;
}

/// What tracking will be worth, before anything is driven. No camera is opened.
int CheckPrecision(const TrackRequest& request) {
  const experiment::Experiment experiment = ExperimentOf(request);
  const vision::TagOptions tag = request.job.OptionsFor(experiment).tag;
  const vision::CameraModel camera =
      vision::ReadCamera(files::ReadFile(request.job.calibration), request.job.calibration);
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
  const vision::TagOptions tag = request.job.OptionsFor(ExperimentOf(request)).tag;
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
