#include "rift/vision/calibration/live_views.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <deque>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "rift/vision/rendering/synthetic_camera.hpp"

namespace rift::vision {
namespace {

using Catch::Matchers::Contains;

const Board kBoard{.columns = 7, .rows = 5, .square_m = 0.03};

CameraModel Camera() {
  CameraModel camera;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.k << 610.0, 0.0, 322.0, 0.0, 612.0, 236.0, 0.0, 0.0, 1.0;
  camera.distortion = {-0.15, 0.05, 0.001, -0.0005, 0.0};
  WorldFrame world;
  world.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  world.world_from_camera.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  camera.world = world;
  return camera;
}

/// The board with its middle at this place, facing the camera but for a turn.
Frame Picture(const Eigen::Vector3d& middle_in_camera,
              const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  const CameraModel camera = Camera();
  PlacedBoard board{.columns = 7, .rows = 5, .square_m = 0.03};
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  camera_from_board.linear() = turn;
  camera_from_board.translation() =
      middle_in_camera - turn * Eigen::Vector3d(0.5 * 6 * 0.03, 0.5 * 4 * 0.03, 0.0);
  board.world_from_board = camera.world->world_from_camera * camera_from_board;
  std::mt19937_64 generator(3);
  return SyntheticCamera(camera, {.noise_grey = 1.0}, {.boards = {board}})
      .Render({}, PixelFormat::kJpeg, generator);
}

Frame WithoutBoard() {
  std::mt19937_64 generator(3);
  return SyntheticCamera(Camera(), {.noise_grey = 1.0}, {})
      .Render({}, PixelFormat::kJpeg, generator);
}

/// Gives each picture for as long as it is told, a tenth of a second apart by their own clock.
class ScriptedCapture : public Capture {
 public:
  ScriptedCapture(std::vector<Frame> pictures, bool is_recording)
      : pictures_(std::move(pictures)), is_recording_(is_recording) {}

  std::optional<Frame> Next(double) override {
    if (next_ == pictures_.size()) return std::nullopt;
    Frame frame = pictures_[next_];
    frame.index = next_;
    frame.captured_s = 0.1 * static_cast<double>(next_++);
    return frame;
  }
  CaptureStatus Status() const override {
    const bool is_over = next_ == pictures_.size();
    return {.state = is_over ? CameraState::kEnded : CameraState::kRunning};
  }
  bool IsRecording() const override { return is_recording_; }

 private:
  std::vector<Frame> pictures_;
  bool is_recording_;
  std::size_t next_ = 0;
};

/// A camera that gives the next picture only when the last one was searched.
class PatientCapture : public ScriptedCapture {
 public:
  using ScriptedCapture::ScriptedCapture;
  std::optional<Frame> Next(double timeout_s) override {
    if (is_held_) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // no turn of the loop for nothing
      return std::nullopt;
    }
    std::optional<Frame> frame = ScriptedCapture::Next(timeout_s);
    is_held_ = frame.has_value();
    return frame;
  }
  CaptureStatus Status() const override {
    return is_held_ ? CaptureStatus{.state = CameraState::kRunning} : ScriptedCapture::Status();
  }
  void Release() { is_held_ = false; }

