#pragma once

#include <memory>
#include <vector>

#include "archive.hpp"
#include "rift/search/strategy.hpp"
#include "rift/statistics/random.hpp"
#include "space.hpp"

namespace rift::search {

/// What methods share: the space and all that was evaluated.
struct Known {
  explicit Known(const std::vector<Axis>& axes) : space(axes) {}
  Space space;
  Archive archive;
};

/// Lets another strategy propose and passes on only what is new. A point that was evaluated before
/// is answered from the archive, so that no method has to care.
class FreshOnly : public Strategy {
 public:
  FreshOnly(std::unique_ptr<Known> known, std::unique_ptr<Strategy> proposer, int batch,
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
