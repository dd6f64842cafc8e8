#include "rift/vision/rendering/synthetic_camera.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "rift/vision/camera/picture_reader.hpp"
#include "vision/rendered_tags.hpp"
#include "vision/small_recording.hpp"
#include "vision/tracking/edge_fit.hpp"

namespace rift::vision {
namespace {

/// Nothing that hides where the edges are.
SyntheticCameraOptions Clean() {
  SyntheticCameraOptions options;
  options.noise_grey = options.grain_grey = options.falloff = 0.0;
  return options;
}

TEST_CASE("Rendered chessboard corners lie where OpenCV projects them") {
  const CameraModel camera = test::PaperCamera();
  Scene scene;
  PlacedBoard board;
  board.world_from_board.linear() =
      (Eigen::AngleAxisd(0.4, Eigen::Vector3d(0.3, 1.0, 0.2).normalized()) *
       Eigen::Matrix3d(Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal()));
  board.world_from_board.translation() = Eigen::Vector3d(-0.25, 0.15, 0.1);
  scene.boards.push_back(board);
  std::mt19937_64 generator(1);
  Frame frame = SyntheticCamera(camera, Clean(), scene).Render({}, PixelFormat::kGrey, generator);

  const Eigen::Isometry3d camera_from_board =
      camera.world->world_from_camera.inverse() * board.world_from_board;
  std::vector<cv::Point3d> points;
  for (int row = 0; row < board.rows; ++row) {
    for (int column = 0; column < board.columns; ++column) {
      points.emplace_back(column * board.square_m, row * board.square_m, 0.0);
    }
  }
  cv::Mat k, rotation, turn;
  cv::eigen2cv(camera.k, k);
  cv::eigen2cv(Eigen::Matrix3d(camera_from_board.linear()), rotation);
  cv::Rodrigues(rotation, turn);
  const Eigen::Vector3d t = camera_from_board.translation();
  std::vector<cv::Point2d> projected;
  cv::projectPoints(points, turn, cv::Vec3d(t.x(), t.y(), t.z()), k, camera.distortion, projected);

  std::vector<cv::Point2f> seen(projected.begin(), projected.end());
  const cv::Mat picture(frame.height_px, frame.width_px, CV_8UC1, frame.bytes.data());
  cv::cornerSubPix(picture, seen, {5, 5}, {-1, -1}, {cv::TermCriteria::COUNT, 60, 0.0});
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  double worst = 0.0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Eigen::Vector2d error(seen[i].x - projected[i].x, seen[i].y - projected[i].y);
    mean += error / static_cast<double>(seen.size());
    worst = std::max(worst, error.norm());
  }
  CHECK(mean.norm() < 0.005);
  CHECK(worst < 0.1);  // cornerSubPix itself: its window of 11 px is not flat under this lens
  // The first four squares inside the corners: as on OpenCV's board, the outermost is black.
  const auto grey_between = [&](std::size_t i) {
    const auto next = i + static_cast<std::size_t>(board.columns) + 1;
    return int{picture.at<std::uint8_t>(cv::Point(0.5 * (projected[i] + projected[next])))};
  };
  CHECK(grey_between(0) < 80);
  CHECK(grey_between(1) > 140);
  CHECK(grey_between(static_cast<std::size_t>(board.columns)) > 140);
  CHECK(grey_between(static_cast<std::size_t>(board.columns) + 1) < 80);
}

TEST_CASE("The robot is drawn where its pose says and the right way round") {
  const CameraModel camera = test::PaperCamera();
  SyntheticCamera renderer(camera, Clean());
  std::mt19937_64 generator(1);
  const RobotMotion robot = test::RobotAt(-0.3, 0.1, 2.5);
  const auto picture = PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, generator));
  const TagCorners truth = test::TrueCorners(camera, robot);
  const std::vector<TagDetection> found = TagDetector(1, 0).Detect(*picture);
  REQUIRE(found.size() == 1);
  CHECK(found[0].id == 0);
  for (int i = 0; i < 4; ++i) CHECK((found[0].corners[i] - truth[i]).norm() < 0.3);
}

