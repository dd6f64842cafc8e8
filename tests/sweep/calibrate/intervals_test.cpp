// The intervals of a fit beside every draw of its logs, each as often as the bootstrap draws it.
#include "sweep/calibrate/intervals.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kConfidence = 0.8;
constexpr double kNormal = 1.28155156554;                                  // its quantile at 0.9
constexpr double kOneDegree = 3.07768353718, kTwoDegrees = 1.88561808316;  // Student's

/// One log: how its errors answer the parameters.
struct Told {
  MatrixXd hessian;
  VectorXd gradient;
};
using Set = std::vector<Told>;

Set Scalars(const std::vector<std::pair<double, double>>& hessians_and_gradients) {
  Set set;
  for (const auto& [hessian, gradient] : hessians_and_gradients) {
    set.push_back({MatrixXd::Constant(1, 1, hessian), VectorXd::Constant(1, gradient)});
  }
  return set;
}

Linearised Of(const Set& set) {
  Linearised logs;
  for (const Told& one : set) {
    logs.hessians.push_back(one.hessian);
    logs.gradients.push_back(one.gradient);
  }
  return logs;
}

VectorXd SumOf(const Set& set) {
  VectorXd sum = VectorXd::Zero(set.front().gradient.size());
  for (const Told& one : set) sum += one.gradient;
  return sum;
}

/// All sets together, each about its own mean, as much wider as a small sample is too narrow.
Set Pooled(const std::vector<Set>& sets) {
  Set pool;
  for (const Set& set : sets) {
    const auto n = static_cast<double>(set.size());
    for (const Told& one : set) {
      pool.push_back({one.hessian, std::sqrt(n / (n - 1.0)) * (one.gradient - SumOf(set) / n)});
    }
  }
  return pool;
}

/// Every way to draw as many of a pool: sums of their gradients, a row each.
MatrixXd AllDraws(const Set& pool, size_t count) {
  MatrixXd draws = MatrixXd::Zero(1, pool.front().gradient.size());
  for (size_t i = 0; i < count; ++i) {
    MatrixXd more(draws.rows() * static_cast<Index>(pool.size()), draws.cols());
    Index row = 0;
    for (const auto& drawn : draws.rowwise()) {
      for (const Told& one : pool) more.row(row++) = drawn + one.gradient.transpose();
    }
    draws = std::move(more);
  }
  return draws;
}

/// Of as many logs as `logs`, by what those of the pool are on average.
MatrixXd HessianOf(const Set& logs, const Set& pool) {
  MatrixXd sum = MatrixXd::Zero(pool.front().hessian.rows(), pool.front().hessian.rows());
  for (const Told& one : pool) sum += one.hessian;
  return sum * static_cast<double>(logs.size()) / static_cast<double>(pool.size());
}

/// Estimates about the one that was judged, a row each; `simulated`: none for a fit without.
MatrixXd Estimates(const Set& logs, const Set& corrected_by, const Set& real,
                   const Set& simulated) {
  const MatrixXd drawn = AllDraws(real, logs.size());
  MatrixXd made = MatrixXd::Zero(1, drawn.cols());
  if (!corrected_by.empty()) {
    made = AllDraws(simulated, corrected_by.size()) * static_cast<double>(logs.size()) /
           static_cast<double>(corrected_by.size());
  }
  const MatrixXd inverse = HessianOf(logs, real).inverse();
  MatrixXd rows(drawn.rows() * made.rows(), drawn.cols());
  Index row = 0;
  for (const auto& one : drawn.rowwise()) {
    for (const auto& other : made.rowwise()) rows.row(row++) = -(one - other) * inverse;
  }
  return rows;
}

double ReachOf(const VectorXd& of_draws) {
  const VectorXd estimates = of_draws.replicate(of_draws.size() < 100 ? 100 : 1, 1);
  const auto [low, high] =
      statistics::CentralInterval({estimates.begin(), estimates.end()}, kConfidence);
  return 0.5 * (high - low);
}

Prior NoPrior(Index parameters) { return {VectorXd::Zero(parameters), VectorXd::Zero(parameters)}; }