 private:
  bool is_held_ = false;
};

struct Gathered {
  std::vector<BoardView> views;
  std::vector<std::string> said, advised;
};

/// Gathers from a live camera, each picture of which is searched. `input` of the n-th picture that
/// was searched, from 1.
Gathered Gather(
    std::vector<Frame> pictures,
    const std::function<LiveInput(int)>& input = [](int) { return LiveInput{}; }) {
  PatientCapture capture(std::move(pictures), false);
  Gathered gathered;
  std::string searched;
  int count = 0;
  LiveListener listener{.is_stopped = [] { return false; },
                        .say = [&](const std::string& line) { gathered.said.push_back(line); },
                        .hint_s = 1e9};  // however long a busy machine takes
  listener.show = [&](const LiveScene& scene) {
    if (scene.searched == nullptr || scene.searched->name == searched) return LiveInput{};
    searched = scene.searched->name;
    gathered.advised.push_back(scene.advice);
    capture.Release();
    return input(++count);
  };
  gathered.views = ViewsFromCamera(capture, kBoard, {}, listener);
  return gathered;
}

std::vector<std::string> Names(const std::vector<BoardView>& views) {
  std::vector<std::string> names;
  for (const BoardView& view : views) names.push_back(view.name);
  return names;
}

TEST_CASE("A board that moves before a live camera is not taken and one that rests is") {
  const Frame left = Picture({-0.06, 0.0, 0.45}), right = Picture({0.08, 0.03, 0.4});
  const Gathered gathered = Gather({left, right, left, right, right, right});
  // The fifth picture shows it where the fourth did.
  CHECK(Names(gathered.views) == std::vector<std::string>{"frame000004"});
  CHECK(gathered.advised[2] == "hold the board still");
  CHECK(gathered.advised[4] == "view 1 is taken");
  CHECK_THAT(gathered.advised[5], Contains("like view 1: "));
  CHECK_THAT(gathered.said.back(), Contains("view 1: frame000004; next, hold the board"));
}

TEST_CASE("A view is taken, taken back and refused by key") {
  const Frame left = Picture({-0.06, 0.0, 0.45}), right = Picture({0.08, 0.03, 0.4});
  const std::vector<Frame> pictures{left, left, left, right, right, left};
  const auto views = [&](const std::function<LiveInput(int)>& input) {
    return Names(Gather(pictures, input).views);
  };
  const std::vector<std::string> both{"frame000001", "frame000004"};
  CHECK(views([](int) { return LiveInput{}; }) == both);
  // Not by itself: none, but the one that is asked for, in motion or not.
  CHECK(views([](int n) { return LiveInput{.toggle = n == 1}; }).empty());
  CHECK(views([](int n) { return LiveInput{.take = n == 3, .toggle = n == 1}; }) ==
        std::vector<std::string>{"frame000003"});
  CHECK(views([](int n) { return LiveInput{.undo = n == 5}; }) ==
        std::vector<std::string>{"frame000001"});
  CHECK(views([](int n) { return LiveInput{.finish = n == 3}; }) ==
        std::vector<std::string>{"frame000001"});
}

TEST_CASE("Sixty views are enough, whoever takes them") {
  const std::vector<Frame> pictures(62, Picture({-0.06, 0.0, 0.45}));
  const auto take = [](int) { return LiveInput{.take = true}; };
  CHECK(Gather(pictures, take).views.size() == 60);
}

TEST_CASE("Why no view is taken is said where there is no window") {
  const Gathered gathered = Gather({WithoutBoard(), WithoutBoard()});
  CHECK(gathered.views.empty());
  CHECK_THAT(gathered.advised.front(),
             Contains("no chessboard of 7 x 5 inner corners") && Contains("show all of it"));
  // The same without a window, at once.
  ScriptedCapture capture({WithoutBoard(), WithoutBoard()}, true);
  std::vector<std::string> said;
  const auto views = ViewsFromCamera(capture, kBoard, {},
                                     {.is_stopped = [] { return false; },
                                      .say = [&](const std::string& line) { said.push_back(line); },
                                      .hint_s = 0.0});
  CHECK(views.empty());
  REQUIRE(said.size() == 2);
  CHECK_THAT(said[0], Contains("first, hold the board"));
  CHECK_THAT(said[1], Contains("no chessboard of 7 x 5"));
}

TEST_CASE("A camera that stays frozen ends the gathering with its reason") {
  class Frozen : public Capture {
   public:
    std::optional<Frame> Next(double) override { return std::nullopt; }
    CaptureStatus Status() const override {
      return {.state = CameraState::kFrozen, .reason = "no picture for 3.0 s"};
    }
    bool IsRecording() const override { return false; }
  } capture;
  std::vector<std::string> said;
  CHECK_THROWS_WITH(ViewsFromCamera(capture, kBoard, {},
                                    {.is_stopped = [] { return false; },
                                     .say = [&](const std::string& line) { said.push_back(line); },
                                     .give_up_s = 0.1}),
                    "no view of the board was taken: no picture for 3.0 s");
  CHECK(said.back() == "camera frozen: no picture for 3.0 s");
}

using Corners = std::array<Eigen::Vector2d, 4>;

/// The board as it is printed, its outermost inner corners there in the picture.
Frame Drawn(const Corners& outline) {
  constexpr int kSquare_px = 15;
  cv::Mat1b sheet(8 * kSquare_px, 10 * kSquare_px, std::uint8_t{255});
  for (int row = 0; row < 6; ++row) {
    for (int column = row % 2; column < 8; column += 2) {
      sheet(cv::Rect((column + 1) * kSquare_px, (row + 1) * kSquare_px, kSquare_px, kSquare_px))
          .setTo(0);
    }
  }
  std::vector<cv::Point2f> from, to;
  for (int i = 0; i < 4; ++i) {
    const int column = i == 1 || i == 2 ? 8 : 2, row = i >= 2 ? 6 : 2;
    from.emplace_back(kSquare_px * static_cast<float>(column) - 0.5F,
                      kSquare_px * static_cast<float>(row) - 0.5F);
    to.emplace_back(outline[i].cast<float>().x(), outline[i].cast<float>().y());
  }
  cv::Mat picture;
  cv::warpPerspective(sheet, picture, cv::getPerspectiveTransform(from, to), {320, 240},
                      cv::INTER_LINEAR, cv::BORDER_CONSTANT, 255);
  Frame frame{.width_px = 320, .height_px = 240, .format = PixelFormat::kGrey};
  frame.bytes.assign(picture.datastart, picture.dataend);
  return frame;
}

TEST_CASE("A view is unlike another by its place in x and y, its size and its skew together") {
  // Of the last two places one is like the first.
  const std::vector<ViewPlace> places{
      {0.5, 0.5, 0.3, 0.0}, {0.77, 0.5, 0.3, 0.0},  {0.5, 0.77, 0.3, 0.0}, {0.5, 0.5, 0.53, 0.0},
      {0.5, 0.5, 0.3, 0.6}, {0.43, 0.57, 0.3, 0.0}, {0.37, 0.37, 0.3, 0.0}};
  std::vector<Frame> pictures;
  for (const ViewPlace& place : places) {
    pictures.push_back(Drawn(OutlineAt(place, kBoard, 320, 240)));
  }
  // Of a recording each picture is searched, and none has to be held still.
  ScriptedCapture capture(pictures, true);
  const auto views = ViewsFromCamera(
      capture, kBoard, {}, {.is_stopped = [] { return false; }, .say = [](const std::string&) {}});
  CHECK(Names(views) == std::vector<std::string>{"frame000000", "frame000001", "frame000002",
                                                 "frame000003", "frame000004", "frame000006"});
}

TEST_CASE("A board is held still that moves by less than 4 px in a tenth of a second, anywhere") {
  Corners outline = OutlineAt({0.5, 0.5, 0.4, 0.0}, kBoard, 320, 240);
  std::vector<Frame> pictures{Drawn(outline)};
  const auto move = [&](double x_px, double y_px, double turn_rad) {
    const Eigen::Vector2d middle = 0.5 * (outline[0] + outline[2]);
    for (Eigen::Vector2d& corner : outline) {
      corner =
          middle + Eigen::Rotation2Dd(turn_rad) * (corner - middle) + Eigen::Vector2d(x_px, y_px);
    }
    pictures.push_back(Drawn(outline));
  };
  move(-3.2, 3.2, 0.0);
  move(0.0, 0.0, 0.06);  // its middle rests, and its corners, 82 px from there, move by 4.9 px
  move(2.5, -2.5, 0.0);
  const Gathered gathered = Gather(pictures);
  CHECK(gathered.advised == std::vector<std::string>{"hold the board still", "hold the board still",
                                                     "hold the board still", "view 1 is taken"});
}

/// A camera before which the board is held where it was asked for last, and still.
class ObedientCapture : public Capture {
 public:
  std::optional<Frame> Next(double) override {
    if (searched_ < given_) {  // not before the last one was looked at
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return std::nullopt;
    }
    Frame frame = picture_;
    frame.index = ++given_;
    frame.captured_s = 0.1 * given_;
    return frame;
  }
  CaptureStatus Status() const override { return {.state = CameraState::kRunning}; }
  bool IsRecording() const override { return false; }

