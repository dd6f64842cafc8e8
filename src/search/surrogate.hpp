#pragma once

#include <Eigen/Core>
#include <vector>

#include "fresh.hpp"
#include "kriging.hpp"
#include "rift/search/options.hpp"
#include "rift/statistics/random.hpp"
#include "samplers.hpp"

namespace rift::search {

/// Kriging of the losses' ranks (so that one wild loss, or none at all, bends nothing), asked for
/// the points of lowest confidence bound among many candidates: some new anywhere, most around the
/// best ones. The points of a batch differ in how bold they are and keep apart by correlation.
class Surrogate : public Strategy {
 public:
  Surrogate(const Known& known, const SurrogateOptions& options, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation>) override {}

 private:
  void FitModel();
  std::vector<std::size_t> ModelPoints();
  Eigen::MatrixXd Candidates();
  Eigen::VectorXd Near(const Eigen::VectorXd& centre);

  const Known& known_;
  SurrogateOptions options_;
  statistics::Random random_;
  SobolSequence sequence_;
  Kriging model_;
  std::size_t fitted_at_ = 0;  ///< evaluations when the scales were last looked for
};

}  // namespace rift::search
