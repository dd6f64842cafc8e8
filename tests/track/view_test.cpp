#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "rift/vision/camera/camera_file.hpp"
#include "support/inputs/trials.hpp"
#include "support/processes/environment.hpp"
#include "support/processes/running_rift.hpp"
#include "support/processes/virtual_display.hpp"
#include "support/tree.hpp"
#include "track/window_user.hpp"

namespace rift {
namespace {

using Catch::Matchers::Contains;
using test::CountOf;
using test::Environment;
using test::ProcessResult;
using test::Succeeds;

const std::string kData = test::SourceDir() + "/data/camera";

TEST_CASE("Waypoints clicked in the window drive the simulator as they are") {
  const test::VirtualDisplay server;
  if (!test::CanUseWindows(server)) return;
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  // The shim's camera goes on for ever.
  const std::string waypoints = folder / "wp.yaml";
  ProcessResult result;
  {
    const Environment jpegs("RIFT_SHIM_JPEGS", kData + "/frames");
    const Environment shim("LD_PRELOAD", test::BuildDir() + "/tests/librift_v4l2_shim.so");
    test::RunningRift rift({"track", "--camera", "/dev/video0", "--calibration",
                            kData + "/camera.yaml", "--out", folder / "log.csv", "--view",
                            "--record-waypoints", waypoints, "--set", "track.capture.silent_s=60"});
    {
      const Environment none("LD_PRELOAD", "");
      const std::string window = test::WindowOf("rift track");
      test::WaitForPicture(rift, window);
      // Each click and key but the last changes the file.
      const auto saved = [&] {
        return std::filesystem::exists(waypoints) ? test::ReadFile(waypoints) : "";
      };
      const auto act = [&](const std::string& what, const auto& is_saved) {
        INFO(what);
        REQUIRE(Succeeds(window + what));
        rift.WaitUntil(what + " is saved", is_saved);
      };
      const std::vector<std::string> places{"120 300", "320 260", "500 100", "520 220"};
      for (std::size_t i = 0; i < places.size(); ++i) {
        act("mousemove --window %1 " + places[i] + " click 1",
            [&] { return CountOf("name:", saved()) == static_cast<int>(i) + 1; });
      }
      act("windowfocus --sync %1 key u", [&] { return CountOf("name:", saved()) == 3; });
      act("windowfocus --sync %1 key s", [&] { return CountOf("stop: false", saved()) == 1; });
      REQUIRE(Succeeds(window + "windowfocus --sync %1 key q"));
    }
    result = rift.Wait();
  }
  INFO(result.out << result.err << test::ReadFile(waypoints));
  CHECK(result.exit_code == 0);
  const std::string yaml = test::ReadFile(waypoints);
  CHECK_THAT(yaml, Contains("start") && Contains("wp2") && !Contains("wp3"));
  CHECK_THAT(yaml, Contains("stop: false"));
  const ProcessResult simulated = test::RunRift(
      {"simulate", waypoints, "--out", folder / "sim", "--set", "trial.timeout_s=20"});
  INFO(simulated.err);
  CHECK(simulated.exit_code <= 1);
  CHECK(std::filesystem::exists(folder / "sim/trajectory.csv"));
}

TEST_CASE("Who leaves the window in which points are clicked sets no world frame") {
  const test::VirtualDisplay server;
  if (!test::CanUseWindows(server)) return;
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  const std::string calibration = test::ReadFile(kData + "/camera.yaml");
  test::WriteText(folder / "camera.yaml", calibration);
  test::WriteText(folder / "world.yaml",
                  "points: [{name: a, x_m: 0, y_m: 0}, {name: b, x_m: 1, y_m: 0}, {name: c, x_m: "
                  "1, y_m: 1}, {name: d, x_m: 0, y_m: 1}]\n");
  test::RunningRift rift({"track", "--camera", kData + "/frames/*.jpg", "--calibration",
                          folder / "camera.yaml", "--out", folder / "log.csv", "--world",
                          folder / "world.yaml"});
  const std::string window = test::WindowOf("rift track: world frame");
  test::WaitForPicture(rift, window);
  REQUIRE(Succeeds(window + "windowfocus --sync %1 key q"));
  const ProcessResult result = rift.Wait();
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::EndsWith("rift: ended before the world frame was set\n"));
  CHECK(test::ReadFile(folder / "camera.yaml") == calibration);
  CHECK_FALSE(std::filesystem::exists(folder / "log.csv"));
}

TEST_CASE("Points of the floor clicked in the window set the world frame") {
  const test::VirtualDisplay server;
  if (!test::CanUseWindows(server)) return;
  const test::TemporaryFolder folder;
  const Environment display("DISPLAY", server.Name());
  const std::string file = kData + "/camera.yaml";
  const vision::CameraModel truth = vision::ReadCamera(test::ReadFile(file), file);
  vision::CameraModel camera = truth;
  camera.world.reset();
  test::WriteText(folder / "camera.yaml", vision::WriteCamera(camera));
  const std::vector<Eigen::Vector2d> points{{-0.2, -0.15}, {0.25, -0.1}, {0.2, 0.15}, {-0.15, 0.2}};
  std::string marks = "points:\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    marks += fmt::format("  - {{name: p{}, x_m: {}, y_m: {}}}\n", i, points[i].x(), points[i].y());
  }
  test::WriteText(folder / "world.yaml", marks);
  test::RunningRift rift({"track", "--camera", kData + "/frames/*.jpg", "--calibration",
                          folder / "camera.yaml", "--out", folder / "log.csv", "--world",
                          folder / "world.yaml"});
  const std::string window = test::WindowOf("rift track: world frame");
  test::WaitForPicture(rift, window);
  const auto click = [&](const Eigen::Vector2d& pixel) {
    REQUIRE(Succeeds(
        window + fmt::format("mousemove --window %1 {:.0f} {:.0f} click 1", pixel.x(), pixel.y())));
  };
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector3d p_in_world(point.x(), point.y(), 0.0);
    const auto pixels =
        vision::PixelsFromPoints(truth, {truth.world->world_from_camera.inverse() * p_in_world});
    click(pixels.front());
  }
  const ProcessResult result = rift.Wait();
  INFO(result.out << result.err);
  REQUIRE(result.exit_code == 0);
  CHECK_THAT(result.err, Contains("world frame from 4 clicked points"));
  const vision::CameraModel found =
      vision::ReadCamera(test::ReadFile(folder / "camera.yaml"), "camera.yaml");
  REQUIRE(found.world);
  // Half a pixel is 0.4 mm there.
  CHECK(
      (found.world->world_from_camera.translation() - truth.world->world_from_camera.translation())
          .norm() < 0.005);
  CHECK(found.world->residual_m < 0.001);
  const auto run = nlohmann::json::parse(test::ReadFile(folder / "log.run.json"));
  CHECK(run["frame"]["origin"] == "4 clicked points");
}

}  // namespace
}  // namespace rift
