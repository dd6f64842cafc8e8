#include "rift/twin/twin.hpp"

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "mjpeg_server.hpp"
#include "pacing.hpp"
#include "pseudo_terminal.hpp"
#include "rift/vision/camera/camera_source.hpp"
#include "stream_camera.hpp"

namespace rift::twin {
namespace {

constexpr double kNap_s = 0.001;

/// The first pictures cost more: the floor is compressed with each of its noises.
void WarmUp(vision::SyntheticCamera& camera, const TwinSetup& setup) {
  constexpr int kPictures = 10;
  std::mt19937_64 generator(setup.seed);
  vision::RobotMotion tag = TagOf({}, setup.simulation.mocap);
  tag.world_from_tag.translation().head<2>() += setup.start.Position();
  for (int i = 0; i < kPictures; ++i) {
    camera.Render(tag, vision::PixelFormat::kJpeg, generator);
  }
}

}  // namespace

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
    robot.Hear(robot.Now_s(), line.Read());
    robot.Advance(now_s, [&](const simulation::TruePose& pose, const control::WheelPower& power) {
      path.Add(pose);
      end.See(pose.t_s, power);
    });
    line.Write(robot.Say(now_s));
    camera.RethrowFailure();
    std::this_thread::sleep_for(std::chrono::duration<double>(kNap_s));
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
