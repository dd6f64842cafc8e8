#include "rift/vision/calibration/board_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/vision/calibration/calibration.hpp"

namespace rift::vision {
namespace {

constexpr double kTick_s = 0.02;
// ROS's camera_calibration takes a view that differs by this much from all others.
constexpr double kUnlike = 0.2;
constexpr std::size_t kMostViews = 60;

double Distance(const ViewPlace& a, const ViewPlace& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.size - b.size) +
         std::abs(a.skew - b.skew);
}

/// Views from a camera, each unlike those before.
class ViewCollector {
 public:
  explicit ViewCollector(const Board& board) : board_(board) {}

  bool Add(const BoardView& view) {
    if (view.corners.empty()) return false;
    const ViewPlace place = PlaceOf(view, board_);
    const bool is_new = std::all_of(places_.begin(), places_.end(), [&](const auto& other) {
      return Distance(place, other) > kUnlike;
    });
    if (!is_new) return false;
    places_.push_back(place);
    views_.push_back(view);
    return true;
  }
  bool IsCovered(double good_coverage) const {
    std::vector<ViewResult> used;
    for (const BoardView& view : views_) used.push_back({.view = view, .used = true});
    const Coverage c = CoverageOf(used, board_);
    return std::min({c.x, c.y, c.size, c.skew}) >= good_coverage;
  }
  const std::vector<BoardView>& Views() const { return views_; }

 private:
  Board board_;
  std::vector<BoardView> views_;
  std::vector<ViewPlace> places_;
};

}  // namespace

std::vector<BoardView> ViewsFromFiles(const std::vector<std::string>& files, const Board& board,
                                      const ViewListener& listener) {
  std::vector<BoardView> views;
  for (const std::string& file : files) {
    if (listener.is_stopped()) throw std::runtime_error("stopped before all pictures were read");
    views.push_back(FindBoard(file, board));
    const BoardView& view = views.back();
    listener.say(fmt::format(
        "{}: {}", view.name,
        view.problem.empty() ? fmt::format("{} corners", view.corners.size()) : view.problem));
  }
  return views;
}

std::vector<BoardView> ViewsFromCamera(Capture& capture, const Board& board,
                                       const CalibrationOptions& options,
                                       const ViewListener& listener) {
  ViewCollector collector(board);
  listener.say(
      "move the board about: near and far, to every edge, tilted; Ctrl-C ends and calibrates");
  const auto needed = static_cast<std::size_t>(options.good_views);
  while (!listener.is_stopped() && collector.Views().size() < kMostViews) {
    const std::optional<Frame> frame = capture.Next(kTick_s);
    if (frame) {
      const std::string name = fmt::format("frame{:06}", frame->index);
      if (!collector.Add(FindBoard(*frame, board, name))) continue;
      listener.say(fmt::format("view {}: {}", collector.Views().size(), name));
    }
    const bool is_plenty =
        collector.Views().size() >= needed && collector.IsCovered(options.good_coverage);
    if (!capture.IsRecording() && is_plenty) break;
    const CaptureStatus status = capture.Status();
    if (frame || !IsFinal(status.state)) continue;
    if (status.state == CameraState::kEnded) break;
    listener.say(fmt::format("camera {}: {}",
                             EnumNames(status.state)[static_cast<std::size_t>(status.state)],
                             status.reason));
    if (collector.Views().empty()) throw std::runtime_error("no view of the board was taken");
    break;
  }
  return collector.Views();
}

}  // namespace rift::vision
