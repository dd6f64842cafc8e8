#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "archive.hpp"
#include "rift/search/strategy.hpp"
#include "rift/statistics/random.hpp"

namespace rift::search {

/// Controlled random search with local mutation (Price 1983; Kaelo and Ali 2006) over the unit
/// cube: points are reflected through simplices of random members of a population, the best always
/// one of them, and one that is no gain is mirrored about the best. What leaves the cube goes to
/// its bounds. The population is the best that any method evaluated since it began. A category
/// takes the level of a vertex. Begins anew when its population is one place. Own code, because
/// NLopt's CRS2 calls the loss itself and draws from one generator for the whole process.
class ControlledRandomSearch : public Strategy {
 public:
  ControlledRandomSearch(const Known& known, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;

 private:
  struct Member {
    Eigen::VectorXd unit;
    double loss = 0.0;
  };
  struct Trial {
    Eigen::VectorXd unit;
    bool is_reflection = false;
  };

  /// Takes in what was evaluated since the last time.
  void Meet();
  bool IsOnePlace() const;
  Trial Next();
  Eigen::VectorXd Anywhere();
  Eigen::VectorXd Reflection();
  Eigen::VectorXd Mutation(const Eigen::VectorXd& rejected);

  const Known& known_;
  statistics::Random random_;
  std::size_t size_;                       ///< of the full population
  std::size_t least_;                      ///< members before the first reflection
  std::size_t seen_ = 0;                   ///< evaluations taken in
  std::vector<Member> members_;            ///< best first
  std::vector<Trial> trials_;              ///< of the last Ask
  std::vector<Eigen::VectorXd> rejected_;  ///< reflections that await their mutation
};

}  // namespace rift::search
