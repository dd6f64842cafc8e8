#pragma once

#include <array>
#include <limits>
#include <memory>

#include "archive.hpp"
#include "cma_es.hpp"
#include "controlled_random_search.hpp"
#include "differential_evolution.hpp"
#include "local_model.hpp"
#include "quadratic_fit.hpp"
#include "rift/search/options.hpp"
#include "samplers.hpp"
#include "surrogate.hpp"

namespace rift::search {

/// The default: a small design of Sobol points and a few corners, then the least of a quadratic
/// that is fitted to what is known, as long as it comes true, else the method that found most for
/// its evaluations, with an allowance for what was tried little (UCB1, Auer 2002, over
/// forgetting averages). A share of all points stays a Sobol sequence over the whole space to the
/// end, since what the others learn may lead away from a failure that nothing points to: a small
/// share while the others gain, about half when they do not.
class Portfolio : public Strategy {
 public:
  /// What a member found for what it spent.
  struct Record {
    double gain = 0.0;   ///< forgetting sum of rewards
    double spent = 0.0;  ///< forgetting count of evaluations, in batches of eight
  };

  Portfolio(const Known& known, const SearchOptions& options, int budget, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  enum Member {
    kSobol,
    kCorners,
    kSurrogate,
    kCmaEs,
    kLocalModel,
    kEvolution,
    kCrs,
    kFit,
    kMembers
  };
  static constexpr std::array kLearners{kSurrogate, kCmaEs, kLocalModel, kEvolution, kCrs};

  Member Choose() const;
  bool IsDesign() const;
  /// Points over the whole space that there should be among `total` evaluations.
  double DueAnywhere(double total) const;
  bool MayPropose(Member member) const;
  /// 1 for a new best, less for points among the best, 0 for none.
  double RewardOf(std::span<const Evaluation> batch) const;
  void NoteProgress(std::span<const Evaluation> batch);

  const Known& known_;
  bool is_continuous_;  ///< every axis
  double corners_;      ///< that there are
  int design_;          ///< evaluations
  double anywhere_points_ = 0.0, corner_points_ = 0.0, evolution_points_ = 0.0;
  std::array<std::unique_ptr<Strategy>, kMembers> members_;
  QuadraticFit* fit_ = nullptr;  ///< the member of that name
  std::array<Record, kMembers> records_;
  Member active_ = kSobol;
  std::size_t proposed_ = 0;  ///< points of the active member at the front of the batch
  double best_before_ = std::numeric_limits<double>::infinity();
  double progress_ = 1.0;  ///< forgetting mean of what the learners gain
};

}  // namespace rift::search
