#include "rift/sweep/explain/failing_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>

#include "rift/statistics/sample.hpp"

namespace rift::sweep {
namespace {

constexpr int kPatches = 24;          ///< of a range
constexpr size_t kMostTrials = 4000;  ///< that are looked at
constexpr size_t kMostNearest = 12;
constexpr double kSamePlace = 1e-9;  ///< of the side of the plane

/// An axis as places 0..1, with the names of its patches.
class Side {
 public:
  explicit Side(const experiment::Parameter& parameter) : parameter_(parameter) {}

  int Patches() const {
    return parameter_.IsContinuous() ? kPatches : static_cast<int>(parameter_.levels.size());
  }
  double Low(int patch) const { return At(patch); }
  double High(int patch) const { return At(patch + 1); }
  std::string Name(int patch) const {
    if (!parameter_.IsContinuous()) return parameter_.levels[patch].text;
    return fmt::format("{0:.{2}g} to {1:.{2}g}", Low(patch), High(patch), Digits());
  }
  double Middle(int patch) const { return (patch + 0.5) / Patches(); }
  /// Whether a trial there may count for a patch: levels of a list are no distance apart.
  bool Reaches(double place, double middle) const {
    return parameter_.IsContinuous() || std::abs(place - middle) < kSamePlace;
  }
  double Place(const experiment::ParameterValue& value) const {
    if (parameter_.is_logarithmic) {
      return std::log(*value.number / parameter_.min) / std::log(parameter_.max / parameter_.min);
    }
    if (parameter_.IsContinuous()) {
      return (*value.number - parameter_.min) / (parameter_.max - parameter_.min);
    }
    const auto found = std::find(parameter_.levels.begin(), parameter_.levels.end(), value);
    return (static_cast<double>(found - parameter_.levels.begin()) + 0.5) / Patches();
  }

 private:
  double At(int edge) const {
    if (!parameter_.IsContinuous()) return edge;
    if (parameter_.is_logarithmic) {
      return parameter_.min *
             std::pow(parameter_.max / parameter_.min, static_cast<double>(edge) / Patches());
    }
    return parameter_.min + (parameter_.max - parameter_.min) * edge / Patches();
  }
  /// Significant ones that tell the edges apart.
  int Digits() const {
    const bool is_logarithmic = parameter_.is_logarithmic;
    const double width =
        is_logarithmic ? At(1) - parameter_.min : (parameter_.max - parameter_.min) / Patches();
    const double largest = is_logarithmic
                               ? parameter_.min
                               : std::max(std::abs(parameter_.min), std::abs(parameter_.max));
    return std::max(3, 1 + static_cast<int>(std::ceil(std::log10(largest / width))));
  }
  const experiment::Parameter& parameter_;
};

/// The trials of a setting.
struct Dot {
  double x, y;
  int trials = 0, failing = 0;
};

/// So many that a patch is no mean of all there are: a third of those of each value of a list.
int CountNearest(size_t settings, int values) {
  const size_t third = settings / (3 * static_cast<size_t>(values));
  return static_cast<int>(std::clamp<size_t>(third, 1, kMostNearest));
}

/// Leaves so many nearest to the place, and all that are as near as the last of them.
void LeaveNearest(double x, double y, int nearest, std::vector<Dot>& dots) {
  if (dots.size() <= static_cast<size_t>(nearest)) return;
  const auto distance = [x, y](const Dot& dot) { return std::hypot(dot.x - x, dot.y - y); };
  const auto nearest_end = dots.begin() + nearest;
  std::partial_sort(dots.begin(), nearest_end, dots.end(),
                    [&](const Dot& a, const Dot& b) { return distance(a) < distance(b); });
  const double reach = distance(dots[nearest - 1]) + kSamePlace;
  std::erase_if(dots, [&](const Dot& dot) { return distance(dot) > reach; });
}

void Count(const std::vector<Dot>& dots, bool by_setting, RegionCell& cell) {
  double failing = 0.0, shares = 0.0;
  for (const Dot& dot : dots) {
    cell.trials += dot.trials;
    failing += dot.failing;
    shares += static_cast<double>(dot.failing) / dot.trials;
  }
  if (dots.empty()) return;
  cell.share = by_setting ? shares / static_cast<double>(dots.size()) : failing / cell.trials;
}

/// One for each setting: a search repeats a setting until it is decided, and those on the border
/// most.
std::vector<Dot> DotsOf(const SweepResult& result, const Side& x, int xp, const Side& y, int yp) {
  std::map<experiment::Theta, Dot> by_setting;
  for (const size_t i : statistics::SampleInOrder(result.rows.size(), kMostTrials)) {
    const TrialRow& row = result.rows[i];
    if (!row.Tells()) continue;
    const auto [found, is_new] = by_setting.try_emplace(row.theta);
    Dot& dot = found->second;
    if (is_new) dot = {x.Place(row.theta[xp]), y.Place(row.theta[yp])};
    ++dot.trials;
    dot.failing += row.falsified;
  }
  std::vector<Dot> dots;
  for (const auto& [theta, dot] : by_setting) dots.push_back(dot);
  return dots;
}

}  // namespace

std::array<int, 2> MostInfluential(const SweepResult& result, const Effects& effects) {
  std::vector<double> weight(result.parameters.size(), -1.0);
  for (size_t i = 0; i < weight.size(); ++i) {
    const bool varies =
        result.parameters[i].IsContinuous() || result.parameters[i].levels.size() > 1;
    if (varies) weight[i] = 0.0;
  }
  for (const ParameterEffect& effect : effects.parameters) {
    if (std::isfinite(effect.share)) weight[effect.parameter] = effect.share;
  }
  std::vector<int> order(weight.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return weight[a] > weight[b]; });
  if (order.size() < 2 || weight[order[1]] < 0.0) return {-1, -1};
  return {order[0], order[1]};
}

