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

/// Every way to draw as many of a pool: sums of their hessians and of their gradients.
Set AllDraws(const Set& pool, size_t count) {
  const Index n = pool.front().gradient.size();
  Set draws{{MatrixXd::Zero(n, n), VectorXd::Zero(n)}};
  for (size_t i = 0; i < count; ++i) {
    Set more;
    for (const Told& drawn : draws) {
      for (const Told& one : pool) {
        more.push_back({drawn.hessian + one.hessian, drawn.gradient + one.gradient});
      }
    }
    draws = std::move(more);
  }
  return draws;
}

/// Estimates about the one that was judged, a row each; `simulated`: none for a fit without.
MatrixXd Estimates(const Set& logs, const Set& corrected_by, const Set& real, const Set& simulated,
                   const VectorXd& of_prior) {
  VectorXd mean = SumOf(logs) + of_prior;
  const auto share = static_cast<double>(logs.size()) /
                     static_cast<double>(std::max<size_t>(1, corrected_by.size()));
  Set made{{MatrixXd(), VectorXd::Zero(mean.size())}};
  if (!corrected_by.empty()) {
    mean -= share * SumOf(corrected_by);
    made = AllDraws(simulated, corrected_by.size());
  }
  const Set drawn = AllDraws(real, logs.size());
  MatrixXd rows(static_cast<Index>(drawn.size() * made.size()), mean.size());
  Index row = 0;
  for (const Told& one : drawn) {
    const MatrixXd inverse = one.hessian.inverse();
    for (const Told& other : made) {
      rows.row(row++) = -inverse * (mean + one.gradient - share * other.gradient);
    }
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

TEST_CASE("Logs that tell a parameter unequally well scatter its estimate by how well they do") {
  // Half of the draws hold both, a quarter each one of them twice.
  const Set logs = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const double one = -(2.0 + 2.0 * std::sqrt(2.0) * 2.0) / 1200.0,
               other = -(2.0 - 2.0 * std::sqrt(2.0) * 2.0) / 400.0;
  const Calibration found = Judged(Middle(), logs, {}, NoPrior(1));
  CHECK(Half(found.parameters[0]) ==
        Approx(0.5 * (other - one) * kOneDegree / kNormal).epsilon(1e-6));
  CHECK(ReachOf(Estimates(logs, {}, Pooled({logs}), {}, VectorXd::Zero(1)).col(0)) ==
        Approx(0.5 * (other - one)));
}

TEST_CASE("Of the logs alone, and of logs and all simulated ones together, the wider counts") {
  struct Case {
    Set logs, first, last;
    bool is_together;  ///< which is the wider
  };
  const Set plain = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const std::vector<Case> cases{
      {plain, Scalars({{500.0, 9.0}, {300.0, -9.0}}),
       Scalars({{400.0, 1.0}, {450.0, 6.0}, {350.0, 2.0}}), true},
      {plain, Scalars({{500.0, 0.1}, {600.0, 0.2}}),
       Scalars({{400.0, 2.0}, {450.0, 2.1}, {500.0, 2.2}}), false},
      {Scalars({{600.0, 30.0}, {200.0, 26.0}}), Scalars({{500.0, 1.0}, {600.0, 1.1}}),
       Scalars({{400.0, 16.0}, {450.0, 19.0}, {500.0, 25.0}}), false}};
  for (const Case& one : cases) {
    CAPTURE(&one - cases.data());
    const VectorXd none = VectorXd::Zero(1);
    const Set real = Pooled({one.logs}), made = Pooled({one.last}),
              all = Pooled({one.logs, one.first, one.last});
    const double apart = ReachOf(Estimates(one.logs, one.last, real, made, none).col(0)),
                 together = ReachOf(Estimates(one.logs, one.last, all, all, none).col(0));
    CAPTURE(apart, together);
    REQUIRE((together > 1.1 * apart) == one.is_together);
    REQUIRE((apart > 1.1 * together) != one.is_together);
    const Calibration found = Judged(Middle(), one.logs, {one.first, one.last}, NoPrior(1), 20'000);
    CHECK(Half(found.parameters[0]) ==
          Approx(std::max(apart, together) * kOneDegree / kNormal).epsilon(0.03));
  }
}

TEST_CASE("A prior pulls with its slope in every draw, and its own scatter comes on top") {
  // So weak that it hardly scatters, so far off that it pulls: 0.0001 * (0.5 - 30000.5).
  const Set logs = Scalars({{600.0, 3.0}, {200.0, -1.0}});
  const Prior far{VectorXd::Constant(1, 30000.5), VectorXd::Constant(1, 1e-4)};
  const double reach =
      ReachOf(Estimates(logs, {}, Pooled({logs}), {}, VectorXd::Constant(1, -3.0)).col(0));
  CHECK(Half(Judged(Middle(), logs, {}, far).parameters[0]) ==
        Approx(reach * kOneDegree / kNormal).epsilon(0.02));

  // Logs that agree tell the estimate without scatter: what is left is the prior's.
  const Set same = Scalars({{30.0, 0.2}, {30.0, 0.2}});
  const Prior near{VectorXd::Constant(1, 0.4), VectorXd::Constant(1, 90.0)};
  CHECK(Half(Judged(Middle(), same, {}, near, 20'000).parameters[0]) ==
        Approx(std::sqrt(90.0) / (60.0 + 90.0) * kOneDegree).epsilon(0.03));
}

TEST_CASE("The interval of a single log is as wide as that of one degree of freedom") {
  // One log has no scatter of its own: what is left is the prior's.
  const Prior near{VectorXd::Constant(1, 0.4), VectorXd::Constant(1, 90.0)};
  CHECK(Half(Judged(Middle(), Scalars({{30.0, 0.2}}), {}, near, 20'000).parameters[0]) ==
        Approx(std::sqrt(90.0) / (30.0 + 90.0) * kOneDegree).epsilon(0.03));
}

TEST_CASE("Correlations are of the central draws, of which no outlier has the say") {
  // Three logs; the second parameter is told by the first log alone, and 8 of 27 draws are without.
  Set logs;
  for (const auto& [second, a, b] :
       {std::tuple(8.0, 1.0, 2.0), {0.05, -2.0, 0.3}, {0.05, 1.5, -0.4}}) {
    Eigen::Matrix2d hessian;
    hessian << 5.0, 0.2, 0.2, second;
    logs.push_back({hessian, Eigen::Vector2d(a, b)});
  }
  MatrixXd draws = Estimates(logs, {}, Pooled({logs}), {}, VectorXd::Zero(2));
  const auto correlation = [&draws] {
    const MatrixXd centred = draws.rowwise() - draws.colwise().mean();
    return centred.col(0).dot(centred.col(1)) / (centred.col(0).norm() * centred.col(1).norm());
  };
  const double of_all = correlation();
  for (Index k = 0; k < 2; ++k) {
    const auto [low, high] =
        statistics::CentralInterval({draws.col(k).begin(), draws.col(k).end()}, kConfidence);
    draws.col(k) = draws.col(k).cwiseMax(low).cwiseMin(high);
  }
  CAPTURE(of_all);
  REQUIRE(std::abs(correlation() - of_all) > 0.1);
  const Calibration found = Judged(Eigen::Vector2d(0.5, 0.5), logs, {}, NoPrior(2), 20'000);
  CHECK(found.correlation(0, 1) == Approx(correlation()).margin(0.03));
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