  void Obey(const LiveScene& scene) {
    searched_ = given_;
    const bool is_free = scene.next.text.empty() && scene.advice != "hold the board still";
    if (scene.next.text == obeyed_ && !is_free) return;
    obeyed_ = scene.next.text;
    const CameraModel camera = Camera();
    const ViewPlace place = obeyed_.empty() ? Anywhere() : scene.next.place;
    const auto outline = OutlineAt(place, kBoard, camera.width_px, camera.height_px);
    const Eigen::Vector2d middle_px = (outline[0] + outline[1] + outline[2] + outline[3]) / 4.0;
    const double tilt_rad = place.skew > 0.3 ? 40.0 * 3.14159265 / 180.0 : 0.0;
    const double side_m = std::sqrt(6 * 0.03 * 4 * 0.03 * std::cos(tilt_rad));
    const double side_px = place.size * std::sqrt(640.0 * 480.0);
    const double distance_m = camera.k(0, 0) * side_m / side_px;
    const Eigen::Vector2d ray = RaysFromPixels(camera, {middle_px}).front();
    const Eigen::AngleAxisd turn(tilt_rad, Eigen::Vector3d(1.0, 1.0, 0.0).normalized());
    picture_ = Picture(distance_m * ray.homogeneous().eval(), turn.toRotationMatrix());
  }

