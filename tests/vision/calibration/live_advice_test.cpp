// What is said to the one who holds the board, picture by picture, in whole lines.
#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "rift/vision/calibration/live_views.hpp"

namespace rift::vision {
namespace {

using Lines = std::vector<std::string>;

constexpr int kWidth_px = 480, kHeight_px = 360;
const Board kBoard{.columns = 13, .rows = 9, .square_m = 0.025};
const ViewPlace kMiddle{0.5, 0.5, 0.3, 0.0};

/// The board as it is printed, held at this place; none: paper alone.
Frame Held(const std::optional<ViewPlace>& place) {
  constexpr int kSquare_px = 15;
  const int columns = kBoard.columns + 1, rows = kBoard.rows + 1;  // squares
  cv::Mat1b sheet((rows + 2) * kSquare_px, (columns + 2) * kSquare_px, std::uint8_t{255});
  for (int row = 0; row < rows; ++row) {
    for (int column = row % 2; column < columns; column += 2) {
      sheet(cv::Rect((column + 1) * kSquare_px, (row + 1) * kSquare_px, kSquare_px, kSquare_px))
          .setTo(0);
    }
  }
  cv::Mat picture(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(255));
  if (place) {
    const auto outline = OutlineAt(*place, kBoard, kWidth_px, kHeight_px);
    std::vector<cv::Point2f> from, to;
    for (int i = 0; i < 4; ++i) {
      const int column = i == 1 || i == 2 ? columns : 2, row = i >= 2 ? rows : 2;
      from.emplace_back(kSquare_px * static_cast<float>(column) - 0.5F,
                        kSquare_px * static_cast<float>(row) - 0.5F);
      to.emplace_back(outline[i].cast<float>().x(), outline[i].cast<float>().y());
    }
    cv::warpPerspective(sheet, picture, cv::getPerspectiveTransform(from, to),
                        {kWidth_px, kHeight_px}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, 255);
  }
  Frame frame{.width_px = kWidth_px, .height_px = kHeight_px, .format = PixelFormat::kGrey};
  frame.bytes.assign(picture.datastart, picture.dataend);
  return frame;
}

/// A live camera that gives the next picture once the last one was searched, a tenth of a second
/// later by its own clock.
class PatientCapture : public Capture {
 public:
  explicit PatientCapture(std::vector<Frame> pictures) : pictures_(std::move(pictures)) {}
  std::optional<Frame> Next(double) override {
    if (is_held_ || next_ == pictures_.size()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return std::nullopt;
    }
    is_held_ = true;
    Frame frame = pictures_[next_];
    frame.index = next_;
    frame.captured_s = 0.1 * static_cast<double>(next_++);
    return frame;
  }
  CaptureStatus Status() const override {
    const bool is_over = !is_held_ && next_ == pictures_.size();
    return {.state = is_over ? CameraState::kEnded : CameraState::kRunning};
  }
  bool IsRecording() const override { return false; }
  void Release() { is_held_ = false; }

