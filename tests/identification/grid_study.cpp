#include "identification/grid_study.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "rift/gap/comparison.hpp"
#include "rift/simulation/simulated_robot.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/node.hpp"
#include "support/tree.hpp"

namespace rift::test {
namespace {

constexpr double kMoved_m = 0.01;
constexpr double kMoving_mps = 0.1;
constexpr size_t kStride = 3;

double Median(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

double Mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? std::nan("") : sum / static_cast<double>(values.size());
}

size_t FirstMoving(const trajectory::Trajectory& log) {
  const Eigen::Vector2d start = log.poses[0].Position();
  size_t i = 0;
  while (i + 1 < log.poses.size() && (log.poses[i].Position() - start).norm() < kMoved_m) ++i;
  return i;
}

double Speed_mps(const trajectory::Trajectory& log) {
  std::vector<double> speeds;
  for (size_t i = 0; i + kStride < log.poses.size(); ++i) {
    const auto &from = log.poses[i], &to = log.poses[i + kStride];
    const double speed = (to.Position() - from.Position()).norm() / (to.t_s - from.t_s);
    if (speed > kMoving_mps) speeds.push_back(speed);
  }
  return Median(speeds);
}

double Weave_m(const std::vector<Eigen::Vector2d>& points) {
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  for (const Eigen::Vector2d& p : points) {
    sx += p.x(), sy += p.y(), sxx += p.x() * p.x(), sxy += p.x() * p.y(), syy += p.y() * p.y();
  }
  const double n = static_cast<double>(points.size());
  const double vx = sxx - sx * sx / n, vy = syy - sy * sy / n, cov = sxy - sx * sy / n;
  return std::sqrt(std::max(0.0, vy - cov * cov / vx) / n);
}

double YawScatter_rad(const trajectory::Trajectory& log) {
  std::vector<double> yaw;
  for (size_t i = FirstMoving(log); i < log.poses.size(); ++i) yaw.push_back(log.poses[i].yaw_rad);
  const double mean = Mean(yaw);
  for (double& value : yaw) value = (value - mean) * (value - mean);
  return std::sqrt(Mean(yaw));
}

template <class Value>
double MedianOf(const std::vector<PathTraits>& traits, Value value) {
  std::vector<double> values;
  for (const PathTraits& one : traits) values.push_back(value(one));
  return Median(values);
}

template <class Value>
double MeanOf(const std::vector<PathTraits>& traits, Value value) {
  std::vector<double> values;
  for (const PathTraits& one : traits) values.push_back(value(one));
  return Mean(values);
}

bool Missed(const trial::TrialResult& run) {
  return std::any_of(run.visits.begin(), run.visits.end(),
                     [](const trial::WaypointVisit& visit) { return !visit.reached_s; });
}

bool BothReached(const trial::TrialResult& a, const trial::TrialResult& b) {
  return a.outcome == trial::Outcome::kReached && b.outcome == trial::Outcome::kReached;
}

}  // namespace

GridStudy LoadGridStudy(const std::string& robot, const std::vector<std::string>& overrides) {
  yaml::Node tree = yaml::Load(SourceDir() + "/configs/waypoints/paper.yaml", ReadFile);
  if (!robot.empty()) yaml::Merge(tree, yaml::Load(robot, ReadFile));
  for (const std::string& set : overrides) yaml::Merge(tree, yaml::ParseOverride(set));
  GridStudy study;
  yaml::Bind(tree, study);
  return study;
}

PathTraits TraitsOf(const trajectory::Trajectory& log,
                    const std::vector<control::Waypoint>& waypoints,
                    const control::NavigatorOptions& control) {
  PathTraits traits;
  traits.speed_mps = Speed_mps(log);
  traits.weave_m = Weave_m(gap::ProfileAlong(log, log, {}).sim_m);
  traits.yaw_scatter_rad = YawScatter_rad(log);
  traits.length_m = sweep::LengthByStrides_m(log);
  traits.first_motion_s = log.poses[FirstMoving(log)].t_s - log.poses[0].t_s;
  traits.delay = trial::EstimateLoopDelay(log, waypoints, control);
  return traits;
}

double GapBetween(const trajectory::Trajectory& a, const trajectory::Trajectory& b) {
  gap::GapOptions options;
  options.skip_start = 0.1;
  return gap::Gap(a, b, options);
}

std::vector<GridPair> LoadGrid(const GridStudy& study) {
  std::vector<GridPair> pairs;
  for (const TrialPair& files : PublishedPairs()) {
    GridPair pair;
    pair.files = files;
    pair.control = study.control;
    pair.control.v_min = std::stod(files.v_min);
    pair.control.v_max = std::stod(files.v_max);
    pair.real = LoadTrajectory(files.real, trajectory::Format::kTracker);
    pair.real_traits = TraitsOf(pair.real, study.waypoints, pair.control);
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

void Simulate(const GridStudy& study, int seeds, std::vector<GridPair>& pairs) {
  std::uint64_t number = 0;
  for (GridPair& pair : pairs) {
    ++number;
    simulation::SimulationOptions options = study.simulation;
    options.terrain.surface = pair.files.surface;
    const geometry::Pose2 start = sweep::StartFromLog(pair.real, 0.0, options.mocap);
    for (int seed = 1; seed <= seeds; ++seed) {
      simulation::SimulatedRobot robot(options, start, 1000 * number + seed);
      pair.runs.push_back(trial::RunTrial(robot, study.waypoints, pair.control, study.trial));
      const trajectory::Trajectory& log = pair.runs.back().trajectory;
      pair.run_traits.push_back(TraitsOf(log, study.waypoints, pair.control));
      pair.gaps_m.push_back(GapBetween(log, pair.real));
    }
  }
}

GridSummary Summarise(const std::vector<GridPair>& pairs, const std::string& group) {
  GridSummary summary;
  std::vector<PathTraits> real, runs;
  std::vector<double> gaps_m, speed_ratios, real_spreads_m, spreads_m;
  std::map<std::string, std::vector<const GridPair*>> settings;
  double longest_m = 0.0;
  for (const GridPair& pair : pairs) longest_m = std::max(longest_m, pair.real_traits.length_m);
  for (const GridPair& pair : pairs) {
    if (!group.empty() && pair.files.surface != group && pair.files.v_min != group) continue;
    settings[pair.files.webots.string()].push_back(&pair);
    real.push_back(pair.real_traits);
    for (size_t i = 0; i < pair.runs.size(); ++i) {
      ++summary.runs;
      summary.missed += Missed(pair.runs[i]);
      summary.circled += pair.run_traits[i].length_m > 1.5 * longest_m;
      if (pair.runs[i].outcome != trial::Outcome::kReached) continue;
      ++summary.reached;
      gaps_m.push_back(pair.gaps_m[i]);
      runs.push_back(pair.run_traits[i]);
      speed_ratios.push_back(pair.run_traits[i].speed_mps / pair.real_traits.speed_mps);
    }
  }
  for (const auto& [name, repeats] : settings) {
    for (size_t a = 0; a < repeats.size(); ++a) {
      for (size_t b = a + 1; b < repeats.size(); ++b) {
        real_spreads_m.push_back(GapBetween(repeats[a]->real, repeats[b]->real));
        for (size_t i = 0; i < repeats[a]->runs.size(); ++i) {
          if (!BothReached(repeats[a]->runs[i], repeats[b]->runs[i])) continue;
          spreads_m.push_back(
              GapBetween(repeats[a]->runs[i].trajectory, repeats[b]->runs[i].trajectory));
        }
      }
    }
  }
  summary.gap_m = Mean(gaps_m);
  summary.speed_ratio = Median(speed_ratios);
  const auto delay = [](const PathTraits& t) { return t.delay.lag_s; };
  const auto gain = [](const PathTraits& t) { return t.delay.gain_rad_s; };
  const auto r2 = [](const PathTraits& t) { return t.delay.r2; };
  const auto weave = [](const PathTraits& t) { return t.weave_m; };
  const auto yaw = [](const PathTraits& t) { return t.yaw_scatter_rad; };
  const auto length = [](const PathTraits& t) { return t.length_m; };
  const auto first = [](const PathTraits& t) { return t.first_motion_s; };
  summary.real_delay_s = MedianOf(real, delay), summary.delay_s = MedianOf(runs, delay);
  summary.real_gain = MedianOf(real, gain), summary.gain = MedianOf(runs, gain);
  summary.real_r2 = MedianOf(real, r2), summary.r2 = MedianOf(runs, r2);
  summary.real_weave_m = MeanOf(real, weave), summary.weave_m = MeanOf(runs, weave);
  summary.real_yaw_rad = MeanOf(real, yaw), summary.yaw_rad = MeanOf(runs, yaw);
  summary.real_length_m = MeanOf(real, length), summary.length_m = MeanOf(runs, length);
  summary.real_first_motion_s = MedianOf(real, first),
  summary.first_motion_s = MedianOf(runs, first);
  summary.real_spread_m = Mean(real_spreads_m), summary.spread_m = Mean(spreads_m);
  return summary;
}

}  // namespace rift::test
