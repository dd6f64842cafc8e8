#include <atomic>
#include <catch2/catch.hpp>
#include <filesystem>
#include <random>

#include "rift/vision/camera/camera_file.hpp"
#include "rift/vision/rendering/synthetic_camera.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/virtual_display.hpp"
#include "track/camera_to_calibrate.hpp"
#include "track/window_user.hpp"
#include "vision/mjpeg_server.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::CameraToCalibrate;
using test::CountOf;
using test::Environment;
using test::ProcessResult;
using test::Succeeds;

/// Pictures of a board of 7 x 5 corners, here and there, near and far, tilted this way and that.
std::vector<std::vector<std::uint8_t>> Views() {
  const vision::CameraModel camera = CameraToCalibrate();
  struct Held {
    double x, y, distance_m, tilt_rad, about_rad;
  };
  const std::vector<Held> all{
      {0.0, 0.0, 0.42, 0.0, 0.0},   {-0.24, -0.17, 0.62, 0.0, 0.0}, {0.24, 0.17, 0.62, 0.7, 0.8},
      {0.25, -0.17, 0.6, 0.7, 2.4}, {-0.25, 0.16, 0.6, 0.7, 0.8},   {0.0, 0.0, 0.34, 0.7, 2.4},
      {-0.2, 0.0, 0.5, 0.5, 0.0},   {0.2, 0.0, 0.55, 0.6, 1.57},    {0.0, 0.15, 0.52, 0.7, 0.8},
      {0.0, -0.15, 0.7, 0.0, 0.0},  {-0.2, -0.12, 0.5, 0.7, 2.4},   {0.22, 0.1, 0.45, 0.4, 1.57}};
  std::vector<std::vector<std::uint8_t>> jpegs;
  std::mt19937_64 generator(5);
  for (const Held& held : all) {
    vision::PlacedBoard board{.columns = 7, .rows = 5, .square_m = 0.03};
    Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
    const Eigen::Vector3d axis(std::cos(held.about_rad), std::sin(held.about_rad), 0.0);
    camera_from_board.linear() = Eigen::AngleAxisd(held.tilt_rad, axis).toRotationMatrix();
    camera_from_board.translation() =
        held.distance_m * Eigen::Vector3d(held.x, held.y, 1.0) -
        camera_from_board.linear() * Eigen::Vector3d(0.5 * 6 * 0.03, 0.5 * 4 * 0.03, 0.0);
    board.world_from_board = camera.world->world_from_camera * camera_from_board;
    jpegs.push_back(vision::SyntheticCamera(camera, {.noise_grey = 1.5}, {.boards = {board}})
                        .Render({}, vision::PixelFormat::kJpeg, generator)
                        .bytes);
  }
  return jpegs;
}

/// An http camera before which somebody holds the board in one place until told to move on.
class HeldBoard {
 public:
  explicit HeldBoard(double fps)
      : server_([this] { return views_[at_ % views_.size()]; }, {.fps = fps}) {}
  void MoveOn() { ++at_; }
  std::size_t At() const { return at_; }
  std::size_t Count() const { return views_.size(); }
  std::string Url() const { return server_.Url(); }

 private:
  std::vector<std::vector<std::uint8_t>> views_ = Views();
  std::atomic<std::size_t> at_ = 0;
  vision::synthetic::MjpegServer server_;
};

std::vector<std::string> Calibrating(const HeldBoard& board, const std::string& out) {
  return {"track",
          "--calibrate",
          "--board",
          "7x5",
          "--square",
          "0.03",
          "--camera",
          board.Url(),
          "--out",
          out,
          "--view",
          "--set",
          "track.capture.silent_s=60",
          "--set",
          "track.capture.same_s=60"};
}

TEST_CASE("A board moved about before a live camera calibrates it, and the window asks for keys") {
  const bool is_early = GENERATE(false, true);
  const test::VirtualDisplay server;
  if (!test::CanUseWindows(server)) return;
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  HeldBoard board(12.0);
  test::RunningRift rift(Calibrating(board, folder / "cam.yaml"));
  const std::string window =
      test::WindowOf("rift track: calibration") + "windowfocus --sync %1 key ";
  const auto says = [&](const std::string& line, int times = 1) {
    rift.WaitUntil(line, [&] { return CountOf(line, rift.Err()) >= times; });
  };
  says("first, hold the board");
  says("view 1: ");
  rift.WaitUntil("the window takes a key", [&] { return Succeeds(window + "Shift"); });
  REQUIRE(Succeeds(window + "u"));
  says("view 1 is taken back");
  // It is taken again, where the board still is: moved on before, it would be two views later.
  says("view 1: ", 2);
  // Ten are enough, and then it ends by itself; on a key before.
  for (std::size_t view = 1; view <= (is_early ? 6U : 10U); ++view) {
    says("view " + std::to_string(view) + ": ");
    board.MoveOn();
  }
  if (is_early) REQUIRE(Succeeds(window + "q"));
  const ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK_THAT(result.out, Contains("verdict: "));
  const vision::CameraModel found =
      vision::ReadCamera(test::ReadFile(folder / "cam.yaml"), "cam.yaml");
  CHECK(found.k(0, 0) == Approx(610.0).epsilon(0.02));
}

TEST_CASE("Without a display what picture to take next is said instead") {
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", "");
  HeldBoard board(5.0);  // each picture is searched
  test::RunningRift rift(Calibrating(board, folder / "cam.yaml"));
  const auto says = [&](const std::string& line) {
    rift.WaitUntil(line, [&] { return rift.Err().find(line) != std::string::npos; });
  };
  says("no window: DISPLAY is not set");
  says("view 1: ");
  says("next, hold the board");
  says("like view 1: ");  // it was not moved
  rift.Signal(SIGINT);
  const ProcessResult result = rift.Wait();
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.out, Contains("only 1 of 1 views can be used"));
  CHECK_FALSE(std::filesystem::exists(folder / "cam.yaml"));
}

}  // namespace
}  // namespace rift