TEST_CASE("The same generator gives the same bytes and another one does not") {
  const CameraModel camera = test::PaperCamera();
  SyntheticCamera renderer(camera, {});
  SyntheticCamera again(camera, {});
  std::mt19937_64 first(1), second(1), third(2);
  const auto robot = test::RobotAt(0.0, 0.0, 1.0);
  const Frame frame = renderer.Render(robot, PixelFormat::kJpeg, first);
  CHECK(frame.bytes == again.Render(robot, PixelFormat::kJpeg, second).bytes);
  CHECK(frame.bytes != again.Render(robot, PixelFormat::kJpeg, third).bytes);
}

TEST_CASE("Sensor noise has the asked scatter and no memory") {
  SyntheticCamera renderer(test::PaperCamera(), {});
  std::mt19937_64 generator(1);
  const Frame a = renderer.Render({}, PixelFormat::kGrey, generator);
  const Frame b = renderer.Render({}, PixelFormat::kGrey, generator);
  double sum = 0.0, square = 0.0;
  for (std::size_t i = 0; i < a.bytes.size(); ++i) {
    const double difference = static_cast<double>(a.bytes[i]) - b.bytes[i];
    sum += difference;
    square += difference * difference;
  }
  const double count = static_cast<double>(a.bytes.size());
  CHECK(sum / count == Approx(0.0).margin(0.02));
  // Rounding to whole grey values adds 1/12.
  CHECK(std::sqrt(square / count) == Approx(std::sqrt(2.0 * (9.0 + 1.0 / 12.0))).epsilon(0.01));
}

/// Mean x of the tag's upper and lower edge in the picture, the robot standing upright in it.
std::array<double, 2> EdgeColumns(const CameraModel& camera, const SyntheticCameraOptions& options,
                                  const RobotMotion& robot) {
  std::mt19937_64 generator(1);
  SyntheticCamera renderer(camera, options);
  const auto picture = PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, generator));
  const auto square = FitSquare(camera, *picture, test::TrueCorners(camera, robot),
                                ShapeOf(TagFamily::k36h11), 30.0, {});
  REQUIRE(square);
  return {0.5 * (square->pixels[2].x() + square->pixels[3].x()),
          0.5 * (square->pixels[0].x() + square->pixels[1].x())};
}

TEST_CASE("A rolling shutter sees the lower rows of a moving robot later") {
  const CameraModel camera = test::PaperCamera();
  RobotMotion robot = test::RobotAt(0.0, 0.0, 0.0);
  const std::array<double, 2> still = EdgeColumns(camera, Clean(), robot);
  robot.velocity_mps = {1.0, 0.0, 0.0};
  SyntheticCameraOptions rolling = Clean();
  rolling.readout_s = 0.03;
  const std::array<double, 2> moved = EdgeColumns(camera, rolling, robot);
  const TagCorners corners = test::TrueCorners(camera, robot);
  const double rows = corners[0].y() - corners[3].y();
  const double expected_px = 1.0 * 0.03 * rows / camera.height_px * camera.k(0, 0) / 0.84;
  CHECK(moved[1] - moved[0] - (still[1] - still[0]) == Approx(expected_px).epsilon(0.1));
}

TEST_CASE("An open shutter smears a moving robot without moving its middle") {
  const CameraModel camera = test::PaperCamera();
  RobotMotion robot = test::RobotAt(0.0, 0.0, 0.0);
  const std::array<double, 2> still = EdgeColumns(camera, Clean(), robot);
  robot.velocity_mps = {0.2, 0.0, 0.0};
  SyntheticCameraOptions open = Clean();
  open.shutter_s = 0.01;
  std::mt19937_64 generator(1);
  CHECK(SyntheticCamera(camera, open).Render(robot, PixelFormat::kGrey, generator).bytes !=
        SyntheticCamera(camera, Clean()).Render(robot, PixelFormat::kGrey, generator).bytes);
  const std::array<double, 2> smeared = EdgeColumns(camera, open, robot);
  CHECK(smeared[0] == Approx(still[0]).margin(0.05));
  CHECK(smeared[1] == Approx(still[1]).margin(0.05));
}

TEST_CASE("A robot outside the picture leaves the floor as it is") {
  SyntheticCamera renderer(test::PaperCamera(), Clean());
  std::mt19937_64 generator(1);
  const Frame floor = renderer.Render({}, PixelFormat::kGrey, generator);
  CHECK(floor.bytes ==
        renderer.Render(test::RobotAt(3.0, 0.0, 0.0), PixelFormat::kGrey, generator).bytes);
  CHECK(floor.bytes ==
        renderer.Render(test::RobotAt(0.0, 0.0, 0.0, 2.0), PixelFormat::kGrey, generator).bytes);
}