Calibration Judged(const VectorXd& estimate, const Set& logs, const std::vector<Set>& simulated,
                   const Prior& prior, int resamples = 4000) {
  std::vector<experiment::FreeParameter> parameters(static_cast<size_t>(estimate.size()),
                                                    {.key = "p", .min = -1000.0, .max = 1000.0});
  CalibrationOptions options;
  options.confidence = kConfidence;
  options.resamples = resamples;
  std::vector<Linearised> made;
  for (const Set& set : simulated) made.push_back(Of(set));
  std::mt19937_64 generator(7);
  Calibration result;
  Judge(parameters, options, estimate, Of(logs), made, prior, generator, result);
  return result;
}

/// Half the interval, as a share of the range.
double Half(const CalibratedParameter& one) { return 0.5 * (one.high - one.low) / 2000.0; }

VectorXd Middle() { return VectorXd::Constant(1, 0.5); }

TEST_CASE("Every draw has what all logs tell together, whichever of them it holds") {
  // Half of the draws hold both, a quarter each one of them twice.
  const Set logs = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const Calibration found = Judged(Middle(), logs, {}, NoPrior(1));
  const double reach = 2.0 * std::sqrt(2.0) * 2.0 / 800.0;
  CHECK(Half(found.parameters[0]) == Approx(reach * kOneDegree / kNormal).epsilon(1e-6));
  CHECK(ReachOf(Estimates(logs, {}, Pooled({logs}), {}).col(0)) == Approx(reach));
}

