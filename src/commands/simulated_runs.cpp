#include "simulated_runs.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "files.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::commands {
namespace {

sweep::TrialStatus StatusOf(trial::Outcome outcome) {
  switch (outcome) {
    case trial::Outcome::kReached:
      return sweep::TrialStatus::kOk;
    case trial::Outcome::kTimedOut:
      return sweep::TrialStatus::kTimedOut;
    case trial::Outcome::kFell:
      return sweep::TrialStatus::kFell;
    case trial::Outcome::kLeftArena:
      return sweep::TrialStatus::kLeftArena;
    case trial::Outcome::kLost:
      return sweep::TrialStatus::kLost;
    case trial::Outcome::kFault:
      return sweep::TrialStatus::kFault;
  }
  return sweep::TrialStatus::kFault;
}

std::shared_ptr<const simulation::HeightImage> ImageOf(const simulation::TerrainOptions& terrain) {
  const simulation::SurfaceOptions& surface = terrain.Chosen();
  if (surface.shape != simulation::Shape::kHeightfield) return nullptr;
  try {
    return std::make_shared<const simulation::HeightImage>(
        simulation::DecodeHeightImage(ReadFile(surface.image)));
  } catch (const std::runtime_error& no_image) {
    throw std::invalid_argument(fmt::format("{}: {}", surface.image, no_image.what()));
  }
}

}  // namespace

sweep::SimulatedTrial TrialOf(const experiment::Experiment& experiment,
                              const geometry::Pose2& start, std::uint64_t seed,
                              const std::string& experiment_file) {
  try {
    control::CheckWaypoints(experiment.waypoints);
  } catch (const std::invalid_argument& no_task) {
    throw std::invalid_argument(fmt::format("{}: {}", experiment_file, no_task.what()));
  }
  return {.waypoints = experiment.waypoints,
          .control = experiment.control,
          .trial = experiment.trial,
          .simulation = experiment.simulation,
          .start = start,
          .seed = seed,
          .image = ImageOf(experiment.simulation.terrain)};
}

geometry::Pose2 StartFromLog(const trajectory::Trajectory& log, double tag_offset_m,
                             const simulation::MocapOptions& mocap) {
  const geometry::Pose2 world_from_point = trajectory::StandingPose(log);
  const geometry::Pose2 point_from_robot{-(tag_offset_m + mocap.tag_ahead_m), 0.0, 0.0};
  return world_from_point * point_from_robot;
}

sweep::Recording RecordingOf(sweep::SimulatedRun run, std::uint64_t seed) {
  sweep::Recording recording{.status = StatusOf(run.result.outcome),
                             .source = fmt::format("simulation with seed {}", seed),
                             .limits = run.result.limits};
  if (recording.status != sweep::TrialStatus::kOk) recording.reason = run.result.reason;
  recording.trajectory = std::move(run.result.trajectory);
  return recording;
}

}  // namespace rift::commands
