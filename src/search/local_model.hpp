#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "archive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::search {

/// Local search by quadratic models from the best point that is not near an earlier run: Powell's
/// BOBYQA (2009, by NLopt) over the continuous axes, after the integers and categories of its start
/// were tried one step on. NLopt calls the loss itself and proposes one point at a time, so each
/// Ask runs it again over the losses that are known and stops it at the first that is not: BOBYQA
/// draws no random numbers, a run has few hundred points, and a step takes microseconds.
class LocalModel : public Strategy {
 public:
  LocalModel(const Known& known, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;
  /// No start point was taken yet, or the last one is used up.
  bool IsBetweenRuns() const { return phase_ == Phase::kBetween; }

 private:
  enum class Phase { kBetween, kNeighbours, kModel };

  void Begin();
  /// The best evaluation far from all earlier runs, else a random point.
  Eigen::VectorXd StartPoint(double& loss);
  bool IsNearARun(const Eigen::VectorXd& unit) const;
  void AddNeighbours();
  void FinishNeighbours();
  /// Where BOBYQA asks next, in unit coordinates; empty when its run is over.
  Eigen::VectorXd NextOfModel() const;
  void End();

  const Known& known_;
  statistics::Random random_;
  const std::vector<int>&continuous_, &discrete_;  ///< axes
  std::vector<Eigen::VectorXd> runs_;              ///< where runs began and where they ended

  Phase phase_ = Phase::kBetween;
  Eigen::VectorXd start_, best_;
  double start_loss_ = 0.0, best_loss_ = 0.0;
  std::vector<Eigen::VectorXd> asked_;  ///< neighbours, or the next point of the model
  std::size_t told_ = 0;                ///< of the neighbours
  std::vector<double> losses_;          ///< of the points of the model, in their order
};

}  // namespace rift::search
