#include "feature_model.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/drive_features.hpp"
#include "rift/sweep/calibrate/repeated_trial.hpp"
#include "rift/sweep/run/for_each.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "rift/trial/loop_delay.hpp"

namespace rift::sweep {
namespace {

using trajectory::StampedPose;
using trajectory::Trajectory;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t kFeatureStream = 110;
constexpr std::uint64_t kMostDraws = 1'000'000;

void AppendSteering(const Trajectory& path, const SimulatedTrial& twin, std::vector<double>& row) {
  trial::LoopDelay delay;
  try {
    delay = trial::EstimateLoopDelay(path, twin.task.waypoints, twin.control);
  } catch (const std::invalid_argument&) {
    // It hardly drove.
  }
  const bool is_told = delay.lag_s >= 0.0;
  for (const double value : {delay.lag_s, delay.gain_rad_s, delay.bias_rad_s}) {
    row.push_back(is_told ? value : kNone);
  }
}

bool DrivesTo(const StampedPose& pose, const Eigen::Vector2d& place) {
  return (Eigen::Vector2d(pose.target_x_m, pose.target_y_m) - place).norm() < 1e-6;
}

/// Left of the line from waypoint to waypoint, of the last row that drove to each. A place may be
/// driven to more than once.
void AppendSides(const Trajectory& path, const SimulatedTrial& twin, std::vector<double>& row) {
  const std::vector<control::Waypoint>& waypoints = twin.task.waypoints;
  auto pose = path.poses.begin();
  for (size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector2d from = waypoints[i - 1].Position(), to = waypoints[i].Position();
    const auto drives_to = [&to](const StampedPose& one) { return DrivesTo(one, to); };
    const auto first = std::find_if(pose, path.poses.end(), drives_to);
    const auto last = std::find_if_not(first, path.poses.end(), drives_to);
    if (first == last) {
      row.push_back(kNone);
      continue;
    }
    const Eigen::Vector2d ahead = (to - from).normalized();
    const Eigen::Vector2d off = std::prev(last)->Position() - to;
    row.push_back(ahead.x() * off.y() - ahead.y() * off.x());
    pose = last;
  }
}

}  // namespace

Eigen::VectorXd FeatureRow(const Trajectory& path, const SimulatedTrial& twin) {
  const std::vector<double> all = FeaturesOf(path, {});
  std::vector<double> row;
  for (size_t i = 0; i < all.size(); ++i) {
    if (!DriveFeatures()[i].is_timing) row.push_back(all[i]);
  }
  AppendSteering(path, twin, row);
  AppendSides(path, twin, row);
  return Eigen::Map<const Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size()));
}

std::vector<FeatureRows> DriveAt(const std::vector<std::vector<double>>& values,
                                 const std::vector<CalibrationLog>& logs, const TwinAt& twin,
                                 std::uint64_t round, int alike, int threads) {
  std::vector<FeatureRows> driven(values.size());
  const auto drive = [&](size_t draw) {
    FeatureRows& at = driven[draw];
    at.has_failed = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(logs.size()));
    for (size_t i = 0; i < logs.size(); ++i) {
      SimulatedTrial trial = twin(i, values[draw]);
      trial.seed = statistics::SeedOfStream(statistics::SeedOfStream(trial.seed, kFeatureStream),
                                            round * kMostDraws + draw / static_cast<size_t>(alike));
      const SimulatedRun run = Simulate(trial);
      Eigen::VectorXd row =
          FeatureRow(trajectory::OnFramesOf(run.result.trajectory, logs[i].drives_grid_fps), trial);
      const auto log = static_cast<Eigen::Index>(i);
      if (i == 0) at.rows.resize(static_cast<Eigen::Index>(logs.size()), row.size());
      if (run.result.outcome != trial::Outcome::kReached ||
          LengthByStrides_m(run.result.trajectory) > logs[i].longest_m) {
        row.setConstant(kNone);
        at.has_failed[log] = 1.0;
      }
      at.rows.row(log) = row;
    }
  };
  ForEach(values.size(), threads, drive);
  return driven;
}

}  // namespace rift::sweep
