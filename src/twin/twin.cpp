#include "rift/twin/twin.hpp"

#include <atomic>
#include <chrono>
#include <random>
#include <thread>

#include "mjpeg_server.hpp"
#include "pacing.hpp"
#include "pseudo_terminal.hpp"
#include "stream_camera.hpp"

namespace rift::twin {
namespace {

constexpr double kNap_s = 0.001;

double SteadyNow_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The first picture costs more: the rays of the pixels around the robot are worked out for it.
void WarmUp(vision::PictureMaker& pictures, const TwinSetup& setup) {
  std::mt19937_64 generator(setup.seed);
  vision::RobotMotion tag = TagOf({}, setup.simulation.mocap);
  tag.world_from_tag.translation().head<2>() += setup.start.Position();
  pictures.Jpeg(tag, generator);
}

}  // namespace

TwinRun RunTwin(const TwinSetup& setup, std::unique_ptr<vision::PictureMaker> pictures,
                const std::function<void(const TwinAddress&)>& announce,
                const std::function<bool()>& is_stopped) {
  WarmUp(*pictures, setup);
  TwinRobot robot(setup.simulation, setup.twin.battery_v, setup.start, setup.seed, setup.image);
  TruePath path(robot.Truth());
  TrialEnd end(setup.twin.still_s);
  PseudoTerminal line;
  MjpegServer server(setup.twin.http_port);
  TwinRun run{.began_s = SteadyNow_s()};
  Pacer pacer(run.began_s);
  std::atomic<double> epoch_s = run.began_s;
  StreamCamera camera(setup, std::move(pictures), path, server, epoch_s);
  announce({line.path(), server.Url()});

  while (!is_stopped() && !end.IsOver(robot.Now_s())) {
    const double now_s = pacer.Simulated_s(SteadyNow_s());
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
