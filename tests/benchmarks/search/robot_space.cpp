#include "search/robot_space.hpp"

#include <array>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "rift/config/bind.hpp"
#include "rift/gap/comparison.hpp"
#include "rift/sweep/simulated_trial.hpp"

namespace rift::test {
namespace {

using search::AxisKind;

constexpr std::uint64_t kNoiseSeed = 1;
constexpr std::array kSurfaces{"ground", "cardboard", "parchment", "uphill", "downhill"};

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

config::Experiment Nominal() {
  config::Experiment experiment =
      config::LoadExperiment(RIFT_SOURCE_DIR "/configs/waypoints/paper.yaml", {}, ReadText);
  config::Bind(config::Load(RIFT_SOURCE_DIR "/configs/robots/3pi_2040.yaml", ReadText), experiment);
  experiment.trial.timeout_s = 6.0;
  return experiment;
}

}  // namespace

RobotSpace::RobotSpace()
    : axes_{{"surface", AxisKind::kCategorical, 0, kSurfaces.size() - 1},
            {"pace", AxisKind::kCategorical, 0, 1},
            {"w_min", AxisKind::kContinuous, 0.010, 0.040},
            {"start_yaw_rad", AxisKind::kContinuous, -0.2, 0.2},
            {"mismatch", AxisKind::kContinuous, -0.06, 0.06},
            {"delay_s", AxisKind::kContinuous, 0.0, 0.10}},
      nominal_(Nominal()),
      reference_(Drive(nominal_, control::StartPose(nominal_.waypoints))) {}

trajectory::Trajectory RobotSpace::Drive(const config::Experiment& experiment,
                                         const geometry::Pose2& start) const {
  sweep::SimulatedRun run = sweep::Simulate({.waypoints = experiment.waypoints,
                                             .control = experiment.control,
                                             .trial = experiment.trial,
                                             .simulation = experiment.simulation,
                                             .start = start,
                                             .seed = kNoiseSeed});
  if (run.result.outcome != trial::Outcome::kReached) return {};
  return std::move(run.result.trajectory);
}

double RobotSpace::Gap_m(const search::Point& point) const {
  config::Experiment experiment = nominal_;
  experiment.simulation.terrain.surface = kSurfaces[static_cast<std::size_t>(point[0])];
  experiment.trial.pace = static_cast<trial::Pace>(point[1]);
  const geometry::Pose2 displaced{0.0, 0.0, point[3]};
  experiment.control.w_min = point[2];
  experiment.simulation.motor.mismatch = point[4];
  experiment.simulation.link.delay_s = point[5];
  const trajectory::Trajectory path =
      Drive(experiment, control::StartPose(experiment.waypoints) * displaced);
  if (path.poses.empty()) return std::numeric_limits<double>::quiet_NaN();
  return gap::Gap(path, reference_, {});
}

}  // namespace rift::test
