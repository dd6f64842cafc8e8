#include "archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "rift/statistics/hash.hpp"

namespace rift::search {
namespace {

constexpr std::uint64_t kUnseenStream = 0x100;
/// A method that proposes so many known batches on end is stuck.
constexpr int kPatience = 20;

bool IsAmong(const std::vector<Point>& points, const Point& point) {
  return std::find(points.begin(), points.end(), point) != points.end();
}

std::uint64_t HashOf(Point point) {
  for (double& value : point) value += 0.0;  // -0 is the same place as 0
  return statistics::Hash64(std::as_bytes(std::span(point)));
}

}  // namespace

void Archive::Add(const Evaluation& evaluation) {
  evaluations_.push_back(evaluation);
  Evaluation& kept = evaluations_.back();
  if (!std::isfinite(kept.loss)) kept.loss = std::numeric_limits<double>::infinity();
  by_hash_.emplace(HashOf(kept.point), evaluations_.size() - 1);
  best_loss_ = std::min(best_loss_, kept.loss);
}

std::optional<std::size_t> Archive::Find(const Point& point) const {
  const auto [begin, end] = by_hash_.equal_range(HashOf(point));
  for (auto entry = begin; entry != end; ++entry) {
    if (evaluations_[entry->second].point == point) return entry->second;
  }
  return std::nullopt;
}

std::vector<std::size_t> Archive::Best(std::size_t most) const {
  std::vector<std::size_t> order(evaluations_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(std::min(most, order.size()));
  std::partial_sort(order.begin(), middle, order.end(), [this](std::size_t a, std::size_t b) {
    if (evaluations_[a].loss != evaluations_[b].loss) {
      return evaluations_[a].loss < evaluations_[b].loss;
    }
    return a < b;
  });
  order.erase(middle, order.end());
  return order;
}

WithoutRepeats::WithoutRepeats(std::unique_ptr<Known> known, std::unique_ptr<Strategy> proposer,
                               int batch, std::uint64_t seed)
    : known_(std::move(known)),
      proposer_(std::move(proposer)),
      batch_(batch),
      random_(seed, kUnseenStream) {}

bool WithoutRepeats::IsExhausted() const {
  const auto& points = known_->space.Points();
  return points && known_->archive.Size() >= *points;
}

std::vector<Point> WithoutRepeats::Ask(int most) {
  assert(most >= 1 && asked_.empty());
  if (IsExhausted()) return {};
  Consult(std::min(most, batch_));
  if (asked_.empty()) asked_.push_back(Unseen());
  return asked_;
}

void WithoutRepeats::Consult(int most) {
  for (int i = 0; i < kPatience && asked_.empty(); ++i) {
    proposed_ = proposer_->Ask(most);
    if (proposed_.empty()) return;
    for (const Point& point : proposed_) {
      const bool is_new = !known_->archive.Find(point) && !IsAmong(asked_, point);
      if (is_new) asked_.push_back(point);
    }
    if (asked_.empty()) AnswerProposer();
  }
}

void WithoutRepeats::AnswerProposer() {
  if (proposed_.empty()) return;
  std::vector<Evaluation> answers;
  for (const Point& point : proposed_) {
    const auto index = known_->archive.Find(point);
    assert(index);
    answers.push_back(known_->archive[*index]);
  }
  proposed_.clear();
  proposer_->Tell(answers);
}

Point WithoutRepeats::Unseen() {
  const Space& space = known_->space;
  if (space.Points()) {
    const std::uint64_t points = *space.Points();
    std::uint64_t index = random_.Below(points);
    while (known_->archive.Find(space.AtIndex(index))) index = (index + 1) % points;
    return space.AtIndex(index);
  }
  Point point;
  do {
    Eigen::VectorXd unit(space.Size());
    for (double& u : unit) u = random_.Uniform();
    point = space.FromUnit(unit);
  } while (known_->archive.Find(point));
  return point;
}

void WithoutRepeats::Tell(std::span<const Evaluation> batch) {
  const bool is_answer =
      std::equal(batch.begin(), batch.end(), asked_.begin(), asked_.end(),
                 [](const Evaluation& e, const Point& p) { return e.point == p; });
  if (!is_answer) {
    throw std::invalid_argument(
        fmt::format("search: told {} evaluations that are not the {} points asked last, in order",
                    batch.size(), asked_.size()));
  }
  for (const Evaluation& evaluation : batch) known_->archive.Add(evaluation);
  asked_.clear();
  AnswerProposer();
}

}  // namespace rift::search