TEST_CASE("A parameter that one log of four tells is known as well as that log knows it") {
  // 81 of 256 draws are without the first log, which nearly all is known from.
  constexpr double kThreeDegrees = 1.63774435369;
  Set logs;
  for (const auto& [second, a, b] :
       {std::tuple(8.0, 1.0, 0.4), {1e-4, -2.0, 0.006}, {1e-4, 1.5, -0.008}, {0.0, 0.7, 0.0}}) {
    Eigen::Matrix2d hessian;
    hessian << 5.0, 0.0, 0.0, second;
    logs.push_back({hessian, Eigen::Vector2d(a, b)});
  }
  const MatrixXd draws = Estimates(logs, {}, Pooled({logs}), {});
  const Calibration found = Judged(Eigen::Vector2d(0.5, 0.5), logs, {}, NoPrior(2), 20'000);
  // Four logs tell the first parameter equally well, and one the second.
  for (const auto& [k, student] : {std::pair(0, kThreeDegrees), {1, kOneDegree}}) {
    CAPTURE(k);
    CHECK(Half(found.parameters[static_cast<size_t>(k)]) ==
          Approx(ReachOf(draws.col(k)) * student / kNormal).epsilon(0.03));
  }
  CHECK(ReachOf(draws.col(1)) < 2.0 * 0.4 / 8.0);
}

TEST_CASE("Of the logs alone, and of logs and all simulated ones together, the wider counts") {
  struct Case {
    Set logs, first, last;
    bool is_together;  ///< which is the wider
  };
  const Set plain = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const std::vector<Case> cases{{plain, Scalars({{500.0, 9.0}, {300.0, -9.0}}),
                                 Scalars({{400.0, 1.0}, {450.0, 6.0}, {350.0, 2.0}}), true},
                                {plain, Scalars({{500.0, 0.1}, {600.0, 0.2}}),
                                 Scalars({{400.0, 2.0}, {450.0, 2.1}, {500.0, 2.2}}), false}};
  for (const Case& one : cases) {
    CAPTURE(&one - cases.data());
    const Set real = Pooled({one.logs}), made = Pooled({one.last}),
              all = Pooled({one.logs, one.first, one.last});
    const double apart = ReachOf(Estimates(one.logs, one.last, real, made).col(0)),
                 together = ReachOf(Estimates(one.logs, one.last, all, all).col(0));
    CAPTURE(apart, together);
    REQUIRE((together > 1.1 * apart) == one.is_together);
    REQUIRE((apart > 1.1 * together) != one.is_together);
    const Calibration found = Judged(Middle(), one.logs, {one.first, one.last}, NoPrior(1), 20'000);
    CHECK(Half(found.parameters[0]) ==
          Approx(std::max(apart, together) * kOneDegree / kNormal).epsilon(0.03));
  }
}

TEST_CASE("A prior's own scatter comes on top, wherever its mean stands") {
  // So weak that it hardly scatters, so far off that it pulls: 0.0001 * (0.5 - 30000.5).
  const Set logs = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const Prior far{VectorXd::Constant(1, 30000.5), VectorXd::Constant(1, 1e-4)};
  CHECK(Half(Judged(Middle(), logs, {}, far).parameters[0]) ==
        Approx(Half(Judged(Middle(), logs, {}, NoPrior(1)).parameters[0])).epsilon(0.02));

  // Logs that agree tell the estimate without scatter: what is left is the prior's. Two logs have
  // one degree of freedom, of 0.4 of the variance: 1 / 0.4^2 = 6.25.
  constexpr double kSixDegrees = 1.43272246226;
  const Set same = Scalars({{30.0, 0.2}, {30.0, 0.2}});
  const Prior near{VectorXd::Constant(1, 0.4), VectorXd::Constant(1, 90.0)};
  CHECK(Half(Judged(Middle(), same, {}, near, 20'000).parameters[0]) ==
        Approx(std::sqrt(90.0) / (60.0 + 90.0) * kSixDegrees).epsilon(0.03));
}

TEST_CASE(
    "A prior of three parts in four of what is known makes sixteen degrees of one log's one") {
  // One log has no scatter of its own: what is left is the prior's.
  constexpr double kSixteenDegrees = 1.33675716733;
  const Prior near{VectorXd::Constant(1, 0.4), VectorXd::Constant(1, 90.0)};
  CHECK(Half(Judged(Middle(), Scalars({{30.0, 0.2}}), {}, near, 20'000).parameters[0]) ==
        Approx(std::sqrt(90.0) / (30.0 + 90.0) * kSixteenDegrees).epsilon(0.03));
}

TEST_CASE("Correlations are those of the draws") {
  Set logs;
  for (const auto& [second, a, b] :
       {std::tuple(8.0, 1.0, 2.0), {0.05, -2.0, 0.3}, {0.05, 1.5, -0.4}}) {
    Eigen::Matrix2d hessian;
    hessian << 5.0, 0.2, 0.2, second;
    logs.push_back({hessian, Eigen::Vector2d(a, b)});
  }
  const MatrixXd draws = Estimates(logs, {}, Pooled({logs}), {});
  const MatrixXd centred = draws.rowwise() - draws.colwise().mean();
  const double correlation =
      centred.col(0).dot(centred.col(1)) / (centred.col(0).norm() * centred.col(1).norm());
  const Calibration found = Judged(Eigen::Vector2d(0.5, 0.5), logs, {}, NoPrior(2), 20'000);
  CHECK(found.correlation(0, 1) == Approx(correlation).margin(0.03));
  CHECK(found.correlation(1, 0) == found.correlation(0, 1));
  CHECK(found.correlation(0, 0) == Approx(1.0));
  CHECK(Half(found.parameters[0]) ==
        Approx(ReachOf(draws.col(0)) * kTwoDegrees / kNormal).epsilon(0.05));
}

TEST_CASE("A parameter is at its bound on either side, where the logs tell it") {
  Set logs = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  for (const double bound : {0.0, 1.0}) {
    const VectorXd estimate = VectorXd::Constant(1, bound);
    CHECK(Judged(estimate, logs, {}, NoPrior(1)).parameters[0].is_at_bound);
    CHECK_FALSE(Judged(Middle(), logs, {}, NoPrior(1)).parameters[0].is_at_bound);
    const Set silent = Scalars({{0.0, 0.0}, {0.0, 0.0}});
    const CalibratedParameter none = Judged(estimate, silent, {}, NoPrior(1)).parameters[0];
    CHECK_FALSE(none.is_at_bound);
    CHECK_FALSE(none.is_from_prior);
    CHECK_FALSE(none.is_identified);
  }
}

}  // namespace
}  // namespace rift::sweep