TEST_CASE("A camera without a place in the world cannot be rendered") {
  CameraModel camera = test::PaperCamera();
  camera.world.reset();
  CHECK_THROWS_WITH(SyntheticCamera(camera, {}), Catch::Contains("camera paper"));
}

/// The grey values of a picture without anything that is told otherwise.
cv::Mat1b Greys(const CameraModel& camera, const SyntheticCameraOptions& options,
                const std::optional<RobotMotion>& robot = {}) {
  std::mt19937_64 generator(1);
  Frame frame = SyntheticCamera(camera, options).Render(robot, PixelFormat::kGrey, generator);
  return cv::Mat1b(frame.height_px, frame.width_px, frame.bytes.data()).clone();
}

TEST_CASE("Light falls off towards the corners, and the exposure multiplies all of it") {
  SyntheticCameraOptions options = Clean();
  options.floor_grey = 120.0;
  options.falloff = 0.4;
  options.exposure = 1.5;
  const cv::Mat1b picture = Greys(test::SmallCamera(), options);
  CHECK(picture(240, 320) == 180);
  CHECK(picture(0, 0) == Approx(180.0 * 0.6).margin(1.0));
  CHECK(picture(479, 639) == Approx(180.0 * 0.6).margin(1.5));
  // Half of the way to a corner is a quarter of its square.
  CHECK(picture(120, 160) == Approx(180.0 * 0.9).margin(1.0));
  CHECK(picture(240, 0) ==
        Approx(180.0 * (1.0 - 0.4 * 320.0 * 320.0 / (400.0 * 400.0))).margin(1.0));
}

TEST_CASE("Grain scatters the floor as it is asked to, one and the same in each picture") {
  SyntheticCameraOptions options = Clean();
  options.grain_grey = 8.0;
  options.blur_px = 0.0;
  const cv::Mat1b picture = Greys(test::SmallCamera(), options);
  cv::Scalar mean, deviation;
  cv::meanStdDev(picture, mean, deviation);
  CHECK(mean[0] == Approx(165.0).margin(2.0));
  CHECK(deviation[0] == Approx(8.0).epsilon(0.02));
  // Half of the variance each is noise that was smoothed by 1 px and by 20 px: smoothed by s px
  // more, 1 / (1 + s^2) and 400 / (400 + s^2) of it are left.
  cv::Mat1f smoothed;
  for (const double smooth_px : {2.0, 5.0}) {
    picture.convertTo(smoothed, CV_32F);
    cv::GaussianBlur(smoothed, smoothed, {}, smooth_px);
    cv::meanStdDev(smoothed, mean, deviation);
    const double more2 = smooth_px * smooth_px;
    CHECK(deviation[0] ==
          Approx(8.0 * std::sqrt(0.5 / (1.0 + more2) + 200.0 / (400.0 + more2))).epsilon(0.03));
  }
  CHECK(cv::norm(picture, Greys(test::SmallCamera(), options), cv::NORM_INF) == 0.0);
}

TEST_CASE("Every format holds the picture, and a frame says which it is") {
  SyntheticCamera renderer(test::SmallCamera(), Clean());
  std::mt19937_64 generator(1);
  const auto robot = test::RobotAt(0.1, -0.05, 1.0);
  const Frame grey = renderer.Render(robot, PixelFormat::kGrey, generator);
  const std::size_t pixels = 640 * 480;
  REQUIRE(grey.bytes.size() == pixels);
  CHECK((grey.width_px == 640 && grey.height_px == 480 && grey.format == PixelFormat::kGrey));
  const Frame bgr = renderer.Render(robot, PixelFormat::kBgr, generator);
  const Frame yuyv = renderer.Render(robot, PixelFormat::kYuyv, generator);
  REQUIRE((bgr.bytes.size() == 3 * pixels && yuyv.bytes.size() == 2 * pixels));
  CHECK((bgr.format == PixelFormat::kBgr && yuyv.format == PixelFormat::kYuyv));
  int wrong = 0;
  for (std::size_t i = 0; i < pixels; ++i) {
    for (std::size_t k = 0; k < 3; ++k) wrong += bgr.bytes[3 * i + k] != grey.bytes[i];
    wrong += yuyv.bytes[2 * i] != grey.bytes[i] || yuyv.bytes[2 * i + 1] != 128;
  }
  CHECK(wrong == 0);
}

