#pragma once

#include <Eigen/Core>
#include <vector>

#include "archive.hpp"
#include "rift/search/options.hpp"
#include "rift/statistics/random.hpp"

namespace rift::search {

/// Pattern search from the best point that is not near an earlier start point: polls a random
/// orthonormal frame in both directions (Abramson 2009, OrthoMADS) and one other level of each
/// category, moves to what is better, halves the step when nothing is. Own code, because NLopt's
/// Sbplx and Nelder-Mead call the loss themselves and propose one point at a time.
class Polish : public Strategy {
 public:
  Polish(const Known& known, const PolishOptions& options, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;
  /// No start point was taken yet, or the last one is used up.
  bool IsBetweenRuns() const { return !is_running_; }

 private:
  void Begin();
  /// The best evaluation far from all start points, else a random point.
  Eigen::VectorXd StartPoint(double& loss);
  bool IsNearAStart(const Eigen::VectorXd& unit) const;
  void Poll();
  void PollFrame();
  void PollCategories();
  void FinishPoll();

  const Known& known_;
  PolishOptions options_;
  statistics::Random random_;
  std::vector<int> numeric_, categorical_;  ///< axes
  std::vector<Eigen::VectorXd> starts_;

  bool is_running_ = false;
  Eigen::VectorXd centre_;
  double centre_loss_ = 0.0;
  double step_ = 0.0;
  Eigen::VectorXd last_move_;
  std::vector<Eigen::VectorXd> poll_;
  std::size_t told_ = 0;  ///< of the poll
  Eigen::VectorXd best_;
  double best_loss_ = 0.0;
};

}  // namespace rift::search
