#include "cma_es.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x200;
/// First step size as a share of every axis.
constexpr double kFirstSpread = 0.25;
/// Populations stop doubling here: 2^9 times the first.
constexpr int kMostDoublings = 9;

int DefaultPopulation(int axes) { return 4 + static_cast<int>(3.0 * std::log(axes)); }

/// Whole batches keep all workers busy to the end of a generation.
int WholeBatches(double population, int batch) {
  const int points = std::max(4, static_cast<int>(std::lround(population)));
  return points < batch ? points : (points + batch / 2) / batch * batch;
}

/// Least standard deviation on an integer axis as a share of its cell: the next cell is then still
/// reached from the middle of a cell in one of ten samples.
constexpr double kLeastOfCell = 0.3;
/// Least probability of all other levels together, as a share of an even draw.
constexpr double kLeastOfLevel = 0.2;
/// A generation whose losses differ by less than this share of themselves tells of rounding only.
constexpr double kFlat = 1e-13;
/// What a run may still gain is about what its generation differs by; one that is so many times as
/// far behind another's result ends early.
constexpr double kHopeless = 100.0;
constexpr double kLargestCondition = 1e14;
/// A run without progress for so many generations and 80 evaluations an axis ends.
constexpr int kStallGenerations = 20;
/// A run whose spread fell below this share of every axis ends: no simulator and no robot tells
/// settings apart that are so near.
constexpr double kLastSpread = 1e-7;

std::vector<int> RankOrder(const std::vector<double>& losses) {
  std::vector<int> order(losses.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return losses[a] < losses[b]; });
  return order;
}

Eigen::VectorXd LogWeights(int population) {
  const int mu = std::max(1, population / 2);
  Eigen::VectorXd weights(mu);
  for (int i = 0; i < mu; ++i) weights[i] = std::log(0.5 * (population + 1.0)) - std::log(i + 1.0);
  return weights / weights.sum();
}

}  // namespace

CmaEs::CmaEs(const Space& space, const Eigen::VectorXd& mean, double sigma, int population)
    : space_(space), population_(population), weights_(LogWeights(population)), sigma_(sigma) {
  for (int axis = 0; axis < space.Size(); ++axis) {
    (space.IsCategorical(axis) ? categorical_ : numeric_).push_back(axis);
  }
  mean_ = mean(numeric_);
  for (const int axis : categorical_) {
    // Half of the draws keep the level of the start.
    const auto levels = static_cast<Eigen::Index>(space.Levels(axis));
    Eigen::VectorXd p = Eigen::VectorXd::Constant(levels, 0.5 / static_cast<double>(levels));
    p[std::min(static_cast<Eigen::Index>(mean[axis] * static_cast<double>(levels)), levels - 1)] +=
        0.5;
    probabilities_.push_back(p);
  }
  // Table 1 of Hansen 2016; n counts the numeric axes.
  const double n = std::max<double>(1.0, static_cast<double>(numeric_.size()));
  mu_eff_ = 1.0 / weights_.squaredNorm();
  c_sigma_ = (mu_eff_ + 2.0) / (n + mu_eff_ + 5.0);
  d_sigma_ = 1.0 + 2.0 * std::max(0.0, std::sqrt((mu_eff_ - 1.0) / (n + 1.0)) - 1.0) + c_sigma_;
  c_c_ = (4.0 + mu_eff_ / n) / (n + 4.0 + 2.0 * mu_eff_ / n);
  c_1_ = 2.0 / ((n + 1.3) * (n + 1.3) + mu_eff_);
  c_mu_ = std::min(1.0 - c_1_,
                   2.0 * (mu_eff_ - 2.0 + 1.0 / mu_eff_) / ((n + 2.0) * (n + 2.0) + mu_eff_));
  chi_n_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
  const auto size = static_cast<Eigen::Index>(numeric_.size());
  covariance_ = axes_ = Eigen::MatrixXd::Identity(size, size);
  lengths_ = Eigen::VectorXd::Ones(size);
  path_sigma_ = path_c_ = Eigen::VectorXd::Zero(size);
}

std::vector<Eigen::VectorXd> CmaEs::Sample(statistics::Random& random) {
  draws_.clear();
  std::vector<Eigen::VectorXd> units;
  for (int i = 0; i < population_; ++i) {
    draws_.push_back(DrawOne(random));
    units.push_back(UnitOf(draws_.back()));
  }
  return units;
}

CmaEs::Draw CmaEs::DrawOne(statistics::Random& random) const {
  Draw draw;
  Eigen::VectorXd z(mean_.size());
  for (double& value : z) value = random.Normal();
  draw.step = axes_ * lengths_.cwiseProduct(z);
  Eigen::VectorXd x = mean_ + sigma_ * draw.step;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const int axis = numeric_[i];
    if (!space_.IsContinuous(axis)) {
      const double least = kLeastOfCell / space_.Levels(axis);
      const double variance = sigma_ * sigma_ * covariance_(i, i);
      x[i] += std::sqrt(std::max(0.0, least * least - variance)) * random.Normal();
    }
    const double inside = std::clamp(x[i], 0.0, 1.0);
    draw.step[i] += (inside - x[i]) / sigma_;
    x[i] = inside;
  }
  draw.moved = x;
  for (const Eigen::VectorXd& p : probabilities_) {
    double left = random.Uniform();
    int level = 0;
    while (level + 1 < p.size() && left >= p[level]) left -= p[level++];
    draw.categories.push_back(level);
  }
  return draw;
}

