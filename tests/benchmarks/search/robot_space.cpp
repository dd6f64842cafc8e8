#include "search/robot_space.hpp"

#include <array>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "rift/gap/comparison.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/yaml/bind.hpp"
#include "support/tree.hpp"

namespace rift::test {
namespace {

using search::AxisKind;

constexpr std::uint64_t kNoiseSeed = 1;
/// At the default 0.05 m, drives of more delay than the nominal one pass by a waypoint and circle:
/// a tenth of the space has no gap, and where it has one, it is the circle's size.
constexpr double kReachRadius_m = 0.1;
constexpr std::array kSurfaces{"ground", "cardboard", "parchment", "uphill", "downhill"};

std::string ReadText(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error(path + ": cannot be read");
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

experiment::Experiment Nominal() {
  experiment::Experiment experiment =
      experiment::LoadExperiment(SourceDir() + "/configs/waypoints/paper.yaml", {}, ReadText);
  yaml::Bind(yaml::Load(SourceDir() + "/configs/robots/3pi_2040.yaml", ReadText), experiment);
  experiment.trial.timeout_s = 6.0;
  experiment.control.reach_radius_m = kReachRadius_m;
  return experiment;
}

}  // namespace

RobotSpace::RobotSpace()
    : axes_{{"surface", AxisKind::kCategorical, 0, kSurfaces.size() - 1},
            {"pace", AxisKind::kCategorical, 0, 1},
            {"v_min", AxisKind::kContinuous, 0.10, 0.25},
            {"w_min", AxisKind::kContinuous, 0.01, 0.06},
            {"mismatch", AxisKind::kContinuous, -0.15, 0.15},
            {"delay_s", AxisKind::kContinuous, 0.0, 0.15}},
      nominal_(Nominal()),
      reference_(Drive(nominal_)) {}

trajectory::Trajectory RobotSpace::Drive(const experiment::Experiment& experiment) const {
  sweep::SimulatedRun run = sweep::Simulate({.task = experiment.waypoints,
                                             .control = experiment.control,
                                             .trial = experiment.trial,
                                             .simulation = experiment.simulation,
                                             .start = control::StartPose(experiment.waypoints),
                                             .seed = kNoiseSeed});
  if (run.result.outcome != trial::Outcome::kReached) return {};
  return std::move(run.result.trajectory);
}

double RobotSpace::Gap_m(const search::Point& point) const {
  experiment::Experiment experiment = nominal_;
  experiment.simulation.terrain.surface = kSurfaces[static_cast<std::size_t>(point[0])];
  experiment.trial.pace = static_cast<trial::Pace>(point[1]);
  experiment.control.v_min = point[2];
  experiment.control.w_min = point[3];
  experiment.simulation.motor.mismatch = point[4];
  experiment.simulation.link.delay_s = point[5];
  const trajectory::Trajectory path = Drive(experiment);
  if (path.poses.empty()) return std::numeric_limits<double>::quiet_NaN();
  return gap::Gap(path, reference_, {});
}

}  // namespace rift::test
