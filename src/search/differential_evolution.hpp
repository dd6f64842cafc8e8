#pragma once

#include <Eigen/Core>
#include <vector>

#include "archive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::search {

/// Differential evolution, current-to-pbest/1 with rates that adapt (JADE, Zhang and Sanderson
/// 2009, without its archive), over the unit cube. It finds the many separate valleys of a loss
/// that CMA-ES needs large populations for. A category takes the level of one of the parents.
/// Begins anew when its population is one place. Own code, because pagmo's de1220 calls the loss
/// from inside evolve().
class DifferentialEvolution : public Strategy {
 public:
  DifferentialEvolution(const Known& known, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  struct Member {
    Eigen::VectorXd unit;
    double loss = 0.0;
  };
  struct Trial {
    Eigen::VectorXd unit;
    std::size_t target = 0;
    double step = 0.0, crossover = 0.0;
  };

  void Begin();
  Trial Next();
  const Member& Other(std::size_t than);
  void FinishGeneration();

  const Known& known_;
  statistics::Random random_;
  std::size_t size_;
  std::vector<Member> members_;
  std::vector<Trial> trials_;  ///< of the last Ask
  std::size_t target_ = 0;     ///< of the next trial
  double mean_step_ = 0.5, mean_crossover_ = 0.5;
  std::vector<double> good_steps_, good_crossovers_;  ///< of this generation
};

}  // namespace rift::search
