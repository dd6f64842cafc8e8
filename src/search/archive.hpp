#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "rift/search/strategy.hpp"
#include "rift/statistics/random.hpp"
#include "space.hpp"

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

/// What methods share: the space and all that was evaluated.
struct Known {
  explicit Known(const std::vector<Axis>& axes) : space(axes) {}
  Space space;
  Archive archive;
};

/// Lets another strategy propose and passes on only what is new. A point that was evaluated before
/// is answered from the archive, so that no method has to care.
class WithoutRepeats : public Strategy {
 public:
  WithoutRepeats(std::unique_ptr<Known> known, std::unique_ptr<Strategy> proposer, int batch,
                 std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  bool IsExhausted() const;
  /// Asks the proposer until it says something new or is not going to.
  void Consult(int most);
  void AnswerProposer();
  Point Unseen();

  std::unique_ptr<Known> known_;
  std::unique_ptr<Strategy> proposer_;
  std::vector<Point> proposed_;  ///< the proposer's last batch
  std::vector<Point> asked_;     ///< what of it, or instead of it, was passed on
  int batch_;
  statistics::Random random_;
};

}  // namespace rift::search
