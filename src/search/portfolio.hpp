#pragma once

#include <array>
#include <limits>
#include <memory>

#include "archive.hpp"
#include "cma_es.hpp"
#include "polish.hpp"
#include "rift/search/options.hpp"
#include "samplers.hpp"
#include "surrogate.hpp"

namespace rift::search {

/// The default: corners and Sobol points in turn for a share of the budget, then batch by batch the
/// method that found most for its evaluations, with an allowance for what was tried little (UCB1,
/// Auer 2002, over forgetting averages). While the surrogate may propose, every third point still
/// explores.
class Portfolio : public Strategy {
 public:
  Portfolio(const Known& known, const SearchOptions& options, int budget, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  enum Member { kSobol, kCorners, kSurrogate, kCmaEs, kPolish, kMembers };
  struct Record {
    double gain = 0.0;   ///< forgetting sum of rewards
    double spent = 0.0;  ///< forgetting count of batches
  };

  Member Choose() const;
  bool IsExploring() const;
  Member Explorer() const;
  bool MayPropose(Member member) const;
  /// 1 for a new best, less for points among the best, 0 for none.
  double RewardOf(std::span<const Evaluation> batch) const;

  const Known& known_;
  int explore_;  ///< evaluations
  double explored_points_ = 0.0, corner_points_ = 0.0, polish_points_ = 0.0;
  std::array<std::unique_ptr<Strategy>, kMembers> members_;
  std::array<Record, kMembers> records_;
  Member active_ = kSobol;
  double best_before_ = std::numeric_limits<double>::infinity();
};

}  // namespace rift::search