 private:
  std::vector<Frame> pictures_;
  std::size_t next_ = 0;
  bool is_held_ = false;
};

struct Heard {
  Lines advised, said;
  std::vector<LiveScene> scenes;
};

/// `input`: of the n-th picture, from 1.
Heard Hear(const std::vector<std::optional<ViewPlace>>& places,
           const std::function<LiveInput(int)>& input) {
  std::vector<Frame> pictures;
  for (const auto& place : places) pictures.push_back(Held(place));
  PatientCapture capture(std::move(pictures));
  Heard heard;
  std::string searched;
  LiveListener listener{.is_stopped = [] { return false; },
                        .say = [&](const std::string& line) { heard.said.push_back(line); },
                        .hint_s = 1e9};
  listener.show = [&](const LiveScene& scene) {
    if (scene.searched == nullptr || scene.searched->name == searched) return LiveInput{};
    searched = scene.searched->name;
    heard.advised.push_back(scene.advice);
    heard.scenes.push_back(scene);
    capture.Release();
    return input(static_cast<int>(heard.advised.size()));
  };
  ViewsFromCamera(capture, kBoard, {.good_views = 7, .good_coverage = 0.7}, listener);
  return heard;
}

TEST_CASE("Where views are taken by key, the way to the next place is told, and that it is there") {
  // The first view is wanted at the upper left, near and tilted.
  const ViewPlace wanted{0.05, 0.05, 0.5, 0.6};
  const Heard heard = Hear({kMiddle, kMiddle, wanted, wanted, std::nullopt},
                           [](int n) { return LiveInput{.toggle = n == 1}; });
  CHECK(heard.advised ==
        Lines{"hold the board still",
              "move it left and up in the picture, bring it nearer, tilt it by 40 degrees, one "
              "corner nearer than the opposite one",
              "hold the board still", "the board is well placed",
              "no chessboard of 13 x 9 inner corners in it: show all of it, with the white around "
              "its squares"});
  REQUIRE(heard.scenes.size() == 5);
  CHECK(heard.scenes[0].takes_by_itself);
  CHECK_FALSE(heard.scenes[1].takes_by_itself);
  CHECK(heard.scenes[0].good_views == 7);
  CHECK(heard.scenes[0].good_coverage == 0.7);
  CHECK(heard.scenes[0].board.columns == 13);
  CHECK(heard.scenes[0].status.state == CameraState::kRunning);
  REQUIRE(heard.said.size() == 1);
  CHECK(heard.said[0] ==
        "move the board about: near and far, to every edge, tilted; Ctrl-C ends and calibrates; "
        "first, hold the board at the upper left corner of the picture, near, so that it fills "
        "half of the picture, tilted by 40 degrees, one corner nearer than the opposite one");
}

TEST_CASE("A picture like one that was taken is told with its number and the way to the next") {
  const ViewPlace right{0.77, 0.5, 0.3, 0.0};
  const Heard heard = Hear({kMiddle, kMiddle, kMiddle, right, right, right, kMiddle},
                           [](int) { return LiveInput{}; });
  REQUIRE(heard.scenes.size() == 7);
  const auto way = [&](int n, const ViewPlace& from) {
    return WayTo(from, heard.scenes[static_cast<std::size_t>(n) - 1].next.place);
  };
  REQUIRE_FALSE(way(3, kMiddle).empty());
  REQUIRE_FALSE(way(6, right).empty());
  CHECK(heard.advised == Lines{"hold the board still", "view 1 is taken",
                               "like view 1: " + way(3, kMiddle), "hold the board still",
                               "view 2 is taken", "like view 2: " + way(6, right),
                               "like view 1: " + way(7, kMiddle)});
  REQUIRE(heard.said.size() == 3);
  CHECK(heard.said[1] == "view 1: frame000001; next, " + heard.scenes[2].next.text);
  CHECK(heard.said[2] == "view 2: frame000004; next, " + heard.scenes[5].next.text);
}

/// A live camera whose pictures come at once, and then so many times none.
class QuickCapture : public Capture {
 public:
  QuickCapture(std::vector<Frame> pictures, int turns_without)
      : pictures_(std::move(pictures)), turns_without_(turns_without) {}
  std::optional<Frame> Next(double timeout_s) override {
    longest_wait_s_ = std::max(longest_wait_s_, timeout_s);
    if (next_ == pictures_.size()) {
      --turns_without_;
      return std::nullopt;
    }
    Frame frame = pictures_[next_];
    frame.index = next_++;
    return frame;
  }
  CaptureStatus Status() const override {
    return {.state = turns_without_ > 0 ? CameraState::kRunning : CameraState::kEnded};
  }
  bool IsRecording() const override { return false; }
  double LongestWait_s() const { return longest_wait_s_; }

 private:
  std::vector<Frame> pictures_;
  std::size_t next_ = 0;
  int turns_without_;
  double longest_wait_s_ = 0.0;
};

TEST_CASE("Every picture is shown as it comes, and the same one is not drawn without end") {
  constexpr std::size_t kPictures = 20;
  constexpr int kTurnsWithout = 4000;
  QuickCapture capture(std::vector<Frame>(kPictures, Held(std::nullopt)), kTurnsWithout);
  std::vector<int> shown(kPictures, 0);
  LiveListener listener{
      .is_stopped = [] { return false; }, .say = [](const std::string&) {}, .hint_s = 1e9};
  listener.show = [&](const LiveScene& scene) {
    if (scene.frame != nullptr) ++shown.at(scene.frame->index);
    return LiveInput{};
  };
  ViewsFromCamera(capture, kBoard, {}, listener);
  for (const int times : shown) CHECK(times >= 1);
  // Ten times a second without a new one: far fewer than the turns, however busy the machine.
  CHECK(shown.back() < kTurnsWithout / 4);
  CHECK(capture.LongestWait_s() == Approx(0.02));  // so often are keys looked at
}

}  // namespace
}  // namespace rift::vision
