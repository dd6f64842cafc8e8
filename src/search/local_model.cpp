#include "local_model.hpp"

#include <algorithm>
#include <cmath>
#include <nlopt.hpp>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x300;
/// So many of the best evaluations are looked at for a start point.
constexpr std::size_t kStartsWithin = 200;
/// Start points are so far from earlier runs on some axis, or differ in a discrete one. A share of
/// the axes, as are the steps.
constexpr double kApart = 0.1;
constexpr double kFirstStep = 0.1;
/// No simulator and no robot tells settings apart that are nearer.
constexpr double kLastStep = 1e-8;
/// Points of a run at most, for each continuous axis.
constexpr int kMostPerAxis = 60;
/// What a model is told instead of a loss that is none, or too large to be squared.
constexpr double kLargest = 1e100;

double Tame(double loss) {
  return std::isnan(loss) ? kLargest : std::clamp(loss, -kLargest, kLargest);
}

}  // namespace

LocalModel::LocalModel(const Known& known, std::uint64_t seed)
    : known_(known),
      random_(seed, kStream),
      continuous_(known.space.ContinuousAxes()),
      discrete_(known.space.DiscreteAxes()) {}

bool LocalModel::IsNearARun(const Eigen::VectorXd& unit) const {
  return std::any_of(runs_.begin(), runs_.end(), [&](const Eigen::VectorXd& run) {
    return known_.space.HaveSameLevels(unit, run) &&
           ((unit - run)(continuous_).array().abs() < kApart).all();
  });
}

Eigen::VectorXd LocalModel::StartPoint(double& loss) {
  for (const std::size_t i : known_.archive.Best(kStartsWithin)) {
    const Evaluation& evaluation = known_.archive[i];
    const Eigen::VectorXd unit = known_.space.ToUnit(evaluation.point);
    loss = evaluation.loss;
    if (!IsNearARun(unit)) return unit;
  }
  loss = std::numeric_limits<double>::infinity();
  Eigen::VectorXd unit(known_.space.Size());
  for (double& u : unit) u = random_.Uniform();
  return known_.space.ToUnit(known_.space.FromUnit(unit));
}

void LocalModel::Begin() {
  start_ = best_ = StartPoint(start_loss_);
  best_loss_ = start_loss_;
  runs_.push_back(start_);
  losses_.clear();
  asked_.clear();
  told_ = 0;
  AddNeighbours();
  phase_ = asked_.empty() ? Phase::kModel : Phase::kNeighbours;
}

void LocalModel::AddNeighbours() {
  for (const int axis : discrete_) {
    const double levels = known_.space.Levels(axis);
    if (levels < 2.0) continue;
    const auto to = [&](double level) {
      Eigen::VectorXd unit = start_;
      unit[axis] = (level + 0.5) / levels;
      asked_.push_back(unit);
    };
    const double own = std::min(std::floor(start_[axis] * levels), levels - 1.0);
    if (known_.space.IsCategorical(axis)) {
      const auto others = static_cast<std::uint64_t>(levels) - 1;
      to(std::fmod(own + 1.0 + static_cast<double>(random_.Below(others)), levels));
      continue;
    }
    if (own > 0.0) to(own - 1.0);
    if (own + 1.0 < levels) to(own + 1.0);
  }
}

/// Another level that is better is where the model begins; without a continuous axis it is where
/// the next neighbours are looked at.
void LocalModel::FinishNeighbours() {
  const bool is_better = best_loss_ < start_loss_;
  start_ = best_;
  start_loss_ = best_loss_;
  asked_.clear();
  told_ = 0;
  if (!continuous_.empty()) {
    phase_ = Phase::kModel;
  } else if (is_better) {
    AddNeighbours();
  } else {
    End();
  }
}

void LocalModel::End() {
  runs_.push_back(best_);
  phase_ = Phase::kBetween;
}

Eigen::VectorXd LocalModel::NextOfModel() const {
  // BOBYQA wants two axes at least: a second one of which nothing depends does for one.
  const std::size_t axes = std::max<std::size_t>(2, continuous_.size());
  const std::size_t most = kMostPerAxis * axes;
  if (losses_.size() >= most) return {};
  Eigen::VectorXd next;
  std::size_t calls = 0;
  nlopt::opt model(nlopt::LN_BOBYQA, static_cast<unsigned>(axes));
  model.set_lower_bounds(0.0);
  model.set_upper_bounds(1.0);
  model.set_initial_step(kFirstStep);
  model.set_xtol_abs(kLastStep);
  model.set_maxeval(static_cast<int>(most));
  const auto loss = [&](const std::vector<double>& x) {
    if (calls < losses_.size()) return losses_[calls++];
    next = start_;
    for (std::size_t i = 0; i < continuous_.size(); ++i) {
      next[continuous_[i]] = std::clamp(x[i], 0.0, 1.0);
    }
    throw nlopt::forced_stop();
  };
  using Loss = decltype(loss);
  model.set_min_objective([](const std::vector<double>& x, std::vector<double>&,
                             void* data) { return (*static_cast<const Loss*>(data))(x); },
                          const_cast<void*>(static_cast<const void*>(&loss)));
  std::vector<double> x(axes, 0.5);
  for (std::size_t i = 0; i < continuous_.size(); ++i) x[i] = start_[continuous_[i]];
  double least = 0.0;
  try {
    model.optimize(x, least);
  } catch (const nlopt::forced_stop&) {       // at a point that nobody knows yet
  } catch (const nlopt::roundoff_limited&) {  // nothing to gain any more
  } catch (const std::runtime_error&) {       // flat beyond what a model can be made of
  }
  return next;
}

std::vector<Point> LocalModel::Ask(int most) {
  if (phase_ == Phase::kBetween) Begin();
  std::vector<Point> points;
  if (phase_ == Phase::kNeighbours) {
    for (std::size_t i = told_; i < asked_.size() && static_cast<int>(points.size()) < most; ++i) {
      points.push_back(known_.space.FromUnit(asked_[i]));
    }
    return points;
  }
  Eigen::VectorXd next = NextOfModel();
  if (next.size() == 0) {
    End();
    Begin();
    return Ask(most);
  }
  asked_ = {std::move(next)};
  return {known_.space.FromUnit(asked_.front())};
}

void LocalModel::Tell(std::span<const Evaluation> batch) {
  for (const Evaluation& evaluation : batch) {
    const Eigen::VectorXd& unit = asked_[phase_ == Phase::kNeighbours ? told_ : 0];
    if (evaluation.loss < best_loss_) {
      best_loss_ = evaluation.loss;
      best_ = unit;
    }
    phase_ == Phase::kNeighbours ? static_cast<void>(++told_)
                                 : losses_.push_back(Tame(evaluation.loss));
  }
  if (phase_ == Phase::kNeighbours && told_ == asked_.size()) FinishNeighbours();
}

}  // namespace rift::search