TEST_CASE("A robot is a dark disc at its tag's height over a darker one at the floor") {
  const cv::Mat1b picture = Greys(test::SmallCamera(), Clean(), test::RobotAt(0.2, 0.0, 0.0));
  // 610 px a metre over 0.57 m and 0.6 m: discs about 214 and 203 px right of the middle, of 52 and
  // 49 px.
  const auto right_of_middle = [&](int px) { return int{picture(239, 320 + px)}; };
  CHECK(right_of_middle(150) == 165);
  CHECK(right_of_middle(158) == Approx(22.5).margin(1.0));
  CHECK(right_of_middle(172) == 45);
  CHECK(right_of_middle(262) == 45);
  CHECK(right_of_middle(270) == 165);
  SyntheticCameraOptions without = Clean();
  without.body_radius_m = 0.0;
  const cv::Mat1b bare = Greys(test::SmallCamera(), without, test::RobotAt(0.2, 0.0, 0.0));
  CHECK(bare(239, 320 + 172) == 165);
  // The white border of the tag, from 25 to 32 px from its middle.
  CHECK(int{bare(239, 320 + 186)} == Approx(215).margin(3.0));
}

TEST_CASE("A picture of no size is refused with it") {
  CameraModel camera = test::SmallCamera();
  camera.width_px = 0;
  CHECK_THROWS_WITH(SyntheticCamera(camera, {}), "camera small: 0 x 480 is no size of a picture");
  camera.width_px = 640;
  camera.height_px = 0;
  CHECK_THROWS_WITH(SyntheticCamera(camera, {}), Catch::Contains("640 x 0"));
}

/// The robot's heading as its corners in the picture say.
double SeenHeading_rad(const CameraModel& camera, const SyntheticCameraOptions& options,
                       const RobotMotion& robot, double at_s) {
  std::mt19937_64 generator(1);
  SyntheticCamera renderer(camera, options);
  const auto picture = PictureReader().Read(renderer.Render(robot, PixelFormat::kGrey, generator));
  RobotMotion then = robot;
  then.world_from_tag.linear() =
      Eigen::AngleAxisd(robot.yaw_rate_radps * at_s, Eigen::Vector3d::UnitZ()) *
      robot.world_from_tag.linear();
  then.world_from_tag.translation() += robot.velocity_mps * at_s;
  const auto square = FitSquare(camera, *picture, test::TrueCorners(camera, then),
                                ShapeOf(TagFamily::k36h11), 30.0, {});
  REQUIRE(square);
  const Eigen::Vector2d along =
      square->pixels[1] - square->pixels[0] + square->pixels[2] - square->pixels[3];
  return std::atan2(-along.y(), along.x());
}

TEST_CASE(
    "A rolling shutter sees a turning robot later in the lower half and sooner in the upper") {
  const CameraModel camera = test::SmallCamera();
  SyntheticCameraOptions rolling = Clean();
  rolling.readout_s = 0.04;
  for (const double yaw_rate_radps : {3.0, -3.0}) {
    for (const double y_m : {-0.15, 0.0, 0.15}) {
      RobotMotion robot = test::RobotAt(0.0, y_m, 0.2);
      robot.yaw_rate_radps = yaw_rate_radps;
      // In row 239.5 - 610 y / 0.57 of 480.
      const double at_s = 0.04 * ((240.0 - 610.0 * y_m / 0.57) / 480.0 - 0.5);
      CHECK(SeenHeading_rad(camera, rolling, robot, at_s) ==
            Approx(0.2 + yaw_rate_radps * at_s).margin(0.004));
    }
  }
}

TEST_CASE("A robot that drives through the middle of a rolling picture is where its pose says") {
  const CameraModel camera = test::SmallCamera();
  SyntheticCameraOptions rolling = Clean();
  rolling.readout_s = 0.03;
  RobotMotion robot = test::RobotAt(0.0, 0.0, 0.0);
  robot.velocity_mps = {1.0, 0.0, 0.0};
  const std::array<double, 2> moved = EdgeColumns(camera, rolling, robot);
  CHECK(0.5 * (moved[0] + moved[1]) == Approx(319.5).margin(0.2));
}

