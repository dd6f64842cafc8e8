#include "track_calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "enum_name.hpp"
#include "rift/vision/camera/capture_thread.hpp"
#include "rift/vision/camera/image_files.hpp"

namespace rift::commands {
namespace {

constexpr double kTick_s = 0.02;
// ROS's camera_calibration takes a view that differs by this much from all others.
constexpr double kUnlike = 0.2;
constexpr std::size_t kMostViews = 60;

double Distance(const vision::ViewPlace& a, const vision::ViewPlace& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.skew - b.skew);
}

/// Views from a camera, each unlike those before.
class ViewCollector {
 public:
  explicit ViewCollector(const vision::Board& board) : board_(board) {}

  bool Add(const vision::BoardView& view) {
    if (view.corners.empty()) return false;
    const vision::ViewPlace place = vision::PlaceOf(view, board_);
    const bool is_new = std::all_of(places_.begin(), places_.end(), [&](const auto& other) {
      return Distance(place, other) > kUnlike;
    });
    if (!is_new) return false;
    places_.push_back(place);
    views_.push_back(view);
    return true;
  }
  bool IsCovered(double good_coverage) const {
    std::vector<vision::ViewResult> used;
    for (const vision::BoardView& view : views_) used.push_back({.view = view, .used = true});
    const vision::Coverage c = vision::CoverageOf(used, board_);
    return std::min({c.x, c.y, c.size, c.skew}) >= good_coverage;
  }
  const std::vector<vision::BoardView>& Views() const { return views_; }

 private:
  vision::Board board_;
  std::vector<vision::BoardView> views_;
  std::vector<vision::ViewPlace> places_;
};

std::vector<vision::BoardView> FromFiles(const TrackRequest& request,
                                         const std::function<bool()>& is_stopped,
                                         const std::function<void(const std::string&)>& say) {
  std::vector<vision::BoardView> views;
  for (const std::string& file : vision::ImageFiles(request.images)) {
    if (is_stopped()) throw std::runtime_error("stopped before all pictures were read");
    views.push_back(vision::FindBoard(file, request.board));
    const vision::BoardView& view = views.back();
    say(fmt::format(
        "{}: {}", view.name,
        view.problem.empty() ? fmt::format("{} corners", view.corners.size()) : view.problem));
  }
  return views;
}

std::vector<vision::BoardView> FromCamera(const TrackRequest& request,
                                          const experiment::TrackOptions& options,
                                          const std::function<bool()>& is_stopped,
                                          const std::function<void(const std::string&)>& say) {
  const auto capture = vision::OpenCapture(request.camera, options.capture);
  ViewCollector collector(request.board);
  say("move the board about: near and far, to every edge, tilted; Ctrl-C ends and calibrates");
  const auto needed = static_cast<std::size_t>(options.calibration.good_views);
  while (!is_stopped() && collector.Views().size() < kMostViews) {
    const auto frame = capture->Next(kTick_s);
    if (frame) {
      const std::string name = fmt::format("frame{:06}", frame->index);
      const vision::BoardView view = vision::FindBoard(*frame, request.board, name);
      if (!collector.Add(view)) continue;
      say(fmt::format("view {}: {}", collector.Views().size(), name));
    }
    const bool is_plenty = collector.Views().size() >= needed &&
                           collector.IsCovered(options.calibration.good_coverage);
    if (!capture->IsRecording() && is_plenty) break;
    const vision::CaptureStatus status = capture->Status();
    if (frame || !vision::IsFinal(status.state)) continue;
    if (status.state != vision::CameraState::kEnded) {
      say(fmt::format("camera {}: {}", NameOf(status.state), status.reason));
    }
    if (collector.Views().empty() && status.state != vision::CameraState::kEnded) {
      throw std::runtime_error("no view of the board was taken");
    }
    break;
  }
  return collector.Views();
}

}  // namespace

vision::Calibration CalibrateFor(const TrackRequest& request,
                                 const experiment::TrackOptions& options,
                                 const std::function<bool()>& is_stopped,
                                 const std::function<void(const std::string&)>& say) {
  const std::vector<vision::BoardView> views = request.images.empty()
                                                   ? FromCamera(request, options, is_stopped, say)
                                                   : FromFiles(request, is_stopped, say);
  return vision::Calibrate(views, request.board, options.calibration);
}

}  // namespace rift::commands
