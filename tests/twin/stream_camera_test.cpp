#include "twin/stream_camera.hpp"

#include <catch2/catch.hpp>
#include <chrono>
#include <ctime>
#include <thread>
#include <utility>

#include "mjpeg_client.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "support/inputs/paper_camera.hpp"

namespace rift::twin {
namespace {

/// An eighth of the pixels each way: what is in a picture does not matter here.
vision::CameraModel TinyCamera() {
  vision::CameraModel camera = test::PaperCamera();
  camera.width_px /= 8;
  camera.height_px /= 8;
  camera.k.topRows<2>() /= 8.0;
  return camera;
}

TEST_CASE("Each picture is of its very moment and held back until it is due, however late") {
  TwinSetup setup;
  setup.twin.fps = 20.0;
  setup.twin.host_share_s = 0.0;
  setup.simulation.mocap.exposure_s = 0.0;
  setup.simulation.mocap.processing_s = 5.0;
  setup.simulation.mocap.tag_ahead_m = setup.simulation.mocap.tag_above_m = 0.0;
  TruePath path(simulation::TruePose{});
  for (int i = 1; i <= 27; ++i) {
    const double t_s = 0.01 * i;
    path.Add({t_s, 0.1 * t_s, -0.2 * t_s, 0.3 * t_s, 0.4 * t_s, -0.5 * t_s, 0.6 * t_s});
  }
  TwinRun run;
  double used_s = 0.0;
  // A busy machine takes fewer in that time.
  test::WaitUntil("six pictures were taken before they were due", [&] {
    run = {};
    MjpegServer server(0);
    MjpegClient client(PortOf(server.Url()));
    client.Ask("/stream.mjpg");
    WaitForClients(server, 1);
    vision::SyntheticCamera pictures(TinyCamera(), {});
    const std::clock_t before = std::clock();
    std::atomic<double> epoch_s = vision::SteadyNow_s() + 60.0;
    StreamCamera camera(setup, std::move(pictures), path, server, epoch_s);
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    epoch_s = vision::SteadyNow_s() - 6.0;
    CHECK_THAT(client.Until("Content-Length"), Catch::Contains("Content-Length"));
    CHECK_NOTHROW(camera.RethrowFailure());
    camera.Finish(run);
    used_s = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    return run.pictures == 6;
  });
  REQUIRE(run.tag.poses.size() == 6);
  for (int i = 0; i < 6; ++i) {
    const double t_s = 0.05 * i;
    const trajectory::StampedPose& pose = run.tag.poses[static_cast<std::size_t>(i)];
    CHECK(pose.t_s == Approx(t_s));
    CHECK(pose.x_m == Approx(0.1 * t_s));
    CHECK(pose.y_m == Approx(-0.2 * t_s));
    CHECK(pose.z_m == Approx(0.3 * t_s));
    CHECK(pose.roll_rad == Approx(0.4 * t_s));
    CHECK(pose.pitch_rad == Approx(-0.5 * t_s));
    CHECK(pose.yaw_rad == Approx(0.6 * t_s));
  }
  // The first was due a second before the moment from which on they were published.
  CHECK(run.picture_late_p99_s > 0.98);
  CHECK(run.picture_late_p99_s < 5.0);
  CHECK(run.picture_cpu_s > 0.0);
  CHECK(6 * run.picture_cpu_s <= used_s + 1e-5);
}

}  // namespace
}  // namespace rift::twin
