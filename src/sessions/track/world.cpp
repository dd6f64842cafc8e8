#include "world.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/files/files.hpp"
#include "rift/view/world_clicks.hpp"
#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/tracking/world_check.hpp"
#include "rift/vision/tracking/world_setting.hpp"

namespace rift::sessions {
namespace {

vision::WorldFrame WorldFor(const TrackingJob& job, const vision::WorldSetting& setting) {
  if (job.world == "first") return WorldFromRobot(setting);
  const vision::FloorMarks marks = vision::ReadFloorMarks(files::ReadFile(job.world), job.world);
  try {
    return marks.tags.empty() ? view::WorldFromClicks(setting, marks.points)
                              : WorldFromFloorTags(setting, marks.tags);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("--world {}: {}", job.world, error.what()));
  }
}

/// Throws std::invalid_argument when the file holds a better frame than the new one.
void RefuseWorse(const TrackingJob& job, const vision::CameraModel& camera,
                 const vision::WorldFrame& next) {
  if (job.force || !camera.world) return;
  const auto reason = vision::IsWorseThan(next, *camera.world);
  if (!reason) return;
  throw std::invalid_argument(
      fmt::format("--world: {} is left as it is, since {}: give --force to "
                  "replace it all the same",
                  job.calibration, *reason));
}

}  // namespace

void SetAndSaveWorld(const TrackingJob& job, const TrackingListener& listener,
                     vision::CameraSession& session) {
  const vision::WorldFrame found =
      WorldFor(job, {session, job.session, listener.is_stopped, listener.say});
  RefuseWorse(job, session.camera(), found);
  session.SetWorld(found);
  files::WriteFile(job.calibration,
                   vision::WriteCamera(session.camera(),
                                       vision::CommentOfCamera(files::ReadFile(job.calibration))));
  const vision::WorldFrame& world = *session.camera().world;
  listener.say(fmt::format("world frame from {}, {:.2f} mm off at its points, is now in {}",
                           world.origin, 1e3 * world.residual_m, job.calibration));
}

}  // namespace rift::sessions
