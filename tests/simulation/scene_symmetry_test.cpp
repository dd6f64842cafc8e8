// The whole robot under the whole controller, noise off: where the scene stands and which way it
// looks must not matter.

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "rift/simulation/simulated_robot.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/trial/trial.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::simulation {
namespace {

/// A robot with everything that can break a symmetry, and nothing random.
SimulationOptions Robot(const std::string& surface) {
  SimulationOptions options;
  options.body.caster_mu = 0.1;
  options.motor.friction_torque_nm = 0.0019;
  options.motor.breakaway_torque_nm = 0.0035;
  options.motor.supply_ratio = 1.36;
  options.link.poll_phase = 0.3;
  options.link.two_decimals = false;  // else a last digit decides whether a power is rounded up
  options.link.baud = 0.0;            // such lines are long
  options.link.uart_bytes = 0;
  options.mocap = {.frame_jitter_s = 0.0,
                   .noise_across_m = 0.0,
                   .blur_across_s = 0.0,
                   .noise_along_m = 0.0,
                   .stamp_jitter_s = 0.0,
                   .noise_yaw_rad = 0.0,
                   .blur_yaw_rad_per_mps = 0.0,
                   .noise_z_m = 0.0,
                   .noise_tilt_rad = 0.0};
  options.terrain.surface = surface;
  return options;
}

struct Run {
  std::vector<geometry::Pose2> path;
  trial::Outcome outcome;
};

class Follower : public SimulatedRobot {
 public:
  using SimulatedRobot::SimulatedRobot;
  void Advance(double dt_s) override {
    SimulatedRobot::Advance(dt_s);
    path.push_back(Truth().Planar());
  }
  std::vector<geometry::Pose2> path;
};

Run Drive(const SimulationOptions& options, const geometry::Pose2& start,
          const std::vector<control::Waypoint>& waypoints) {
  Follower robot(options, start, 7);
  trial::TrialOptions trial;
  trial.pace = trial::Pace::kNewPose;
  const trial::TrialResult result = trial::RunTrial(robot, waypoints, {}, trial);
  return {robot.path, result.outcome};
}

geometry::Pose2 PaperStart() { return {-0.2822, -0.0655, -0.0157}; }

double Farthest_m(const std::vector<geometry::Pose2>& a, const std::vector<geometry::Pose2>& b,
                  const std::function<geometry::Pose2(const geometry::Pose2&)>& a_from_b) {
  REQUIRE(a.size() == b.size());
  double farthest_m = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    farthest_m = std::max(farthest_m, (a[i].Position() - a_from_b(b[i]).Position()).norm());
  }
  return farthest_m;
}

std::vector<control::Waypoint> Moved(std::vector<control::Waypoint> waypoints,
                                     const geometry::Pose2& moved_from_here) {
  for (control::Waypoint& waypoint : waypoints) {
    const geometry::Pose2 at = moved_from_here * geometry::Pose2{waypoint.x_m, waypoint.y_m, 0.0};
    waypoint.x_m = at.x_m;
    waypoint.y_m = at.y_m;
  }
  return waypoints;
}

TEST_CASE("Turning and moving the whole scene turns and moves the run") {
  const std::string surface = GENERATE("ground", "cardboard", "parchment");
  const double turn_rad = GENERATE(0.0, 0.6457718, 1.5707963, -2.2);
  const geometry::Pose2 there_from_here{0.31, -1.7, turn_rad};
  const Run here = Drive(Robot(surface), PaperStart(), test::PaperWaypoints());
  const Run there = Drive(Robot(surface), there_from_here * PaperStart(),
                          Moved(test::PaperWaypoints(), there_from_here));
  CHECK(here.outcome == trial::Outcome::kReached);
  const double off_m = Farthest_m(
      there.path, here.path, [&](const geometry::Pose2& pose) { return there_from_here * pose; });
  CAPTURE(surface, turn_rad);
  CHECK(off_m < 1e-9);
}

