#include "archive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "rift/statistics/hash.hpp"

namespace rift::search {
namespace {

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

}  // namespace rift::search
