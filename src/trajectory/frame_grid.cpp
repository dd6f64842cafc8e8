#include "rift/trajectory/frame_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rift/statistics/descriptive.hpp"

namespace rift::trajectory {
namespace {

constexpr double kPeriodRange = 0.002;  // of the period, to either side
constexpr int kPhases = 16;
/// Periods, over the nominal one, of grids that must explain less.
constexpr std::array<double, 2> kOtherPeriods{0.9, 1.1};
constexpr double kLongest_s = 100.0;
/// Rows times grids that are tried of one rate, 2 s of a laptop: in 100 s a row for each frame of a
/// camera of 60 frames a second.
constexpr double kMostWork = 2e7;
constexpr size_t kFewestMoving = 12;
constexpr double kMoving = 0.5;  // of the median speed
/// Scatter of what finding the tag takes, as a share of the period; no more is known of it.
constexpr double kAgeScatter = 0.12;
/// Change of the speed from one row to the next, over the median speed, that is nothing special.
constexpr double kSpeedScatter = 0.1;
constexpr double kMostCost = 9.0;  // of one row: a stop or a jump of the tracker decides nothing
/// Frames that a row may be: the newest, the next (its stamp came early), the one before.
constexpr int kChoices = 3;

/// A row of the log on its own clock.
struct Rows {
  std::vector<double> t_s;
  std::vector<double> steps_m;  ///< to the next row
  double speed_mps = 0.0;       ///< median while it moves
};

std::vector<double> Speeds(const std::vector<double>& t_s, const std::vector<double>& steps_m) {
  std::vector<double> speeds;
  for (size_t i = 0; i < steps_m.size(); ++i) speeds.push_back(steps_m[i] / (t_s[i + 1] - t_s[i]));
  return speeds;
}

Rows RowsOf(const Trajectory& log) {
  Rows rows;
  for (size_t i = 0; i < log.poses.size(); ++i) {
    rows.t_s.push_back(log.poses[i].t_s - log.poses.front().t_s);
    if (i == 0) continue;
    rows.steps_m.push_back((log.poses[i].Position() - log.poses[i - 1].Position()).norm());
  }
  std::vector<double> speeds = Speeds(rows.t_s, rows.steps_m);
  // Half of the fastest tenth parts a robot at rest from one that moves.
  const double fast = statistics::Quantile(speeds, 0.9);
  std::erase_if(speeds, [&](double speed) { return speed < kMoving * fast; });
  rows.speed_mps = speeds.size() < kFewestMoving ? 0.0 : statistics::Median(std::move(speeds));
  return rows;
}

/// Rows at rest tell nothing: their speeds are noise of the tracker whatever the stamps.
double RoughnessOf(const std::vector<double>& t_s, const Rows& rows) {
  const std::vector<double> speeds = Speeds(t_s, rows.steps_m);
  const double limit = kMoving * rows.speed_mps;
  std::vector<double> bends;
  for (size_t i = 1; i + 1 < speeds.size(); ++i) {
    const double slowest =
        std::min({rows.steps_m[i - 1] + rows.steps_m[i], rows.steps_m[i] + rows.steps_m[i + 1]});
    const double span_s = rows.t_s[i + 2] - rows.t_s[i - 1];
    if (slowest / (2.0 / 3.0 * span_s) < limit) continue;
    bends.push_back(std::abs(speeds[i + 1] - 2.0 * speeds[i] + speeds[i - 1]));
  }
  return statistics::kSigmaOfMedianDeviation * statistics::Median(std::move(bends)) /
         rows.speed_mps;
}

double Squared(double value) { return value * value; }

/// Frames at even times: frame k is taken at phase + k * period, on the clock of the rows.
struct Grid {
  double period_s = 0.0;
  double phase_s = 0.0;

  /// In frames: 0 for a pose stamped as soon as its frame was there, 1 when the next one came.
  double AgeOf(double t_s, long frame) const {
    return (t_s - phase_s) / period_s - static_cast<double>(frame);
  }
  long NewestAt(double t_s) const {
    return static_cast<long>(std::floor((t_s - phase_s) / period_s));
  }
};

/// Which frame each row is, at least cost.
struct Assignment {
  Grid grid;
  double cost = std::numeric_limits<double>::infinity();
  std::vector<long> frames;  ///< rising; empty when there is no such sequence
};

/// Dynamic programming over the rows. The state is the choice at a row and at the one before, since
/// a change of speed takes three rows.
class Solver {
 public:
  Solver(const Rows& rows, const Grid& grid) : rows_(rows), grid_(grid) {}
  Assignment Solve();

