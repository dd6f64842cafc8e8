// CMA-ES where its equations are cut off: large populations, long steps, narrow ellipsoids.
#include "search/cma_es.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "search/scalar_cma.hpp"

namespace rift::search {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Space Ranges(size_t axes) {
  return Space(std::vector<Axis>(axes, {"a", AxisKind::kContinuous, 0.0, 1.0}));
}

/// Draws and learns generation by generation beside the equations by hand, of which it calls
/// `visit` after each.
template <class Loss, class Visit>
void Follow(std::uint64_t seed, double start, double sigma, int population, int generations,
            const Loss& loss, const Visit& visit) {
  const Space space = Ranges(1);
  statistics::Random random(seed, 1), same(seed, 1);
  CmaEs search(space, Eigen::VectorXd::Constant(1, start), sigma, population);
  ScalarCma by_hand(start, sigma, population);
  for (int generation = 0; generation < generations; ++generation) {
    CAPTURE(seed, population, generation);
    std::vector<double> drawn, losses;
    for (const Eigen::VectorXd& unit : search.Sample(random)) {
      const double reach = by_hand.sigma * by_hand.length * std::abs(same.Normal());
      CHECK(std::abs(unit[0] - by_hand.mean) / by_hand.sigma ==
            Approx(reach / by_hand.sigma).margin(1e-6));  // an eigenvector has either sign
      drawn.push_back(unit[0]);
      losses.push_back(loss(unit[0]));
    }
    search.Learn(losses);
    std::sort(drawn.begin(), drawn.end(), [&](double a, double b) { return loss(a) < loss(b); });
    by_hand.Learn(drawn);
    visit(by_hand);
  }
}

TEST_CASE("A large population learns its whole shape from one generation, as Hansen's does") {
  for (const int population : {30, 80, 81}) {
    const ScalarCma by_hand(0.5, 0.01, population);
    CHECK((by_hand.c_mu == 1.0 - by_hand.c_1) == (population >= 80));
    Follow(
        8, 0.45, 0.01, population, 4, [](double x) { return std::abs(x - 0.5); },
        [](const ScalarCma&) {});
  }
}

TEST_CASE("The step size grows by a factor of e in a generation, and by no more") {
  int cut = 0, grown = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Follow(
        seed, 0.3, 1e-9, 4, 10, [](double x) { return -x; },
        [&](const ScalarCma& by_hand) {
          cut += by_hand.growth > 1.05;
          grown += by_hand.growth > 0.0 && by_hand.growth < 0.95;
        });
  }
  CHECK(cut > 1);
  CHECK(grown > 1);
}

/// The square of how much wider the draws of a generation spread along one direction than along
/// another: the draws are the mean and a matrix times the normal numbers that they are made of.
double ConditionOf(const std::vector<Eigen::VectorXd>& drawn, statistics::Random& same) {
  Eigen::MatrixXd known(static_cast<Eigen::Index>(drawn.size()), 3), places(known.rows(), 2);
  Eigen::Index used = 0;
  for (const Eigen::VectorXd& unit : drawn) {
    const double first = same.Normal(), second = same.Normal();
    if (unit.minCoeff() <= 0.0 || unit.maxCoeff() >= 1.0) continue;  // moved onto a bound
    known.row(used) << 1.0, first, second;
    places.row(used++) = unit.transpose();
  }
  const Eigen::MatrixXd found =
      known.topRows(used).colPivHouseholderQr().solve(places.topRows(used));
  const Eigen::Vector2d widths = found.bottomRows(2).jacobiSvd().singularValues();
  return std::pow(widths[0] / widths[1], 2);
}

TEST_CASE("A run ends where it is ten million times as wide one way as another, and not before") {
  const Space space = Ranges(2);
  int ended = 0;
  for (const std::uint64_t seed : {1, 4, 7, 14}) {  // they end while they are wide one way
    statistics::Random random(seed, 1), same(seed, 1);
    CmaEs search(space, Eigen::Vector2d(0.5, 0.5), 0.2, 12);
    bool is_done = false;
    for (int generation = 0; generation < 300; ++generation) {
      const std::vector<Eigen::VectorXd> drawn = search.Sample(random);
      const double condition = ConditionOf(drawn, same);
      CAPTURE(seed, generation, condition);
      CHECK((condition > 1e14) == is_done);
      if (is_done) break;
      std::vector<double> losses;
      for (const Eigen::VectorXd& unit : drawn) {
        losses.push_back(1e12 * std::abs(unit[1] - 0.5) + std::abs(unit[0] - 0.5));
      }
      search.Learn(losses);
      is_done = search.IsDone(kInfinity);
    }
    ended += is_done;
  }
  CHECK(ended == 4);
}

}  // namespace
}  // namespace rift::search
