#include "differential_evolution.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x500;
constexpr std::size_t kPerAxis = 4;
constexpr std::size_t kLeast = 12;
constexpr std::size_t kKnownPart = 8;  // one in so many
/// Share of the members that count as the best ones.
constexpr double kElite = 0.2;
/// Weight of a generation in the rates (JADE's c).
constexpr double kLearning = 0.1;
/// A population within this share of every axis is used up.
constexpr double kSamePlace = 1e-6;

}  // namespace

DifferentialEvolution::DifferentialEvolution(const Known& known, std::uint64_t seed)
    : known_(known),
      random_(seed, kStream),
      size_(std::max(kLeast, kPerAxis * static_cast<std::size_t>(known.space.Size()))) {}

/// Of the first members one in eight is the best that is known; the others keep the population
/// wide.
void DifferentialEvolution::Begin() {
  const bool is_first = members_.empty();
  members_.clear();
  target_ = 0;
  mean_step_ = mean_crossover_ = 0.5;
  if (is_first) {
    for (const std::size_t i : known_.archive.Best(size_ / kKnownPart)) {
      const Evaluation& evaluation = known_.archive[i];
      members_.push_back({known_.space.ToUnit(evaluation.point), evaluation.loss});
    }
  }
  while (members_.size() < size_) {
    Eigen::VectorXd unit(known_.space.Size());
    for (double& u : unit) u = random_.Uniform();
    members_.push_back({unit, std::numeric_limits<double>::infinity()});
  }
}

const DifferentialEvolution::Member& DifferentialEvolution::Other(std::size_t than) {
  const std::size_t index = (than + 1 + random_.Below(size_ - 1)) % size_;
  return members_[index];
}

DifferentialEvolution::Trial DifferentialEvolution::Next() {
  Trial trial{.target = target_};
  target_ = (target_ + 1) % size_;
  const Member& own = members_[trial.target];
  if (std::isinf(own.loss)) {  // not evaluated yet: itself
    trial.unit = own.unit;
    return trial;
  }
  trial.step = std::clamp(mean_step_ + 0.1 * std::tan(3.1 * (random_.Uniform() - 0.5)), 0.05, 1.0);
  trial.crossover = std::clamp(mean_crossover_ + 0.1 * random_.Normal(), 0.0, 1.0);
  std::vector<std::size_t> order(size_);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto elite = static_cast<std::size_t>(std::max(1.0, kElite * static_cast<double>(size_)));
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(elite), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return std::pair(members_[a].loss, a) < std::pair(members_[b].loss, b);
                    });
  const Member& best = members_[order[random_.Below(elite)]];
  const Member& a = Other(trial.target);
  const Member& b = Other(trial.target);
  trial.unit = own.unit;
  const auto axes = static_cast<std::uint64_t>(own.unit.size());
  const auto surely = static_cast<int>(random_.Below(axes));
  for (int axis = 0; axis < known_.space.Size(); ++axis) {
    if (axis != surely && random_.Uniform() > trial.crossover) continue;
    if (known_.space.IsCategorical(axis)) {
      trial.unit[axis] = random_.Uniform() < 0.5 ? best.unit[axis] : a.unit[axis];
      continue;
    }
    double moved = own.unit[axis] + trial.step * (best.unit[axis] - own.unit[axis]) +
                   trial.step * (a.unit[axis] - b.unit[axis]);
    // Half way to a bound that was crossed.
    if (moved < 0.0) moved = 0.5 * own.unit[axis];
    if (moved > 1.0) moved = 0.5 * (1.0 + own.unit[axis]);
    trial.unit[axis] = moved;
  }
  return trial;
}

std::vector<Point> DifferentialEvolution::Ask(int most) {
  if (members_.empty()) Begin();
  trials_.clear();
  std::vector<Point> points;
  const std::size_t left = size_ - target_;  // a generation ends before the next begins
  while (points.size() < std::min(left, static_cast<std::size_t>(most))) {
    trials_.push_back(Next());
    points.push_back(known_.space.FromUnit(trials_.back().unit));
  }
  return points;
}

void DifferentialEvolution::Tell(std::span<const Evaluation> batch) {
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const Trial& trial = trials_[i];
    Member& target = members_[trial.target];
    const double loss =
        std::isfinite(batch[i].loss) ? batch[i].loss : std::numeric_limits<double>::max();
    if (!(loss <= target.loss)) continue;
    if (trial.step > 0.0 && loss < target.loss) {
      good_steps_.push_back(trial.step);
      good_crossovers_.push_back(trial.crossover);
    }
    target = {trial.unit, loss};
  }
  if (target_ == 0) FinishGeneration();
}

void DifferentialEvolution::FinishGeneration() {
  if (!good_steps_.empty()) {
    double sum = 0.0, squares = 0.0, crossovers = 0.0;
    for (const double step : good_steps_) sum += step, squares += step * step;
    for (const double crossover : good_crossovers_) crossovers += crossover;
    mean_step_ += kLearning * (squares / sum - mean_step_);
    mean_crossover_ +=
        kLearning * (crossovers / static_cast<double>(good_crossovers_.size()) - mean_crossover_);
  }
  good_steps_.clear();
  good_crossovers_.clear();
  Eigen::VectorXd low = members_.front().unit, high = low;
  for (const Member& member : members_) {
    low = low.cwiseMin(member.unit);
    high = high.cwiseMax(member.unit);
  }
  if ((high - low).maxCoeff() < kSamePlace) Begin();
}

}  // namespace rift::search
