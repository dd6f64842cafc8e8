#include "controlled_random_search.hpp"

#include <algorithm>

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x600;
/// Members for each vertex of a simplex (Price 1983; as NLopt), and how many of them there must be
/// before the first reflection: the others may come from it.
constexpr std::size_t kPerVertex = 10;
constexpr std::size_t kLeastPerVertex = 3;
/// Probability of a category to be that of the best member instead of another vertex.
constexpr double kOfBest = 0.5;
/// A population within this share of every axis is used up.
constexpr double kSamePlace = 1e-6;

}  // namespace

ControlledRandomSearch::ControlledRandomSearch(const Known& known, std::uint64_t seed)
    : known_(known),
      random_(seed, kStream),
      size_(kPerVertex * static_cast<std::size_t>(known.space.Size() + 1)),
      least_(kLeastPerVertex * static_cast<std::size_t>(known.space.Size() + 1)) {}

void ControlledRandomSearch::Meet() {
  for (; seen_ < known_.archive.Size(); ++seen_) {
    const Evaluation& one = known_.archive[seen_];
    if (members_.size() >= size_ && !(one.loss < members_.back().loss)) continue;
    Member member{known_.space.ToUnit(one.point), one.loss};
    const auto place =
        std::upper_bound(members_.begin(), members_.end(), member,
                         [](const Member& a, const Member& b) { return a.loss < b.loss; });
    members_.insert(place, std::move(member));
    if (members_.size() > size_) members_.pop_back();
  }
}

bool ControlledRandomSearch::IsOnePlace() const {
  if (members_.size() < size_) return false;
  Eigen::VectorXd low = members_.front().unit, high = low;
  for (const Member& member : members_) {
    low = low.cwiseMin(member.unit);
    high = high.cwiseMax(member.unit);
  }
  return (high - low).maxCoeff() < kSamePlace;
}

Eigen::VectorXd ControlledRandomSearch::Anywhere() {
  Eigen::VectorXd unit(known_.space.Size());
  for (double& u : unit) u = random_.Uniform();
  return unit;
}

Eigen::VectorXd ControlledRandomSearch::Reflection() {
  // The best and so many others; the last of them is reflected through the centre of the rest.
  const auto others = static_cast<std::size_t>(known_.space.Size());
  std::vector<std::size_t> vertices;
  while (vertices.size() < others) {
    const std::size_t other = 1 + random_.Below(members_.size() - 1);
    const bool is_new = std::find(vertices.begin(), vertices.end(), other) == vertices.end();
    if (is_new) vertices.push_back(other);
  }
  Eigen::VectorXd sum = members_.front().unit;
  for (std::size_t i = 0; i + 1 < others; ++i) sum += members_[vertices[i]].unit;
  Eigen::VectorXd unit = 2.0 / static_cast<double>(others) * sum - members_[vertices.back()].unit;
  for (int axis = 0; axis < known_.space.Size(); ++axis) {
    unit[axis] = std::clamp(unit[axis], 0.0, 1.0);
    if (!known_.space.IsCategorical(axis)) continue;
    const bool is_of_best = random_.Uniform() < kOfBest;
    unit[axis] = members_[is_of_best ? 0 : vertices[random_.Below(others)]].unit[axis];
  }
  return unit;
}

Eigen::VectorXd ControlledRandomSearch::Mutation(const Eigen::VectorXd& rejected) {
  const Eigen::VectorXd& best = members_.front().unit;
  Eigen::VectorXd unit = best;
  for (int axis = 0; axis < known_.space.Size(); ++axis) {
    if (known_.space.IsCategorical(axis)) continue;
    const double moved = best[axis] + random_.Uniform() * (best[axis] - rejected[axis]);
    unit[axis] = std::clamp(moved, 0.0, 1.0);
  }
  return unit;
}

ControlledRandomSearch::Trial ControlledRandomSearch::Next() {
  if (members_.size() < least_) return {Anywhere(), false};
  if (rejected_.empty()) return {Reflection(), true};
  Trial trial{Mutation(rejected_.back()), false};
  rejected_.pop_back();
  return trial;
}

std::vector<Point> ControlledRandomSearch::Ask(int most) {
  Meet();
  if (IsOnePlace()) {
    members_.clear();
    rejected_.clear();
  }
  trials_.clear();
  std::vector<Point> points;
  while (static_cast<int>(points.size()) < most) {
    trials_.push_back(Next());
    points.push_back(known_.space.FromUnit(trials_.back().unit));
  }
  return points;
}

void ControlledRandomSearch::Tell(std::span<const Evaluation> batch) {
  const double worst = members_.empty() ? 0.0 : members_.back().loss;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (trials_[i].is_reflection && !(batch[i].loss < worst)) rejected_.push_back(trials_[i].unit);
  }
}

}  // namespace rift::search