 private:
  ViewPlace Anywhere() {
    const auto uniform = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random_);
    };
    return {uniform(0.05, 0.95), uniform(0.05, 0.95), uniform(0.25, 0.5), uniform(0.0, 0.6)};
  }

  Frame picture_ = WithoutBoard();
  std::string obeyed_ = "nothing yet";
  int given_ = 0, searched_ = 0;
  std::mt19937_64 random_{7};
};

TEST_CASE("Who follows the advice alone covers everything in a few views and calibrates well") {
  ObedientCapture capture;
  std::string searched;
  int asked = 0;
  std::vector<std::string> said;
  LiveListener listener{.is_stopped = [&] { return asked > 100; },
                        .say = [&](const std::string& line) { said.push_back(line); }};
  listener.hint_s = 1e9;  // however long a busy machine takes
  listener.show = [&](const LiveScene& scene) {
    if (scene.searched == nullptr || scene.searched->name == searched) return LiveInput{};
    searched = scene.searched->name;
    ++asked;
    capture.Obey(scene);
    return LiveInput{};
  };
  const std::vector<BoardView> views = ViewsFromCamera(capture, kBoard, {}, listener);
  const Calibration calibration = Calibrate(views, kBoard);
  INFO(asked << " pictures, " << views.size() << " views, "
             << (calibration.reasons.empty() ? "" : calibration.reasons.front()));
  CHECK(views.size() == 10);
  CHECK(asked < 60);
  // Once all is covered the number is counted down that is missing to ten.
  int counted = 0;
  for (std::size_t view = 1; view < 10; ++view) {
    if (!Contains("; everything is covered").match(said[view])) continue;
    CHECK_THAT(said[view], Contains(fmt::format("view {}: ", view)) &&
                               Contains(fmt::format("; {} more, unlike the others", 10 - view)));
    ++counted;
  }
  CHECK(counted > 0);
  CHECK_THAT(said.back(), Catch::Matchers::EndsWith("; everything is covered"));
  CHECK(calibration.next.text.empty());
  CHECK(calibration.verdict == CalibrationVerdict::kGood);
  CHECK(calibration.camera.k(0, 0) == Approx(610.0).epsilon(0.01));
}

TEST_CASE("The way from one place to another is told by position, distance and tilt") {
  const ViewPlace middle{0.5, 0.5, 0.3, 0.05};
  CHECK(WayTo(middle, {0.05, 0.95, 0.3, 0.05}) == "move it left and down in the picture");
  CHECK(WayTo(middle, {0.95, 0.5, 0.5, 0.05}) == "move it right in the picture, bring it nearer");
  CHECK(WayTo(middle, {0.5, 0.05, 0.2, 0.6}) ==
        "move it up in the picture, take it farther away, tilt it by 40 degrees, one corner nearer "
        "than the opposite one");
  CHECK(WayTo({0.5, 0.5, 0.3, 0.6}, middle) == "turn it to face the camera");
  CHECK(WayTo(middle, {0.52, 0.45, 0.33, 0.1}).empty());
}

