#include "rift/sessions/track/tracking.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "log.hpp"
#include "rift/experiment/task.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "rift/vision/tracking/tag_family.hpp"
#include "rift/vision/tracking/tag_visibility.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "window.hpp"
#include "world.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using Say = std::function<void(const std::string&)>;

/// Files of other programs may lack the picture's size; then the first picture has to be trusted.
/// False when it was told to stop before that came.
bool TakeSize(const TrackingJob& job, const TrackingListener& listener,
              vision::CameraSession& session) {
  if (session.camera().width_px > 0 && session.camera().height_px > 0) return true;
  if (!session.FirstPicture([&] { return !listener.is_stopped(); })) return false;
  listener.say(
      fmt::format("note: {} does not say for which size it was made; {}x{} is taken as given",
                  job.calibration, session.camera().width_px, session.camera().height_px));
  return true;
}

/// What is wrong with the poses to come, while it can still be changed.
void SayWhatToExpect(const TrackingJob& job, const Say& say, const vision::CameraSession& session) {
  const auto guessed = vision::GuessedTimes(job.camera, session.options());
  if (guessed) say("note: " + *guessed);
  if (!session.camera().world) {
    say(fmt::format(
        "note: {} holds no world frame: the poses are in the camera's own frame (z below 0, no "
        "floor to hold the tag to); rift track --world sets one",
        job.calibration));
  }
  if (const auto other = vision::WhyNotOfThisLens(session.camera())) {
    say(fmt::format("warning: {}: {}", job.calibration, *other));
  }
  const auto small = vision::SmallTagWarning(session.camera(), session.tag());
  if (small) say("warning: " + *small);
}

/// The log and run file that `--force` replaces. They go together, since an old log beside the run
/// file of a new one would be taken for its own, and not before there is a picture: a camera that
/// is not there costs nobody the log of before.
class OldLog {
 public:
  explicit OldLog(const TrackingJob& job) : log_(job.log) {
    is_there_ = job.force && !job.IsPiped() && fs::exists(log_);
  }

  bool IsThere() const { return is_there_; }
  void Remove() {
    if (!std::exchange(is_there_, false)) return;
    fs::remove(log_);
    fs::remove(RunFileOf(log_));
  }

 private:
  fs::path log_;
  bool is_there_;
};

std::vector<int> FurtherIds(const TrackingJob& job) {
  if (job.ids.empty()) return {};
  return {job.ids.begin() + 1, job.ids.end()};
}

void WriteRunFile(const TrackingJob& job, const vision::CameraModel& camera,
                  const experiment::TrackOptions& options, const vision::TrackRun& run) {
  files::WriteFile(
      RunFileOf(job.log),
      report::TrackJson({vision::WithoutPassword(job.camera), job.calibration,
                         statistics::Hash128Text(files::ReadFile(job.calibration)), job.session},
                        camera, options, run, run.rows));
}

}  // namespace

experiment::TrackOptions TrackingJob::OptionsFor(const experiment::Experiment& experiment) const {
  experiment::TrackOptions said = experiment.track;
  said.tag = experiment::TagOn(experiment);
  if (fps) said.capture.fps = *fps;
  if (!times.empty()) said.capture.times = times;
  if (!ids.empty()) said.tag.id = ids.front();
  if (tag_height_m) said.tag.height_m = *tag_height_m;
  return said;
}

TrackingInputs ReadInputs(const TrackingJob& job) {
  view::TrackView::Content content = ContentOf(job);
  return {vision::ReadCamera(files::ReadFile(job.calibration), job.calibration),
          std::move(content)};
}

void Track(
    const TrackingJob& job, TrackingInputs inputs, const TrackingListener& listener,
    const std::function<void(const vision::TrackRun& run, const vision::TagOptions& tag)>& report) {
  experiment::TrackOptions options = job.options;
  vision::CameraSession session(job.camera, inputs.camera, options.capture, options.tag);
  options.capture = session.options();
  for (const int id : job.ids) vision::RequireTagId(id, options.tag.family);
  const bool has_size = TakeSize(job, listener, session);
  if (!job.world.empty()) SetAndSaveWorld(job, listener, session);
  if (job.log.empty()) return;
  OldLog old(job);
  const auto end = [&](const vision::TrackRun& run) {
    if (!job.IsPiped() && !old.IsThere()) WriteRunFile(job, session.camera(), options, run);
    report(run, options.tag);
  };
  if (!has_size) return end({.status = session.capture().Status()});
  SayWhatToExpect(job, listener.say, session);
  session.Restart();  // what was read so far of a recording belongs to its log as well
  TrackLog log(job.log, listener.print);
  std::vector<int> tag_ids = FurtherIds(job);
  tag_ids.insert(tag_ids.begin(), session.tag().id);
  const auto view = WindowFor(job, listener, session.camera(), tag_ids, std::move(inputs.content));
  vision::TrackParts parts{.session = session,
                           .options = job.session,
                           .further_ids = FurtherIds(job),
                           .log =
                               [&](double t_s, const auto& sighting) {
                                 old.Remove();
                                 return log.Add(t_s, sighting);
                               },
                           .duration_s = job.duration_s,
                           .is_stopped = listener.is_stopped,
                           .say = listener.say};
  if (view) parts.show = [&view](const auto&... moment) { return view->Show(moment...); };
  const vision::TrackRun run = RunTracking(parts);
  log.Close();
  if (run.frames > 0) old.Remove();
  end(run);
}

}  // namespace rift::sessions