TEST_CASE("Turning the board with the rest of the scene turns the run") {
  const std::string surface = GENERATE("downhill", "uphill");
  const double turn_rad = GENERATE(0.25, -1.2);
  SimulationOptions options = Robot(surface);
  SurfaceOptions& board = options.terrain.surfaces[surface];
  board.ramp_bend_m = GENERATE(0.0, 0.3);
  board.ramp_plateau_rad = 0.1;
  const Run here = Drive(options, PaperStart(), test::PaperWaypoints());
  board.ramp_turn_rad = turn_rad;
  const double edge_m = board.ramp_edge_x_m;
  const geometry::Pose2 there_from_here{edge_m - edge_m * std::cos(turn_rad),
                                        -edge_m * std::sin(turn_rad), turn_rad};
  const Run there = Drive(options, there_from_here * PaperStart(),
                          Moved(test::PaperWaypoints(), there_from_here));
  CAPTURE(surface, turn_rad, board.ramp_bend_m);
  CHECK(Farthest_m(there.path, here.path,
                   [&](const geometry::Pose2& pose) { return there_from_here * pose; }) < 1e-9);
}

TEST_CASE("The mirror image of the scene gives the mirror image of the run") {
  const std::string surface = GENERATE("ground", "parchment", "downhill", "uphill", "bump");
  SimulationOptions options = Robot(surface), mirrored = options;
  options.motor.mismatch = 0.03;
  mirrored.motor.mismatch = -0.03;
  std::vector<control::Waypoint> waypoints = test::PaperWaypoints();
  const Run run = Drive(options, PaperStart(), waypoints);
  for (control::Waypoint& waypoint : waypoints) waypoint.y_m = -waypoint.y_m;
  const Run image =
      Drive(mirrored, {PaperStart().x_m, -PaperStart().y_m, -PaperStart().yaw_rad}, waypoints);
  CAPTURE(surface);
  CHECK(Farthest_m(run.path, image.path, [](const geometry::Pose2& pose) {
          return geometry::Pose2{pose.x_m, -pose.y_m, -pose.yaw_rad};
        }) < 1e-9);
}

/// The farthest that two runs at a step and at half of it part, in m.
double PartedBy_m(SimulationOptions options, const geometry::Pose2& start) {
  const Run coarse = Drive(options, start, test::PaperWaypoints());
  options.step_s *= 0.5;
  const Run fine = Drive(options, start, test::PaperWaypoints());
  double parted_m = 0.0;
  for (size_t i = 0; i < std::min(coarse.path.size(), fine.path.size()); ++i) {
    const double apart_m = (coarse.path[i].Position() - fine.path[i].Position()).norm();
    parted_m = std::max(parted_m, apart_m);
  }
  return parted_m;
}

TEST_CASE("Halving the step hardly changes a run where the ground is smooth") {
  const std::string surface = GENERATE("ground", "cardboard", "parchment", "downhill");
  SimulationOptions options = Robot(surface);
  options.body.caster_ahead_m = 0.0404;
  options.body.com_ahead_m = 0.008;
  options.body.caster_mu = 0.05;
  options.motor.lag_s = 0.02;
  options.motor.friction_fall_rad_s = GENERATE(0.0, 2.5);
  if (GENERATE(false, true)) {
    SurfaceOptions& board = options.terrain.surfaces["downhill"];
    board.ramp_plateau_rad = 0.1;
    board.ramp_bend_m = 0.3;
    board.ramp_turn_rad = 0.2;
  }
  std::vector<double> parted_m;
  for (int run = 0; run < 15; ++run) {
    options.link.poll_phase = 0.2 * (run % 5);
    const geometry::Pose2 start{PaperStart().x_m + 0.001 * run,
                                PaperStart().y_m + 0.002 * (run % 7), PaperStart().yaw_rad};
    parted_m.push_back(PartedBy_m(options, start));
  }
  // A few part further at any step: the controller steers to the side of a sign.
  CAPTURE(surface, options.motor.friction_fall_rad_s, parted_m);
  CHECK(statistics::Median(parted_m) < 0.001);
}

}  // namespace
}  // namespace rift::simulation
