#include "polish.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x300;
/// So many of the best evaluations are looked at for a start point.
constexpr std::size_t kStartsWithin = 200;

/// Columns are orthonormal and point evenly anywhere.
Eigen::MatrixXd RandomFrame(Eigen::Index size, statistics::Random& random) {
  Eigen::MatrixXd normal(size, size);
  for (double& value : normal.reshaped()) value = random.Normal();
  return Eigen::HouseholderQR<Eigen::MatrixXd>(normal).householderQ();
}

}  // namespace

Polish::Polish(const Known& known, const PolishOptions& options, std::uint64_t seed)
    : known_(known), options_(options), random_(seed, kStream) {
  for (int axis = 0; axis < known.space.Size(); ++axis) {
    (known.space.IsCategorical(axis) ? categorical_ : numeric_).push_back(axis);
  }
}

bool Polish::IsNearAStart(const Eigen::VectorXd& unit) const {
  return std::any_of(starts_.begin(), starts_.end(), [&](const Eigen::VectorXd& start) {
    const Eigen::VectorXd apart = (unit - start).cwiseAbs();
    const bool is_other_level = (apart(categorical_).array() > 1e-9).any();
    return !is_other_level && (apart(numeric_).array() < options_.apart).all();
  });
}

Eigen::VectorXd Polish::StartPoint(double& loss) {
  for (const std::size_t i : known_.archive.Best(kStartsWithin)) {
    const Evaluation& evaluation = known_.archive[i];
    const Eigen::VectorXd unit = known_.space.ToUnit(evaluation.point);
    loss = evaluation.loss;
    if (!IsNearAStart(unit)) return unit;
  }
  loss = std::numeric_limits<double>::infinity();
  Eigen::VectorXd unit(known_.space.Size());
  for (double& u : unit) u = random_.Uniform();
  return known_.space.ToUnit(known_.space.FromUnit(unit));
}

void Polish::Begin() {
  centre_ = StartPoint(centre_loss_);
  starts_.push_back(centre_);
  step_ = options_.first_step;
  last_move_.resize(0);
  is_running_ = true;
}

void Polish::PollFrame() {
  const Eigen::MatrixXd frame = RandomFrame(static_cast<Eigen::Index>(numeric_.size()), random_);
  for (const auto& direction : frame.colwise()) {
    for (const double sign : {1.0, -1.0}) {
      Eigen::VectorXd unit = centre_;
      for (Eigen::Index i = 0; i < direction.size(); ++i) {
        const int axis = numeric_[i];
        // A step moves an integer by one at least where it leads along it at all.
        const double cell = known_.space.IsContinuous(axis) ? 0.0 : 1.0 / known_.space.Levels(axis);
        const double part = sign * direction[i];
        const double length = std::abs(part) > 0.5 ? std::max(step_, cell) : step_;
        unit[axis] = std::clamp(unit[axis] + length * part, 0.0, 1.0);
      }
      poll_.push_back(unit);
    }
  }
}

void Polish::PollCategories() {
  for (const int axis : categorical_) {
    const auto levels = static_cast<std::uint64_t>(known_.space.Levels(axis));
    if (levels < 2) continue;
    const auto own = static_cast<std::uint64_t>(centre_[axis] * static_cast<double>(levels));
    const std::uint64_t other = (own + 1 + random_.Below(levels - 1)) % levels;
    Eigen::VectorXd unit = centre_;
    unit[axis] = (static_cast<double>(other) + 0.5) / static_cast<double>(levels);
    poll_.push_back(unit);
  }
}

void Polish::Poll() {
  if (last_move_.size() > 0) {
    poll_.push_back((centre_ + last_move_).cwiseMax(0.0).cwiseMin(1.0));
  }
  PollFrame();
  PollCategories();
  best_ = centre_;
  best_loss_ = centre_loss_;
}

std::vector<Point> Polish::Ask(int most) {
  if (!is_running_) Begin();
  if (poll_.empty()) Poll();
  std::vector<Point> points;
  for (std::size_t i = told_; i < poll_.size() && static_cast<int>(points.size()) < most; ++i) {
    points.push_back(known_.space.FromUnit(poll_[i]));
  }
  return points;
}

void Polish::Tell(std::span<const Evaluation> batch) {
  for (const Evaluation& evaluation : batch) {
    if (evaluation.loss < best_loss_) {
      best_loss_ = evaluation.loss;
      best_ = poll_[told_];
    }
    ++told_;
  }
  // The rest of a poll is left out once something is better.
  if (told_ == poll_.size() || best_loss_ < centre_loss_) FinishPoll();
}

void Polish::FinishPoll() {
  const bool is_better = best_loss_ < centre_loss_;
  last_move_ = is_better ? Eigen::VectorXd(best_ - centre_) : Eigen::VectorXd();
  step_ = is_better ? std::min(2.0 * step_, options_.first_step) : 0.5 * step_;
  centre_ = best_;
  centre_loss_ = best_loss_;
  poll_.clear();
  told_ = 0;
  if (step_ < options_.last_step) is_running_ = false;
}

}  // namespace rift::search