FailingRegion MapFailures(const SweepResult& result, std::array<int, 2> parameters) {
  FailingRegion region;
  if (parameters[0] < 0 || parameters[1] < 0) return region;
  region.x_parameter = parameters[0];
  region.y_parameter = parameters[1];
  const experiment::Parameter& px = result.parameters[parameters[0]];
  const experiment::Parameter& py = result.parameters[parameters[1]];
  const Side x(px), y(py);
  if (static_cast<size_t>(x.Patches()) * static_cast<size_t>(y.Patches()) > kMostRegionCells) {
    return region;
  }
  region.is_smoothed = px.IsContinuous() || py.IsContinuous();
  const std::vector<Dot> dots = DotsOf(result, x, parameters[0], y, parameters[1]);
  if (region.is_smoothed) {
    const int values =
        (px.IsContinuous() ? 1 : x.Patches()) * (py.IsContinuous() ? 1 : y.Patches());
    region.nearest = CountNearest(dots.size(), values);
  }
  for (int j = 0; j < y.Patches(); ++j) {
    for (int i = 0; i < x.Patches(); ++i) {
      RegionCell cell{.x = x.Name(i), .y = y.Name(j)};
      cell.x_low = x.Low(i), cell.x_high = x.High(i);
      cell.y_low = y.Low(j), cell.y_high = y.High(j);
      std::vector<Dot> near;
      std::copy_if(dots.begin(), dots.end(), std::back_inserter(near), [&](const Dot& dot) {
        return x.Reaches(dot.x, x.Middle(i)) && y.Reaches(dot.y, y.Middle(j));
      });
      if (region.is_smoothed) LeaveNearest(x.Middle(i), y.Middle(j), region.nearest, near);
      Count(near, region.is_smoothed, cell);
      region.cells.push_back(std::move(cell));
    }
  }
  return region;
}

}  // namespace rift::sweep
