#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "archive.hpp"
#include "rift/search/options.hpp"
#include "rift/statistics/random.hpp"
#include "space.hpp"

namespace rift::search {

/// One run of the (mu/mu_w, lambda)-CMA-ES (Hansen 2016, arXiv:1604.00772) in the unit cube of a
/// mixed space, one generation at a time. Own code on Eigen, because pagmo's cmaes calls the loss
/// from inside evolve(): it can neither wait for a batch of workers nor be told again after a stop.
///
/// Continuous axes: samples outside are moved to the bounds, where a simulator often fails first.
/// Integer axes: their spread never falls below a part of a cell (in the manner of Hamano 2022,
/// CMA-ES with margin). Categorical axes: a probability for each level, drawn towards those of the
/// selected and never below a floor (in the manner of CatCMA, Hamano 2024).
class CmaEs {
 public:
  /// `mean`: unit coordinates. `sigma`: share of the axes.
  CmaEs(const Space& space, const Eigen::VectorXd& mean, double sigma, int population);

  /// The next generation, in unit coordinates.
  std::vector<Eigen::VectorXd> Sample(statistics::Random& random);
  /// The losses of that generation, in its order; +infinity where there is none.
  void Learn(const std::vector<double>& losses);
  /// Nothing more to gain: the spread or the differences vanished, no progress for long, or it
  /// settles at losses far above `best_known`.
  bool IsDone(double best_known) const;

 private:
  struct Draw {
    Eigen::VectorXd step;   ///< of the numeric axes, in sigma
    Eigen::VectorXd moved;  ///< the same as evaluated, bounds and cells included
    std::vector<int> categories;
  };

  void Decompose();
  Draw DrawOne(statistics::Random& random) const;
  Eigen::VectorXd UnitOf(const Draw& draw) const;
  void MoveMean(const std::vector<int>& order);
  void AdaptShape(const Eigen::VectorXd& mean_step, const std::vector<int>& order);
  void AdaptCategories(const std::vector<int>& order);
  void NoteProgress(double best, double spread);
  bool IsFlat() const;

  const Space& space_;
  std::vector<int> numeric_, categorical_;  ///< axes
  int population_;
  Eigen::VectorXd weights_;
  double mu_eff_, c_sigma_, d_sigma_, c_c_, c_1_, c_mu_, chi_n_;

  Eigen::VectorXd mean_;
  double sigma_;
  Eigen::MatrixXd covariance_, axes_;  ///< axes_: eigenvectors
  Eigen::VectorXd lengths_;            ///< square roots of the eigenvalues
  Eigen::VectorXd path_sigma_, path_c_;
  std::vector<Eigen::VectorXd> probabilities_;  ///< one vector a categorical axis

  std::vector<Draw> draws_;
  int generation_ = 0;
  int decomposed_at_ = 0;
  int improved_at_ = 0;
  double best_ = std::numeric_limits<double>::infinity();
  double spread_ = 0.0;  ///< of the losses in the last generation
};

/// CMA-ES run after run, with populations that double and, for as many evaluations, small ones
/// with short steps: BIPOP (Hansen 2009). The first run starts at the best point known then.
class Restarts : public Strategy {
 public:
  Restarts(const Known& known, int batch, std::uint64_t seed);

  std::vector<Point> Ask(int most) override;
  void Tell(std::span<const Evaluation> batch) override;
  /// A run just ended: what it learned is used up.
  bool IsBetweenRuns() const { return !run_; }

 private:
  void Begin();
  Eigen::VectorXd StartPoint();
  void FinishGeneration();

  const Known& known_;
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
