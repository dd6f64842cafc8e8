#include "rift/vision/calibration/chessboard.hpp"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "rift/limits/limits.hpp"
#include "rift/vision/camera/capture_options.hpp"
#include "rift/vision/camera/jpeg.hpp"
#include "rift/vision/camera/picture_file.hpp"
#include "rift/vision/camera/picture_reader.hpp"

namespace rift::vision {

namespace {

constexpr int kColour = 90;  // saturation of 255 that no grey cast of a lamp reaches

// Tried in turn: what one width misses the next may find. A board whose squares are too small at
// these is too far away to calibrate with, and a whole 1080p picture takes ten times as long.
constexpr std::array<double, 3> kSearchWidths_px{960.0, 1280.0, 720.0};

std::vector<cv::Point2f> FindSector(const cv::Mat& grey, cv::Size size, BoardSearch search) {
  std::vector<cv::Point2f> corners;
  const int effort = search == BoardSearch::kThorough ? cv::CALIB_CB_EXHAUSTIVE : 0;
  const bool found =
      cv::findChessboardCornersSB(grey, size, corners, cv::CALIB_CB_NORMALIZE_IMAGE | effort);
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

BoardView FindIn(const cv::Mat& picture, const Board& board, const std::string& name,
                 BoardSearch search) {
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
      const bool is_further = search == BoardSearch::kQuick && width_px != kSearchWidths_px.front();
      if (!corners.empty() || is_further) break;
      scale = std::min(1.0, width_px / grey.cols);
      cv::resize(grey, small, {}, scale, scale, cv::INTER_AREA);
      corners = method == BoardMethod::kSector ? FindSector(small, size, search)
                                               : FindClassic(small, size);
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

BoardView Unusable(const std::string& name, const std::string& problem) {
  BoardView view{.name = name};
  view.problem = problem;
  return view;
}

BoardView Undecodable(const std::string& name) {
  return Unusable(name, "the picture cannot be decoded");
}

/// OpenCV decodes a damaged JPEG with grey blocks, and has libjpeg complain on stderr.
bool IsDamagedJpeg(const std::vector<std::uint8_t>& bytes) {
  const auto size = SizeOfJpeg(bytes);
  return size && !JpegReader().Read(bytes, size->width_px, size->height_px,
                                    {0, 0, size->width_px, size->height_px});
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
    throw std::invalid_argument(fmt::format(
        "squares of {:g} m: the side of one square in metres is needed, above 0 and up to 10 "
        "(25 mm are 0.025)",
        square_m));
  }
}

BoardView FindBoard(const Frame& frame, const Board& board, const std::string& name,
                    BoardSearch search) {
  const cv::Mat picture = BgrOf(frame);
  return picture.empty() ? Undecodable(name) : FindIn(picture, board, name, search);
}

BoardView FindBoard(const std::string& path, const Board& board) {
  const std::string name = std::filesystem::path(path).filename().string();
  const PictureFile file =
      ReadPictureFile(path, limits::Most(limits::Amount::kFileBytes), CaptureOptions{}.most_mpixel);
  if (!file.problem.empty()) return Unusable(name, file.problem);
  if (IsDamagedJpeg(file.bytes)) {
    return Unusable(name, "its JPEG is damaged: copy it again, or leave it out");
  }
  const cv::Mat picture = DecodePicture(file.bytes, true);
  return picture.empty() ? Undecodable(name) : FindIn(picture, board, name, BoardSearch::kThorough);
}

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

}  // namespace rift::vision
