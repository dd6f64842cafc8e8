#include "restarts.hpp"

#include <algorithm>
#include <cmath>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x200;
/// Populations stop doubling here: 2^9 times the first.
constexpr int kMostDoublings = 9;

int DefaultPopulation(int axes) { return 4 + static_cast<int>(3.0 * std::log(axes)); }

/// Whole batches keep all workers busy to the end of a generation.
int WholeBatches(double population, int batch) {
  const int points = std::max(4, static_cast<int>(std::lround(population)));
  return points < batch ? points : (points + batch / 2) / batch * batch;
}

}  // namespace

Restarts::Restarts(const Known& known, const CmaEsOptions& options, int batch, std::uint64_t seed)
    : known_(known),
      options_(options),
      batch_(batch),
      random_(seed, kStream),
      default_population_(options.population > 0 ? options.population
                                                 : DefaultPopulation(known.space.Size())) {}

Eigen::VectorXd Restarts::StartPoint() {
  if (runs_ == 0 && std::isfinite(known_.archive.BestLoss())) {
    return known_.space.ToUnit(known_.archive[known_.archive.Best(1).front()].point);
  }
  Eigen::VectorXd unit(known_.space.Size());
  for (double& u : unit) u = random_.Uniform();
  return unit;
}

void Restarts::Begin() {
  const Eigen::VectorXd start = StartPoint();
  double population = default_population_, sigma = options_.sigma;
  is_large_ = runs_ == 0 || spent_large_ <= spent_small_;
  if (runs_ > 0 && is_large_) {
    doublings_ = std::min(doublings_ + 1, kMostDoublings);
    population *= std::pow(2.0, doublings_);
  } else if (runs_ > 0) {
    // Hansen 2009: sizes up to half of the last large one, steps down to a hundredth.
    const double u = random_.Uniform();
    population *= std::pow(0.5 * std::pow(2.0, doublings_), u * u);
    sigma *= std::pow(10.0, -2.0 * random_.Uniform());
  }
  run_.emplace(known_.space, start, sigma, WholeBatches(population, batch_));
  ++runs_;
}

std::vector<Point> Restarts::Ask(int most) {
  if (!run_) Begin();
  if (generation_.empty()) {
    for (const Eigen::VectorXd& unit : run_->Sample(random_)) {
      generation_.push_back(known_.space.FromUnit(unit));
    }
  }
  const auto first = generation_.begin() + static_cast<std::ptrdiff_t>(losses_.size());
  const auto count = std::min<std::ptrdiff_t>(most, generation_.end() - first);
  return {first, first + count};
}

void Restarts::Tell(std::span<const Evaluation> batch) {
  for (const Evaluation& evaluation : batch) {
    losses_.push_back(std::isfinite(evaluation.loss) ? evaluation.loss
                                                     : std::numeric_limits<double>::infinity());
  }
  (is_large_ ? spent_large_ : spent_small_) += static_cast<double>(batch.size());
  if (losses_.size() == generation_.size()) FinishGeneration();
}

void Restarts::FinishGeneration() {
  run_->Learn(losses_);
  generation_.clear();
  losses_.clear();
  if (run_->IsDone(options_.stall_generations)) run_.reset();
}

}  // namespace rift::search