 private:
  using Costs = std::array<std::array<double, kChoices>, kChoices>;
  using Origins = std::array<std::array<int, kChoices>, kChoices>;
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  long FrameOf(size_t row, int choice) const { return grid_.NewestAt(rows_.t_s[row]) + 1 - choice; }
  double AgeCost(size_t row, int choice) const {
    const double age = grid_.AgeOf(rows_.t_s[row], FrameOf(row, choice));
    const double beyond = age < 0.0 ? -age : std::max(0.0, age - 1.0);
    return std::min(kMostCost, Squared(beyond / kAgeScatter));
  }
  /// From a row to the next, over the median speed; below zero when the frames do not rise.
  double Speed(size_t row, int choice, int next) const {
    const long frames = FrameOf(row + 1, next) - FrameOf(row, choice);
    if (frames < 1) return -1.0;
    return rows_.steps_m[row] / (static_cast<double>(frames) * grid_.period_s * rows_.speed_mps);
  }
  Costs FirstCosts() const;
  Costs NextCosts(size_t row, const Costs& costs, Origins& origins) const;
  Assignment Traced(const Costs& costs, const std::vector<Origins>& origins) const;

  const Rows& rows_;
  Grid grid_;
};

Solver::Costs Solver::FirstCosts() const {
  Costs costs{};
  for (int a = 0; a < kChoices; ++a) {
    for (int b = 0; b < kChoices; ++b) {
      costs[a][b] = Speed(0, a, b) < 0.0 ? kNever : AgeCost(0, a) + AgeCost(1, b);
    }
  }
  return costs;
}

Solver::Costs Solver::NextCosts(size_t row, const Costs& costs, Origins& origins) const {
  Costs next{};
  for (int b = 0; b < kChoices; ++b) {
    for (int c = 0; c < kChoices; ++c) {
      next[b][c] = kNever;
      const double speed = Speed(row - 1, b, c);
      if (speed < 0.0) continue;
      for (int a = 0; a < kChoices; ++a) {
        if (costs[a][b] == kNever) continue;
        const double change = speed - Speed(row - 2, a, b);
        const double cost = costs[a][b] + std::min(kMostCost, Squared(change / kSpeedScatter));
        if (cost < next[b][c]) next[b][c] = cost, origins[b][c] = a;
      }
      next[b][c] += AgeCost(row, c);
    }
  }
  return next;
}

Assignment Solver::Traced(const Costs& costs, const std::vector<Origins>& origins) const {
  Assignment found{.grid = grid_};
  int b = 0, c = 0;
  for (int i = 0; i < kChoices; ++i) {
    for (int j = 0; j < kChoices; ++j) {
      if (costs[i][j] < found.cost) found.cost = costs[i][j], b = i, c = j;
    }
  }
  if (found.cost == kNever) return found;
  found.frames.resize(origins.size());
  for (size_t row = origins.size() - 1; row >= 2; --row) {
    found.frames[row] = FrameOf(row, c);
    const int a = origins[row][b][c];
    c = b, b = a;
  }
  found.frames[1] = FrameOf(1, c);
  found.frames[0] = FrameOf(0, b);
  return found;
}

Assignment Solver::Solve() {
  std::vector<Origins> origins(rows_.t_s.size());
  Costs costs = FirstCosts();
  for (size_t row = 2; row < origins.size(); ++row) costs = NextCosts(row, costs, origins[row]);
  return Traced(costs, origins);
}

/// So many periods, in a range of them, that the last row moves by an eighth of a frame from one to
/// the next.
int PeriodsFor(const Rows& rows, double nominal_s) {
  const double range_s = 2.0 * kPeriodRange * rows.t_s.back();
  return 3 + 2 * static_cast<int>(std::ceil(range_s / (nominal_s / 4.0)));
}

/// Over these periods and all phases.
Assignment BestOf(const Rows& rows, double nominal_s) {
  const int periods = PeriodsFor(rows, nominal_s);
  Assignment best;
  for (int i = 0; i < periods; ++i) {
    const double share = 2.0 * i / (periods - 1.0) - 1.0;
    const double period_s = nominal_s * (1.0 + kPeriodRange * share);
    for (int k = 0; k < kPhases; ++k) {
      Assignment tried =
          Solver(rows, {.period_s = period_s, .phase_s = period_s * k / kPhases}).Solve();
      if (tried.cost < best.cost) best = std::move(tried);
    }
  }
  return best;
}

/// The mean of the stamps stays.
std::vector<double> StampsOf(const Assignment& assigned, const Rows& rows) {
  std::vector<double> stamps_s;
  double shift_s = 0.0;
  for (size_t i = 0; i < rows.t_s.size(); ++i) {
    stamps_s.push_back(static_cast<double>(assigned.frames[i]) * assigned.grid.period_s);
    shift_s += (rows.t_s[i] - stamps_s.back()) / static_cast<double>(rows.t_s.size());
  }
  for (double& stamp_s : stamps_s) stamp_s += shift_s;
  return stamps_s;
}

double OutsideShareOf(const Assignment& assigned, const Rows& rows) {
  double outside = 0.0;
  for (size_t i = 0; i < rows.t_s.size(); ++i) {
    const double age = assigned.grid.AgeOf(rows.t_s[i], assigned.frames[i]);
    outside += age < 0.0 || age > 1.0 ? 1.0 : 0.0;
  }
  return outside / static_cast<double>(rows.t_s.size());
}

}  // namespace

std::string FrameGrid::Text() const {
  if (is_found) {
    return fmt::format(
        "stamps put back on frames {:.2f} ms apart: speeds from row to row are {:.1f} times "
        "smoother",
        1e3 * period_s, Smoother());
  }
  if (std::isnan(roughness_after)) {
    return fmt::format(
        "no frame grid is looked for in fewer than {} rows in motion, in more than {:g} s, or in "
        "so many rows and frames that it takes minutes: the stamps stay",
        kFewestMoving, kLongest_s);
  }
  if (!is_best) {
    return "no frame grid of this rate: one of a rate 10 % off explains the log better: the stamps "
           "stay";
  }
  return fmt::format(
      "no frame grid: with one speeds would be {:.2f} times smoother, and {:g} is asked for: the "
      "stamps stay",
      Smoother(), kLeastSmoother);
}

Trajectory OnFramesOf(Trajectory log, double fps) {
  return fps == 0.0 ? log : PutOnFrames(std::move(log), fps).trajectory;
}

OnFrames PutOnFrames(Trajectory log, double fps) {
  if (!(fps >= 1.0 && fps <= 1000.0)) {
    throw std::invalid_argument(
        fmt::format("a frame grid of {:g} frames a second: must be within [1, 1000]", fps));
  }
  OnFrames result{.trajectory = std::move(log)};
  if (result.trajectory.poses.size() < kFewestMoving) return result;
  const Rows rows = RowsOf(result.trajectory);
  if (!(rows.speed_mps > 0.0) || rows.t_s.back() > kLongest_s) return result;
  const double grids = 1.0 * kPhases * PeriodsFor(rows, 1.0 / fps);
  if (static_cast<double>(rows.t_s.size()) * grids > kMostWork) return result;
  FrameGrid& grid = result.grid;
  grid.roughness_before = RoughnessOf(rows.t_s, rows);
  const Assignment best = BestOf(rows, 1.0 / fps);
  if (best.frames.empty()) return result;
  const std::vector<double> stamps_s = StampsOf(best, rows);
  grid.period_s = best.grid.period_s;
  grid.roughness_after = RoughnessOf(stamps_s, rows);
  grid.outside_share = OutsideShareOf(best, rows);
  grid.is_best = std::all_of(kOtherPeriods.begin(), kOtherPeriods.end(), [&](double other) {
    return BestOf(rows, other / fps).cost > best.cost;
  });
  grid.is_found = grid.is_best && grid.Smoother() >= kLeastSmoother;
  if (!grid.is_found) return result;
  const double zero_s = result.trajectory.poses.front().t_s;
  for (size_t i = 0; i < stamps_s.size(); ++i) {
    StampedPose& pose = result.trajectory.poses[i];
    pose.stamp_s = pose.t_s;
    pose.t_s = zero_s + stamps_s[i];
  }
  return result;
}

}  // namespace rift::trajectory
