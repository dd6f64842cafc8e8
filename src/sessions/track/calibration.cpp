#include "rift/sessions/track/calibration.hpp"

#include <memory>
#include <vector>

#include "rift/view/calibration_view.hpp"
#include "rift/view/window.hpp"
#include "rift/vision/calibration/live_views.hpp"
#include "rift/vision/camera/camera_source.hpp"

namespace rift::sessions {
namespace {

using Say = std::function<void(const std::string&)>;

std::unique_ptr<view::CalibrationView> WindowFor(const CalibrationJob& job, const Say& say) {
  if (!job.view) return nullptr;
  if (const std::string missing = view::MissingDisplay(); !missing.empty()) {
    say(missing + "; what picture to take next is said here");
    return nullptr;
  }
  return std::make_unique<view::CalibrationView>();
}

}  // namespace

vision::Calibration Calibrate(const CalibrationJob& job, const std::function<bool()>& is_stopped,
                              const Say& say) {
  std::vector<vision::BoardView> views;
  if (job.images.empty()) {
    const auto window = WindowFor(job, say);
    vision::LiveListener listener{.is_stopped = is_stopped, .say = say, .give_up_s = job.give_up_s};
    if (window) listener.show = [&window](const auto& scene) { return window->Show(scene); };
    const auto capture = vision::OpenCapture(job.camera, job.options.capture);
    views = ViewsFromCamera(*capture, job.board, job.options.calibration, listener);
  } else {
    views = ViewsFromFiles(vision::ImageFiles(job.images), job.board, {is_stopped, say});
  }
  return vision::Calibrate(views, job.board, job.options.calibration);
}

}  // namespace rift::sessions