TEST_CASE("A robot that was elsewhere when its rows were read is drawn whole") {
  // At 2 m/s it is 6 cm from its place at either end of a readout of 60 ms.
  const CameraModel camera = test::SmallCamera();
  SyntheticCameraOptions rolling = Clean();
  rolling.readout_s = 0.06;
  for (const double sign : {-1.0, 1.0}) {
    RobotMotion robot = test::RobotAt(0.0, sign * 0.17, 0.0);
    robot.velocity_mps = {2.0, 0.0, 0.0};
    const cv::Mat1b picture = Greys(camera, rolling, robot);
    const int row = static_cast<int>(std::lround(239.5 - sign * 610.0 * 0.17 / 0.57));
    // About 320 + 610 / 0.57 * 2 * 0.06 * (row / 480 - 0.5) px its disc reaches 52 px to each side.
    const double middle_px = 319.5 + 610.0 / 0.57 * 0.12 * ((row + 0.5) / 480.0 - 0.5);
    for (const double off_px : {-46.0, 46.0}) {
      CHECK(picture(row, static_cast<int>(std::lround(middle_px + off_px))) < 100);
    }
    for (const double off_px : {-58.0, 58.0}) {
      CHECK(picture(row, static_cast<int>(std::lround(middle_px + off_px))) > 140);
    }
  }
}

TEST_CASE("An open shutter smears a robot that turns in its place") {
  const CameraModel camera = test::SmallCamera();
  RobotMotion robot = test::RobotAt(0.0, 0.0, 0.3);
  robot.yaw_rate_radps = 10.0;
  SyntheticCameraOptions open = Clean();
  open.shutter_s = 0.02;
  const cv::Mat1b sharp = Greys(camera, Clean(), robot), smeared = Greys(camera, open, robot);
  // The corners of the square go 0.1 rad to each side of where they are in its middle: 3.6 px.
  cv::Mat1b at_begin, at_end;
  robot.world_from_tag.linear() = test::RobotAt(0.0, 0.0, 0.2).world_from_tag.linear();
  at_begin = Greys(camera, Clean(), robot);
  robot.world_from_tag.linear() = test::RobotAt(0.0, 0.0, 0.4).world_from_tag.linear();
  at_end = Greys(camera, Clean(), robot);
  const double to_begin = cv::norm(smeared, at_begin, cv::NORM_L1),
               to_end = cv::norm(smeared, at_end, cv::NORM_L1),
               to_middle = cv::norm(smeared, sharp, cv::NORM_L1);
  CHECK(to_middle > 0.08 * cv::norm(at_begin, at_end, cv::NORM_L1));
  CHECK(to_middle < 0.8 * to_begin);
  CHECK(to_begin == Approx(to_end).epsilon(0.2));
}

TEST_CASE("A robot is drawn as far as it gets while its rows are read and the shutter is open") {
  // At 2 m/s, 2140 px/s, it goes 32 px to each side of where its rows are read, which is 24 px from
  // its place in rows 182 px from the middle.
  const CameraModel camera = test::SmallCamera();
  SyntheticCameraOptions both = Clean();
  both.readout_s = both.shutter_s = 0.03;
  for (const double sign : {-1.0, 1.0}) {
    RobotMotion robot = test::RobotAt(0.0, sign * 0.17, 0.0);
    robot.velocity_mps = {2.0, 0.0, 0.0};
    const cv::Mat1b picture = Greys(camera, both, robot);
    const int row = static_cast<int>(std::lround(239.5 - sign * 610.0 * 0.17 / 0.57));
    const auto beside = [&](double px) {
      return int{picture(row, static_cast<int>(std::lround(319.5 - sign * px)))};
    };
    // Of eight moments the last, 28 px ahead, has its disc of 52 px and 45 grey values over a pixel
    // 100 px on.
    CHECK(beside(100.0) == Approx(165.0 - 120.0 / 8.0).margin(3.0));
    CHECK(beside(115.0) == 165);
    CHECK(beside(-65.0) == 165);
  }
}

}  // namespace
}  // namespace rift::vision
