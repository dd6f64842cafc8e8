#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "rift/search/strategy.hpp"

namespace rift::search {

/// Everything that was evaluated, in order, for all methods to learn from.
class Archive {
 public:
  /// A loss that is not finite is kept as +infinity: worse than any number.
  void Add(const Evaluation& evaluation);

  std::size_t Size() const { return evaluations_.size(); }
  bool IsEmpty() const { return evaluations_.empty(); }
  const Evaluation& operator[](std::size_t i) const { return evaluations_[i]; }
  /// Which evaluation was of this very point, if one was.
  std::optional<std::size_t> Find(const Point& point) const;
  /// Indices from the best evaluation to the worst, the earlier of equals first; at most `most`.
  std::vector<std::size_t> Best(std::size_t most) const;
  /// +infinity while there is none.
  double BestLoss() const { return best_loss_; }

 private:
  std::vector<Evaluation> evaluations_;
  std::unordered_multimap<std::uint64_t, std::size_t> by_hash_;
  double best_loss_ = std::numeric_limits<double>::infinity();
};

}  // namespace rift::search
