#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fitted_simulator.hpp"
#include "model.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/sweep/run/for_each.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

Traits TraitsOfPath(const Trajectory& path, const SimulatedTrial& twin) {
  try {
    const gap::PathTraits shape = gap::TraitsOf(path, {});
    const trial::LoopDelay delay =
        trial::EstimateLoopDelay(path, twin.task.waypoints, twin.control);
    const Eigen::Vector4d traits(std::log(shape.weave_m), std::log(shape.speed_mps), delay.lag_s,
                                 delay.gain_rad_s);
    if (delay.lag_s >= 0.0 && traits.allFinite()) return traits;
  } catch (const std::invalid_argument&) {
    // It did not drive, or hardly: it has no traits, and the motions still count.
  }
  return {};
}

/// Whole runs of one log that reached the end.
std::vector<Trajectory> RunsOf(SimulatedTrial twin, int runs, double grid_fps) {
  std::vector<Trajectory> paths;
  for (int i = 0; i < runs; ++i, ++twin.seed) {
    SimulatedRun run = Simulate(twin);
    if (run.result.outcome == trial::Outcome::kReached) {
      paths.push_back(trajectory::OnFramesOf(std::move(run.result.trajectory), grid_fps));
    }
  }
  return paths;
}

LogPrediction PredictionOf(const CalibrationLog& log, const SimulatedTrial& twin,
                           const CalibrationOptions& options) {
  LogPrediction prediction;
  const std::vector<HorizonError> motions =
      ShortHorizonErrors(twin, log.log, options.horizon, log.began_s);
  prediction.motions.resize(3 * static_cast<Eigen::Index>(motions.size()));
  for (size_t i = 0; i < motions.size(); ++i) {
    prediction.motions.segment<3>(3 * static_cast<Eigen::Index>(i)) =
        Eigen::Vector3d(motions[i].ahead_m, motions[i].left_m, motions[i].turned_rad);
    prediction.frames.push_back(motions[i].frames);
  }
  prediction.runs = RunsOf(twin, options.runs, log.drives_grid_fps);
  std::vector<Traits> traits;
  for (const Trajectory& run : prediction.runs) traits.push_back(TraitsOfPath(run, twin));
  prediction.mean_traits = MeanTraits(traits);
  return prediction;
}

}  // namespace

/// Which thread predicts a log changes nothing.
std::vector<LogPrediction> SimulatedTwins::Predict(const std::vector<CalibrationLog>& logs,
                                                   const std::vector<double>& values,
                                                   const CalibrationOptions& options) {
  std::vector<LogPrediction> predictions(logs.size());
  ForEach(logs.size(), threads_,
          [&](size_t i) { predictions[i] = PredictionOf(logs[i], twin_(i, values), options); });
  return predictions;
}

std::vector<Trajectory> SimulatedTwins::LogsAt(const std::vector<CalibrationLog>& logs,
                                               const std::vector<double>& values, int repeat) {
  std::vector<Trajectory> runs;
  for (size_t i = 0; i < logs.size(); ++i) {
    runs.push_back(trajectory::OnFramesOf(RunWithin(logs[i].longest_m, twin_(i, values), repeat),
                                          logs[i].drives_grid_fps));
  }
  return runs;
}

Traits SimulatedTwins::TraitsOf(const Trajectory& path, size_t log,
                                const std::vector<double>& values) const {
  return TraitsOfPath(path, twin_(log, values));
}

}  // namespace rift::sweep
