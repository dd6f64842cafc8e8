#include "window.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/view/window.hpp"

namespace rift::sessions {

/// The path is a waypoint file or, told by its ending, a log.
view::TrackView::Content ContentOf(const TrackingJob& job) {
  view::TrackView::Content content;
  if (!job.record_waypoints.empty()) {
    content.save = [file = job.record_waypoints](const auto& waypoints) {
      files::WriteFile(file, report::WaypointsYaml(waypoints));
    };
  }
  if (job.path.empty()) return content;
  if (std::filesystem::path(job.path).extension() == ".csv") {
    const trajectory::Log log = trajectory::ReadLog(files::ReadFile(job.path), job.path);
    for (const auto& pose : log.trajectory.poses) content.path_m.push_back(pose.Position());
    return content;
  }
  content.planned = experiment::LoadExperiment(job.path, {}, files::ReadFile).waypoints;
  for (const auto& waypoint : content.planned) content.path_m.push_back(waypoint.Position());
  return content;
}

std::unique_ptr<view::TrackView> WindowFor(const TrackingJob& job, const TrackingListener& listener,
                                           const vision::CameraModel& camera,
                                           const std::vector<int>& tag_ids,
                                           view::TrackView::Content content) {
  if (!job.view && job.record_waypoints.empty()) return nullptr;
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    listener.say(fmt::format("{}; tracking goes on without{}", missing,
                             job.record_waypoints.empty() ? "" : ", no waypoints can be recorded"));
    return nullptr;
  }
  return std::make_unique<view::TrackView>(camera, tag_ids, std::move(content));
}

}  // namespace rift::sessions
