#pragma once

#include <optional>
#include <vector>

#include "cma_es.hpp"
#include "fresh.hpp"
#include "rift/search/options.hpp"

namespace rift::search {

/// CMA-ES run after run, with populations that double and, for as many evaluations, small ones
/// with short steps: BIPOP (Hansen 2009). The first run starts at the best point known then.
class Restarts : public Strategy {
 public:
  Restarts(const Known& known, const CmaEsOptions& options, int batch, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;
  /// A run just ended: what it learned is used up.
  bool IsBetweenRuns() const { return !run_; }

 private:
  void Begin();
  Eigen::VectorXd StartPoint();
  void FinishGeneration();

  const Known& known_;
  CmaEsOptions options_;
  int batch_;
  statistics::Random random_;
  std::optional<CmaEs> run_;
  std::vector<Point> generation_;
  std::vector<double> losses_;  ///< of the first points of the generation
  int default_population_;
  int runs_ = 0;
  int doublings_ = 0;
  bool is_large_ = true;
  double spent_large_ = 0.0, spent_small_ = 0.0;  ///< evaluations
};

}  // namespace rift::search
