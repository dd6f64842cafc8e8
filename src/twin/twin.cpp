#include "rift/twin/twin.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <thread>

#include "mjpeg_server.hpp"
#include "pacing.hpp"
#include "pseudo_terminal.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/twin/options.hpp"
#include "rift/vision/camera/steady_now.hpp"
#include "stream_camera.hpp"
#include "true_path.hpp"
#include "twin_robot.hpp"

namespace rift::twin {
namespace {

constexpr double kPoll_s = 0.001;

// The overhead camera.
constexpr int kWidth_px = 1920;
constexpr int kHeight_px = 1080;
constexpr double kFocal_px = 1092.0;
constexpr double kMargin_m = 0.10;  // the robot's body, and how far it may stray

Eigen::AlignedBox2d BoxOf(const control::Task& task) {
  Eigen::AlignedBox2d box;
  for (const control::TimedPose& at : task.IdealPath()) box.extend(at.world_from_robot.Position());
  return box;
}

/// The height from which the whole task is seen.
double NeededHeight_m(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d half = 0.5 * box.sizes() + Eigen::Vector2d::Constant(kMargin_m);
  return std::max(half.x() / (0.5 * kWidth_px), half.y() / (0.5 * kHeight_px)) * kFocal_px;
}

/// The first picture costs more: the rays of the pixels around the robot are worked out for it.
void WarmUp(vision::SyntheticCamera& camera, const TwinSetup& setup) {
  std::mt19937_64 generator(setup.seed);
  vision::RobotMotion tag = TagOf({}, setup.simulation.mocap);
  tag.world_from_tag.translation().head<2>() += setup.start.Position();
  camera.Render(tag, vision::PixelFormat::kJpeg, generator);
}

}  // namespace

simulation::SimulationOptions WithRiftHost(simulation::SimulationOptions simulation,
                                           const TwinOptions& options) {
  simulation::MocapOptions& mocap = simulation.mocap;
  // What is told of a host with a period is the way to its driver alone.
  if (mocap.host_period_s) mocap.processing_s += options.host_share_s;
  mocap.host_period_s.reset();
  for (auto& [name, surface] : simulation.terrain.surfaces) surface.host_period_s.reset();
  mocap.ambiguity.share = 0.0;
  simulation.link.late_share = 0.0;
  return simulation;
}

simulation::LinkOptions WithFirmware(simulation::LinkOptions link) {
  link.poll_s = 0.0;
  link.uart_bytes = hardware::Listener::kReceiveBuffer;
  link.watchdog_s = 1e-3 * hardware::Listener::kWatchdog_ms;
  return link;
}

simulation::SimulationOptions AsTwin(simulation::SimulationOptions simulation,
                                     const TwinOptions& options) {
  simulation = WithRiftHost(std::move(simulation), options);
  simulation.link = WithFirmware(simulation.link);
  simulation.mocap.rate_hz = options.fps;
  simulation.mocap.frame_jitter_s = 0.0;
  // A log may be of the robot's point on the floor; a picture shows the tag where it is.
  if (simulation.mocap.tag_above_m == 0.0) {
    simulation.mocap.tag_above_m = options.camera.body_height_m - simulation.body.wheel_radius_m;
  }
  simulation.encoder.reported = true;
  return simulation;
}

vision::CameraModel OverheadCamera(const control::Task& task, const TwinOptions& options) {
  const Eigen::AlignedBox2d box = BoxOf(task);
  if (const double needed_m = NeededHeight_m(box); needed_m > options.camera_height_m) {
    throw std::invalid_argument(fmt::format(
        "twin.camera_height_m is {:g}, but to see the whole path and {:g} m around them "
        "the camera must hang at {:.2f} m",
        options.camera_height_m, kMargin_m, std::ceil(100.0 * needed_m) / 100.0));
  }
  vision::CameraModel camera;
  camera.name = "twin";
  camera.width_px = kWidth_px;
  camera.height_px = kHeight_px;
  camera.k << kFocal_px, 0.0, 958.0, 0.0, kFocal_px, 543.0, 0.0, 0.0, 1.0;
  camera.distortion = {0.06, -0.09, 0.001, -0.001, 0.02};
  vision::WorldFrame world;
  // The picture's y runs down, the world's up, and the camera looks along -z.
  world.world_from_camera.linear() = Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
  world.world_from_camera.translation() << box.center(), options.camera_height_m;
  world.origin = "as built";
  camera.world = world;
  return camera;
}

TwinRun RunTwin(const TwinSetup& setup, const std::function<void(const TwinAddress&)>& announce,
                const std::function<bool()>& is_stopped) {
  vision::SyntheticCamera pictures(setup.camera, setup.look);
  WarmUp(pictures, setup);
  TwinRobot robot(setup.simulation, setup.twin.battery_v, setup.start, setup.seed, setup.image);
  TruePath path(robot.Truth());
  TrialEnd end(setup.twin.still_s);
  PseudoTerminal line;
  MjpegServer server(setup.twin.http_port);
  TwinRun run{.began_s = vision::SteadyNow_s()};
  Pacer pacer(run.began_s);
  std::atomic<double> epoch_s = run.began_s;
  StreamCamera camera(setup, std::move(pictures), path, server, epoch_s);
  announce({line.path(), server.Url()});

  while (!is_stopped() && !end.IsOver(robot.Now_s())) {
    const double now_s = pacer.Simulated_s(vision::SteadyNow_s());
    epoch_s = pacer.ClockOf_s(0.0);
    if (robot.CanReceive()) robot.Receive(robot.Now_s(), line.Read());
    robot.Advance(now_s, [&](const simulation::TruePose& pose, const control::WheelPower& power) {
      path.Add(pose);
      end.Observe(pose.t_s, power);
    });
    line.Write(robot.Transmit(now_s));
    camera.RethrowFailure();
    std::this_thread::sleep_for(std::chrono::duration<double>(kPoll_s));
  }
  camera.Finish(run);
  run.is_over = end.IsOver(robot.Now_s());
  run.has_driven = end.HasDriven();
  run.truth = path.Path();
  run.skipped_s = pacer.Skipped_s();
  run.stops = robot.Listener().Stops();
  run.rejected = robot.Listener().Rejected();
  return run;
}

}  // namespace rift::twin