Eigen::VectorXd CmaEs::UnitOf(const Draw& draw) const {
  Eigen::VectorXd unit(space_.Size());
  unit(numeric_) = draw.moved;
  for (std::size_t i = 0; i < categorical_.size(); ++i) {
    unit[categorical_[i]] = (draw.categories[i] + 0.5) / space_.Levels(categorical_[i]);
  }
  return unit;
}

void CmaEs::Learn(const std::vector<double>& losses) {
  const std::vector<int> order = RankOrder(losses);
  NoteProgress(losses[order.front()], losses[order.back()] - losses[order.front()]);
  MoveMean(order);
  AdaptCategories(order);
  ++generation_;
}

void CmaEs::MoveMean(const std::vector<int>& order) {
  if (mean_.size() == 0) return;
  Eigen::VectorXd step = Eigen::VectorXd::Zero(mean_.size());
  Eigen::VectorXd moved = step;
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    step += weights_[i] * draws_[order[i]].step;
    moved += weights_[i] * draws_[order[i]].moved;
  }
  mean_ = moved;
  AdaptShape(step, order);
}

/// Equations 43 to 47 of Hansen 2016, without negative weights.
void CmaEs::AdaptShape(const Eigen::VectorXd& mean_step, const std::vector<int>& order) {
  const double n = static_cast<double>(mean_.size());
  const Eigen::VectorXd whitened = axes_ * (axes_.transpose() * mean_step).cwiseQuotient(lengths_);
  path_sigma_ =
      (1.0 - c_sigma_) * path_sigma_ + std::sqrt(c_sigma_ * (2.0 - c_sigma_) * mu_eff_) * whitened;
  const double norm = path_sigma_.norm();
  const double settled = std::sqrt(1.0 - std::pow(1.0 - c_sigma_, 2.0 * (generation_ + 1)));
  const bool is_steady = norm / settled < (1.4 + 2.0 / (n + 1.0)) * chi_n_;
  path_c_ *= 1.0 - c_c_;
  if (is_steady) path_c_ += std::sqrt(c_c_ * (2.0 - c_c_) * mu_eff_) * mean_step;
  const double lost = is_steady ? 0.0 : c_1_ * c_c_ * (2.0 - c_c_);
  covariance_ *= 1.0 - c_1_ - c_mu_ + lost;
  covariance_ += c_1_ * path_c_ * path_c_.transpose();
  for (Eigen::Index i = 0; i < weights_.size(); ++i) {
    const Eigen::VectorXd& step = draws_[order[i]].step;
    covariance_ += c_mu_ * weights_[i] * step * step.transpose();
  }
  sigma_ *= std::exp(std::min(1.0, c_sigma_ / d_sigma_ * (norm / chi_n_ - 1.0)));
  sigma_ = std::min(sigma_, 1.0);
  Decompose();
}

void CmaEs::Decompose() {
  const double n = static_cast<double>(mean_.size());
  const double every = 1.0 / ((c_1_ + c_mu_) * n * 10.0);  // Hansen 2016, B.2
  if (generation_ - decomposed_at_ < every) return;
  decomposed_at_ = generation_;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(covariance_);
  axes_ = solver.eigenvectors();
  lengths_ = solver.eigenvalues().cwiseMax(1e-30).cwiseSqrt();
}

void CmaEs::AdaptCategories(const std::vector<int>& order) {
  const double rate = std::min(0.5, mu_eff_ / static_cast<double>(population_));
  for (std::size_t k = 0; k < probabilities_.size(); ++k) {
    Eigen::VectorXd& p = probabilities_[k];
    p *= 1.0 - rate;
    for (Eigen::Index i = 0; i < weights_.size(); ++i) {
      p[draws_[order[i]].categories[k]] += rate * weights_[i];
    }
    p = p.cwiseMax(kLeastOfLevel / static_cast<double>(p.size()));
    p /= p.sum();
  }
}

void CmaEs::NoteProgress(double best, double spread) {
  const bool is_better = best < best_ - 1e-12 * std::abs(best_);
  if (is_better || (std::isinf(best_) && std::isfinite(best))) {
    best_ = best;
    improved_at_ = generation_;
  }
  spread_ = spread;
}

bool CmaEs::IsFlat() const {
  const bool has_continuous = std::any_of(numeric_.begin(), numeric_.end(),
                                          [this](int axis) { return space_.IsContinuous(axis); });
  return has_continuous && !(spread_ > kFlat * std::abs(best_));
}

bool CmaEs::IsDone(double best_known) const {
  const int patience = kStallGenerations + 80 * space_.Size() / population_;
  if (generation_ - improved_at_ > patience) return true;
  if (mean_.size() == 0) return false;
  if (IsFlat() || best_ - best_known > kHopeless * spread_) return true;
  const double largest = sigma_ * std::sqrt(covariance_.diagonal().maxCoeff());
  const double condition = std::pow(lengths_.maxCoeff() / lengths_.minCoeff(), 2);
  return largest < kLastSpread || condition > kLargestCondition;
}

Restarts::Restarts(const Known& known, int batch, std::uint64_t seed)
    : known_(known),
      batch_(batch),
      random_(seed, kStream),
      default_population_(DefaultPopulation(known.space.Size())) {}

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
  double population = default_population_, sigma = kFirstSpread;
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
  if (run_->IsDone(known_.archive.BestLoss())) run_.reset();
}

}  // namespace rift::search
