#include "rift/vision/calibration/chessboard.hpp"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "rift/vision/calibration/calibration.hpp"
#include "rift/vision/camera/picture_reader.hpp"

namespace rift::vision {

namespace {

constexpr int kColour = 90;  // saturation of 255 that no grey cast of a lamp reaches

// Tried in turn: what one width misses the next may find. A board whose squares are too small at
// these is too far away to calibrate with, and a whole 1080p picture takes ten times as long.
constexpr std::array<double, 3> kSearchWidths_px{960.0, 1280.0, 720.0};

std::vector<cv::Point2f> FindSector(const cv::Mat& grey, cv::Size size) {
  std::vector<cv::Point2f> corners;
  const bool found = cv::findChessboardCornersSB(
      grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE);
  return found ? corners : std::vector<cv::Point2f>{};
}

std::vector<cv::Point2f> FindClassic(const cv::Mat& grey, cv::Size size) {
  std::vector<cv::Point2f> corners;
  const bool found = cv::findChessboardCorners(
      grey, size, corners,
      cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK);
  return found ? corners : std::vector<cv::Point2f>{};
}

// The window of cornerSubPix must not reach the next corner.
int HalfWindow_px(const std::vector<cv::Point2f>& corners) {
  double nearest_px = 1e9;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    nearest_px = std::min(nearest_px, cv::norm(corners[i] - corners[i - 1]));
  }
  return std::clamp(static_cast<int>(nearest_px / 3.0), 2, 11);
}

/// From corners of a picture `scale` times as large to those of the whole one.
void Refine(const cv::Mat& grey, double scale, std::vector<cv::Point2f>& corners) {
  for (cv::Point2f& corner : corners) {
    corner.x = static_cast<float>((corner.x + 0.5) / scale - 0.5);
    corner.y = static_cast<float>((corner.y + 0.5) / scale - 0.5);
  }
  const int half_px = HalfWindow_px(corners);
  cv::cornerSubPix(grey, corners, {half_px, half_px}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 50, 1e-3});
}

// With odd numbers of corners both ways the board looks the same when turned by half a turn.
void StartAtUpperLeft(std::vector<cv::Point2f>& corners) {
  const cv::Point2f first = corners.front(), last = corners.back();
  if (first.x + first.y > last.x + last.y) std::reverse(corners.begin(), corners.end());
}

double ColouredShare(const cv::Mat& picture, const std::vector<cv::Point2f>& corners) {
  std::vector<cv::Point2f> hull;
  cv::convexHull(corners, hull);
  std::vector<cv::Point> outline(hull.begin(), hull.end());
  cv::Mat inside = cv::Mat::zeros(picture.size(), CV_8U), hsv;
  cv::fillConvexPoly(inside, outline, 255);
  cv::cvtColor(picture, hsv, cv::COLOR_BGR2HSV);
  cv::Mat coloured;  // dark pixels have a saturation of noise
  cv::inRange(hsv, cv::Scalar(0, kColour, 80), cv::Scalar(180, 255, 255), coloured);
  coloured &= inside;
  return static_cast<double>(cv::countNonZero(coloured)) / std::max(1, cv::countNonZero(inside));
}

bool IsBlack(const cv::Mat& grey) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(grey, mean, deviation);
  return mean[0] + 3.0 * deviation[0] < 40.0;
}

BoardView FindIn(const cv::Mat& picture, const Board& board, const std::string& name) {
  board.Check();
  BoardView view{.name = name, .width_px = picture.cols, .height_px = picture.rows};
  cv::Mat grey, small;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  if (IsBlack(grey)) {
    view.problem = "the picture is black";
    return view;
  }
  const cv::Size size(board.columns, board.rows);
  std::vector<cv::Point2f> corners;
  double scale = 1.0;
  for (const BoardMethod method : {BoardMethod::kSector, BoardMethod::kClassic}) {
    for (const double width_px : kSearchWidths_px) {
      if (!corners.empty()) break;
      scale = std::min(1.0, width_px / grey.cols);
      cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
      corners = method == BoardMethod::kSector ? FindSector(small, size) : FindClassic(small, size);
      view.method = method;
    }
  }
  if (corners.empty()) {
    view.method = BoardMethod::kNone;
    view.problem =
        fmt::format("no chessboard of {} x {} inner corners in it", board.columns, board.rows);
    return view;
  }
  Refine(grey, scale, corners);
  StartAtUpperLeft(corners);
  for (const cv::Point2f& corner : corners) view.corners.emplace_back(corner.x, corner.y);
  view.coloured = ColouredShare(picture, corners);
  return view;
}

BoardView Undecodable(const std::string& name) {
  BoardView view{.name = name};
  view.problem = "the picture cannot be decoded";
  return view;
}

}  // namespace

void Board::Check() const {
  if (columns < 3 || rows < 3 || columns > 100 || rows > 100) {
    throw std::invalid_argument(
        fmt::format("a board of {} x {} inner corners: there must be 3 to 100 both ways (squares "
                    "less one)",
                    columns, rows));
  }
  if (!(square_m > 0.0) || square_m > 10.0) {
    throw std::invalid_argument(
        fmt::format("squares of {} m: the side of one square in metres is needed", square_m));
  }
}

BoardView FindBoard(const Frame& frame, const Board& board, const std::string& name) {
  const cv::Mat picture = BgrOf(frame);
  return picture.empty() ? Undecodable(name) : FindIn(picture, board, name);
}

BoardView FindBoard(const std::string& path, const Board& board) {
  const std::string name = std::filesystem::path(path).filename().string();
  const cv::Mat picture = cv::imread(path, cv::IMREAD_COLOR);
  return picture.empty() ? Undecodable(name) : FindIn(picture, board, name);
}

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
    const Coverage c = CoverageOf(Used(), board_);
    return std::min({c.x, c.y, c.size, c.skew}) >= good_coverage;
  }
  NextView Next(double good_coverage) const { return NextViewFor(Used(), board_, good_coverage); }
  const std::vector<BoardView>& Views() const { return views_; }

 private:
  std::vector<ViewResult> Used() const {
    std::vector<ViewResult> used;
    for (const BoardView& view : views_) used.push_back({.view = view, .used = true});
    return used;
  }

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
      const BoardView view = FindBoard(*frame, board, fmt::format("frame{:06}", frame->index));
      if (!collector.Add(view)) continue;
      const NextView next = collector.Next(options.good_coverage);
      listener.say(fmt::format("view {}: {}; {}", collector.Views().size(), view.name,
                               next.text.empty() ? "everything is covered" : "next, " + next.text));
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
