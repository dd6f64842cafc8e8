#include "rift/sweep/explain/failing_region.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rift::sweep {
namespace {

constexpr int kPatches = 24;          ///< of a range
constexpr size_t kMostTrials = 4000;  ///< that patches look for their nearest ones among
constexpr size_t kNearest = 12;

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
    return fmt::format("{:.3g} to {:.3g}", Low(patch), High(patch));
  }
  double Middle(int patch) const { return (patch + 0.5) / Patches(); }
  double Place(const experiment::ParameterValue& value) const {
    if (parameter_.IsContinuous()) {
      return (*value.number - parameter_.min) / (parameter_.max - parameter_.min);
    }
    const auto found = std::find(parameter_.levels.begin(), parameter_.levels.end(), value);
    return (static_cast<double>(found - parameter_.levels.begin()) + 0.5) / Patches();
  }

 private:
  double At(int edge) const {
    if (!parameter_.IsContinuous()) return edge;
    return parameter_.min + (parameter_.max - parameter_.min) * edge / Patches();
  }
  const experiment::Parameter& parameter_;
};

struct Dot {
  double x, y;
  bool falsified;
};

/// The trials that count for a place: on a list those of its level, in a range the nearest.
void Count(const std::vector<Dot>& dots, double x, double y, bool nearest_only, RegionCell& cell) {
  std::vector<std::pair<double, bool>> near;
  for (const Dot& dot : dots) {
    near.emplace_back(std::hypot(dot.x - x, dot.y - y), dot.falsified);
  }
  if (nearest_only) {
    const size_t k = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<long>(k), near.end());
    near.resize(k);
  } else {
    std::erase_if(near, [](const auto& dot) { return dot.first > 1e-9; });
  }
  cell.trials = static_cast<int>(near.size());
  if (near.empty()) return;
  const auto failing =
      std::count_if(near.begin(), near.end(), [](const auto& d) { return d.second; });
  cell.share = static_cast<double>(failing) / static_cast<double>(near.size());
}

std::vector<Dot> DotsOf(const SweepResult& result, const Side& x, int xp, const Side& y, int yp) {
  std::vector<Dot> dots;
  const size_t step = 1 + result.rows.size() / (kMostTrials + 1);
  for (size_t i = 0; i < result.rows.size(); i += step) {
    const TrialRow& row = result.rows[i];
    if (row.Tells())
      dots.push_back({x.Place(row.theta[xp]), y.Place(row.theta[yp]), row.falsified});
  }
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
  region.is_smoothed = px.IsContinuous() || py.IsContinuous();
  const std::vector<Dot> dots = DotsOf(result, x, parameters[0], y, parameters[1]);
  for (int j = 0; j < y.Patches(); ++j) {
    for (int i = 0; i < x.Patches(); ++i) {
      RegionCell cell{.x = x.Name(i), .y = y.Name(j)};
      cell.x_low = x.Low(i), cell.x_high = x.High(i);
      cell.y_low = y.Low(j), cell.y_high = y.High(j);
      Count(dots, x.Middle(i), y.Middle(j), region.is_smoothed, cell);
      region.cells.push_back(std::move(cell));
    }
  }
  return region;
}

}  // namespace rift::sweep