TEST_CASE(
    "The outline of a wanted place has that place and leaves all of the board in the picture") {
  const Board board;
  const double skew = GENERATE(0.0, 0.6);
  for (const double size : {0.25, 0.5}) {
    for (const double x : {0.05, 0.5, 0.95}) {
      for (const double y : {0.05, 0.5, 0.95}) {
        const ViewPlace wanted{x, y, size, skew};
        const auto outline = OutlineAt(wanted, board, 1920, 1080);
        BoardView view{.width_px = 1920, .height_px = 1080};
        for (int row = 0; row < board.rows; ++row) {
          for (int column = 0; column < board.columns; ++column) {
            const double u = column / (board.columns - 1.0), v = row / (board.rows - 1.0);
            view.corners.push_back((1 - v) * ((1 - u) * outline[0] + u * outline[1]) +
                                   v * ((1 - u) * outline[3] + u * outline[2]));
          }
        }
        const ViewPlace place = PlaceOf(view, board);
        INFO(size << " " << x << " " << y << ": " << place.x << " " << place.y);
        CHECK(place.size == Approx(size));
        CHECK(place.skew == Approx(skew > 0.0 ? 0.53 : 0.0).margin(0.01));
        CHECK(WayTo(place, wanted).empty());
        for (const Eigen::Vector2d& corner : outline) {
          const double square_px = (outline[1] - outline[0]).norm() / (board.columns - 1);
          CHECK(corner.x() > square_px);
          CHECK(corner.y() > square_px);
          CHECK(corner.x() < 1920 - square_px);
          CHECK(corner.y() < 1080 - square_px);
        }
      }
    }
  }
}

/// A camera without a picture that goes through these states, one each time it is asked.
class StatefulCapture : public Capture {
 public:
  explicit StatefulCapture(std::vector<CaptureStatus> states) : states_(std::move(states)) {}
  std::optional<Frame> Next(double) override { return std::nullopt; }
  CaptureStatus Status() const override { return states_[std::min(asked_++, states_.size() - 1)]; }
  bool IsRecording() const override { return false; }

 private:
  std::vector<CaptureStatus> states_;
  mutable std::size_t asked_ = 0;
};

TEST_CASE("What becomes of the camera is said as it changes, but for its start and its end") {
  using State = CameraState;
  StatefulCapture capture({{.state = State::kOpening},
                           {.state = State::kRunning},
                           {.state = State::kBlack, .reason = "no light"},
                           {.state = State::kBlack, .reason = "no light"},
                           {.state = State::kRunning},
                           {.state = State::kReconnecting, .reason = "no route"},
                           {.state = State::kOpening},
                           {.state = State::kFrozen},
                           {.state = State::kEnded}});
  std::vector<std::string> said;
  const auto views =
      ViewsFromCamera(capture, kBoard, {},
                      {.is_stopped = [] { return false; },
                       .say = [&](const std::string& line) { said.push_back(line); }});
  CHECK(views.empty());
  REQUIRE(said.size() == 5);
  CHECK_THAT(said[0],
             Contains("Ctrl-C ends and calibrates; first, hold the board at the upper left"));
  said.erase(said.begin());
  CHECK(said == std::vector<std::string>{"camera black: no light", "camera running",
                                         "camera reconnecting: no route", "camera frozen"});
}

TEST_CASE(
    "A camera that ends before there was a view is an error, unless it was a recording's end") {
  const auto end_in = [](CameraState state) {
    StatefulCapture capture({{.state = state, .reason = "its reason"}});
    return ViewsFromCamera(
        capture, kBoard, {},
        {.is_stopped = [] { return false; }, .say = [](const std::string&) {}, .give_up_s = 0.0});
  };
  CHECK(end_in(CameraState::kEnded).empty());
  for (const CameraState state : {CameraState::kUnplugged, CameraState::kBlack}) {
    CHECK_THROWS_WITH(end_in(state), "no view of the board was taken: its reason");
  }
}

TEST_CASE("A view that is taken back is said, and the next one has its number") {
  const Frame left = Picture({-0.06, 0.0, 0.45}), right = Picture({0.08, 0.03, 0.4});
  const Gathered gathered =
      Gather({left, left, right, right}, [](int n) { return LiveInput{.undo = n == 1 || n == 2}; });
  CHECK(Names(gathered.views) == std::vector<std::string>{"frame000003"});
  REQUIRE(gathered.said.size() == 4);
  CHECK_THAT(gathered.said[1], Contains("view 1: frame000001; next, hold the board"));
  CHECK(gathered.said[2] == "view 1 is taken back");
  CHECK_THAT(gathered.said[3], Contains("view 1: frame000003; next, "));
}

}  // namespace
}  // namespace rift::vision
