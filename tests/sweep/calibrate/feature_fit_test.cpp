// A fit by features, round by round: each is the least of a model of drives at values that are
// drawn about the estimate.
#include "sweep/calibrate/feature_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/statistics/random.hpp"
#include "sweep/calibrate/feature_model.hpp"

namespace rift::sweep {
namespace {

using Eigen::Vector2d;

constexpr std::uint64_t kSeed = 4;

/// Mismatch of the motors, something that nothing depends on, and the tracker's noise.
SimulatedTrial Twin(size_t log, const std::vector<double>& values) {
  SimulatedTrial twin{.task = std::vector<control::Waypoint>{{.name = "a"},
                                                             {.name = "b", .x_m = 0.2},
                                                             {.name = "c", .x_m = 0.2, .y_m = 0.1}},
                      .seed = 100 + log};
  twin.simulation.motor.mismatch = values[0];
  twin.simulation.mocap.noise_across_m = values[2];
  return twin;
}

std::vector<CalibrationLog> Logs() {
  std::vector<CalibrationLog> logs;
  for (size_t i = 0; i < 2; ++i) {
    SimulatedTrial robot = Twin(i, {0.03, 0.0, 0.001});
    robot.seed += 7;
    logs.push_back({.name = std::to_string(i), .log = Simulate(robot).result.trajectory});
  }
  logs[1].group = "another";
  return logs;
}

/// As a fit by motions leaves it: of the noise it does not know that it acts.
Calibration Before(double mismatch_prior_sd = 0.0, double noise = 0.0006) {
  Calibration found;
  found.parameters = {
      {.parameter = {.key = "mismatch", .min = -0.1, .max = 0.1, .start = -0.05}, .value = -0.02},
      {.parameter = {.key = "nothing", .max = 2.0}, .value = 0.3, .has_effect = false},
      {.parameter = {.key = "noise", .min = 0.0001, .max = 0.0021, .start = 0.0002},
       .value = noise,
       .has_effect = false}};
  found.parameters[0].parameter.prior_mean = 0.05;
  found.parameters[0].parameter.prior_sd = mismatch_prior_sd;
  found.correlation = Eigen::MatrixXd::Zero(3, 3);
  return found;
}

CalibrationOptions Options(int rounds, int draws) {
  CalibrationOptions options;
  options.features = {.rounds = rounds, .draws = draws, .failures = 0.5};
  options.confidence = 0.8;
  options.identified_share = 0.15;
  return options;
}

Calibration Fitted(Calibration found, const CalibrationOptions& options,
                   const CalibrationStep& on_step = {}) {
  FitFeatures(Logs(), Twin, options, kSeed, 1, on_step, found);
  return found;
}

/// Values of both parameters that act, as shares of their ranges, and all three values at shares.
Vector2d SharesOf(double mismatch, double noise) {
  return {(mismatch + 0.1) / 0.2, (noise - 0.0001) / 0.002};
}
std::vector<double> ValuesOf(const Vector2d& shares) {
  return {-0.1 + 0.2 * shares[0], 0.3, 0.0001 + 0.002 * shares[1]};
}

/// The place within the limits where `loss` is least, by ever smaller steps along each parameter.
Vector2d LeastOf(const std::function<double(const Vector2d&)>& loss, const Vector2d& low,
                 const Vector2d& high) {
  Vector2d best = Vector2d::Zero();
  for (double step = 0.1; step > 1e-6; step *= 0.7) {
    for (int i = 0; i < 60; ++i) {
      const Vector2d before = best;
      for (const Vector2d& by : {Vector2d(step, 0.0), Vector2d(-step, 0.0), Vector2d(0.0, step),
                                 Vector2d(0.0, -step), Vector2d(step, step), Vector2d(step, -step),
                                 Vector2d(-step, step), Vector2d(-step, -step)}) {
        const Vector2d tried = (best + by).cwiseMax(low).cwiseMin(high);
        if (loss(tried) < loss(best)) best = tried;
      }
      if (best == before) break;
    }
  }
  return best;
}

struct Round {
  Vector2d shares, mean, sd;
  double correlation, loss;
  bool is_within;  ///< two scatters of the draws
};

/// What a fit does in its rounds, from its parts.
class Rounds {
 public:
  explicit Rounds(const CalibrationOptions& options, const Calibration& before)
      : options_(options),
        shares_(SharesOf(before.parameters[0].value, before.parameters[2].value)) {
    const double sd = before.parameters[0].parameter.prior_sd;
    if (sd > 0.0) prior_weight_ = std::pow(0.2 / sd, 2);
    for (size_t i = 0; i < logs_.size(); ++i) {
      const Eigen::VectorXd row = FeatureRow(logs_[i].log, Twin(i, ValuesOf(shares_)));
      real_.conservativeResize(static_cast<Eigen::Index>(i) + 1, row.size());
      real_.row(static_cast<Eigen::Index>(i)) = row;
    }
  }

  Round Next(int draws) {
    const Vector2d low = (-shares_.cwiseQuotient(scatter_)).cwiseMax(-2.0);
    const Vector2d high = (Vector2d::Ones() - shares_).cwiseQuotient(scatter_).cwiseMin(2.0);
    Eigen::MatrixXd z(draws, 2);
    std::vector<std::vector<double>> values;
    for (int i = 0; i < draws; ++i) {
      const Vector2d last = drawn_;
      drawn_ = i % 2 == 0 ? Vector2d(random_.Normal(), 0.0) : Vector2d(-last);
      if (i % 2 == 0) drawn_[1] = random_.Normal();
      z.row(i) = drawn_.cwiseMax(low).cwiseMin(high);
      values.push_back(ValuesOf(At(z.row(i))));
    }
    model_.emplace_back(std::vector<std::string>{"", "another"}, real_, z,
                        FeatureModel::Acts::Constant(2, 2, true), Drive(values, round_++, 2),
                        options_.features.failures, 2);
    const FeatureModel& model = model_.back();
    const auto loss = [&](const Vector2d& at) { return model.At(at).loss + PriorLossAt(At(at)); };
    const Vector2d least = LeastOf(loss, low, high);
    Eigen::Matrix2d known = 3.0 * scatter_.cwiseAbs2().asDiagonal();  // where nothing tells
    known(0, 0) += scatter_[0] * scatter_[0] * prior_weight_;
    const Eigen::Matrix2d by_precision = (model.InformationAt(least) + known).inverse();
    const Eigen::Matrix2d inverse =
        by_precision * (model.ScoreCovarianceAt(least) + known) * by_precision;
    Round round{.shares = At(least),
                .sd = scatter_.cwiseProduct(inverse.diagonal().cwiseSqrt()),
                .correlation = inverse(0, 1) / std::sqrt(inverse(0, 0) * inverse(1, 1)),
                .loss = model.At(least).loss / static_cast<double>(model.FeatureCount()),
                .is_within = least.cwiseAbs().maxCoeff() < 2.0};
    for (int k = 0; k < 2; ++k) {
      round.mean[k] = statistics::MeanOfNormalWithin(round.shares[k], round.sd[k], 0.0, 1.0);
    }
    shares_ = round.shares;
    scatter_ = (2.0 * round.sd).cwiseMax(0.02).cwiseMin(0.3);
    return round;
  }

  /// Losses of eight drives of each log there, without each of them in turn after the first.
  std::vector<double> LossesAt(const Vector2d& shares) const {
    const std::vector<FeatureRows> all =
        Drive(std::vector<std::vector<double>>(8, ValuesOf(shares)), round_, 1);
    const FeatureModel& model = model_.back();
    const auto features = static_cast<double>(model.FeatureCount());
    std::vector<double> losses{(model.LossOf(all) + PriorLossAt(shares)) / features};
    for (int i = 0; i < 8; ++i) {
      std::vector<FeatureRows> fewer = all;
      fewer.erase(fewer.begin() + i);
      losses.push_back(model.LossOf(fewer) / features);
    }
    return losses;
  }

 private:
  Vector2d At(const Vector2d& z) const { return shares_ + scatter_.cwiseProduct(z); }
  double PriorLossAt(const Vector2d& shares) const {
    return prior_weight_ * std::pow(shares[0] - 0.75, 2);
  }
  std::vector<FeatureRows> Drive(const std::vector<std::vector<double>>& values, int round,
                                 int alike) const {
    return DriveAt(values, logs_, Twin, static_cast<std::uint64_t>(round), alike, 1);
  }

  CalibrationOptions options_;
  std::vector<CalibrationLog> logs_ = Logs();
  statistics::Random random_{kSeed, 111};
  Eigen::MatrixXd real_;
  Vector2d shares_, scatter_ = Vector2d::Constant(0.15), drawn_ = Vector2d::Zero();
  double prior_weight_ = 0.0;
  int round_ = 0;
  std::vector<FeatureModel> model_;
};

void CheckParameter(const CalibratedParameter& one, const Round& round, int k) {
  CAPTURE(one.parameter.key);
  const double min = one.parameter.min, width = one.parameter.max - min;
  const double reach = 1.2815515655 * round.sd[k];  // the central 0.8 of a normal distribution
  CHECK((one.value - min) / width == Approx(round.mean[k]).margin(1e-4));
  CHECK((one.low - min) / width == Approx(std::max(0.0, round.shares[k] - reach)).margin(1e-4));
  CHECK((one.high - min) / width == Approx(std::min(1.0, round.shares[k] + reach)).margin(1e-4));
  CHECK(one.has_effect);
  CHECK(one.is_identified == (reach <= 0.15));
  CHECK(one.is_at_bound == (round.shares[k] < 1e-9 || round.shares[k] > 1.0 - 1e-9));
}

TEST_CASE(
    "Each round goes to the least loss of drives about the last, the next as far as it errs") {
  for (const double prior_sd : {0.0, 0.00005}) {
    CAPTURE(prior_sd);
    const Calibration before = Before(prior_sd, prior_sd > 0.0 ? 0.0002 : 0.0006);
    CalibrationOptions options = Options(2, 24);
    options.features.last_draws = 28;
    std::vector<CalibrationProgress> told;
    const Calibration found =
        Fitted(before, options, [&told](const CalibrationProgress& one) { told.push_back(one); });
    Rounds rounds(options, before);
    const Round first = rounds.Next(24), last = rounds.Next(28);

    REQUIRE(told.size() == 2);
    for (const auto& [progress, round] : {std::pair(told[0], first), {told[1], last}}) {
      CHECK(progress.part == CalibrationProgress::Part::kFeatures);
      CHECK(progress.most == 2);
      CHECK(progress.loss == Approx(round.loss).epsilon(1e-4));
      REQUIRE(progress.values.size() == 3);
      const Vector2d shares = SharesOf(progress.values[0], progress.values[2]);
      CHECK((shares - round.shares).norm() < 1e-4);
      CHECK(progress.values[1] == 0.3);
    }
    CHECK(told[0].step == 1);
    CHECK(told[1].step == 2);

    CheckParameter(found.parameters[0], last, 0);
    CheckParameter(found.parameters[2], last, 1);
    CHECK(found.parameters[0].is_from_prior == (prior_sd > 0.0));
    CHECK_FALSE(found.parameters[2].is_from_prior);
    CHECK_FALSE(found.parameters[1].has_effect);
    CHECK(found.parameters[1].value == 0.3);
    CHECK(found.correlation(0, 2) == Approx(last.correlation).margin(1e-3));
    CHECK(found.correlation(2, 2) == Approx(1.0));
    for (const int k : {0, 1, 2}) CHECK(std::isnan(found.correlation(1, k)));
    CHECK(found.has_converged == last.is_within);

    const std::vector<double> at_start = rounds.LossesAt(SharesOf(-0.05, 0.0002)),
                              at_end = rounds.LossesAt(last.mean);
    CHECK(found.loss_before == Approx(at_start[0]));
    CHECK(found.loss_after == Approx(at_end[0]).epsilon(1e-3));
    std::vector<double> differences;
    for (size_t i = 1; i < 9; ++i) differences.push_back(at_end[i] - at_start[i]);
    CHECK(found.loss_noise ==
          Approx(7.0 / std::sqrt(8.0) * statistics::StandardDeviation(differences)).epsilon(1e-2));
    // Of each log: one at the estimate, one for each parameter, the draws, and both losses.
    CHECK(found.trials_simulated == 2 * (1 + 3 + 24 + 28 + 8 + 8));
  }
}

TEST_CASE("A fit by features needs twice as many draws as it regresses numbers of a feature") {
  CHECK_THROWS_WITH(Fitted(Before(), Options(1, 9)),
                    "calibrate.method.features.draws is 9, and 2 parameters that act need 10 or "
                    "more");
  // A prior far beyond the range takes the value to its bound ...
  Calibration beyond = Before(0.0005);
  beyond.parameters[0].parameter.prior_mean = 9.0;
  beyond.parameters[0].value = 0.08;
  const Calibration at_bound = Fitted(beyond, Options(1, 10));
  CHECK(at_bound.trials_simulated == 2 * (1 + 3 + 10 + 16));
  CHECK(at_bound.parameters[0].is_at_bound);
  CHECK(at_bound.parameters[0].high == 0.1);
  CHECK(at_bound.has_converged);
  Calibration below = beyond;
  below.parameters[0].parameter.prior_mean = -9.0;
  below.parameters[0].value = -0.08;
  const Calibration at_lower = Fitted(below, Options(1, 10));
  CHECK(at_lower.parameters[0].is_at_bound);
  CHECK(at_lower.parameters[0].low == -0.1);
  CHECK(at_lower.parameters[0].high < 0.1);
  CalibrationOptions options = Options(1, 10);
  options.features.last_draws = 9;  // fewer are none the less
  // ... or as far as a round goes, two scatters of the draws.
  beyond.parameters[0].parameter.prior_mean = -9.0;
  beyond.parameters[0].value = 0.0;
  const Calibration on_the_way = Fitted(beyond, options);
  CHECK(on_the_way.trials_simulated == 2 * (1 + 3 + 10 + 16));
  CHECK(on_the_way.parameters[0].value == Approx(-0.1 + 0.2 * (0.5 - 2.0 * 0.15)).margin(1e-3));
  CHECK_FALSE(on_the_way.parameters[0].is_at_bound);
  CHECK_FALSE(on_the_way.has_converged);
}

TEST_CASE("What drives do not tell is drawn further out, as far as three tenths of its range") {
  Calibration found = Before();
  found.parameters = {found.parameters[1]};
  found.parameters[0].value = 1.0;
  found.parameters[0].has_effect = true;  // on motions
  std::vector<double> asked;
  const TwinAt twin = [&asked](size_t log, const std::vector<double>& values) {
    asked.push_back(values[0]);
    return Twin(log, {0.0, 0.0, 0.001});
  };
  constexpr size_t kDraws = 100, kLogs = 2;
  FitFeatures(Logs(), twin, Options(2, kDraws), kSeed, 1, {}, found);
  // After two drives and one look at each log.
  const auto scatter_of = [&asked](size_t round) {
    std::vector<double> shares;
    for (size_t i = 0; i < kDraws; ++i) {
      shares.push_back(0.5 * asked[3 * kLogs + (round * kDraws + i) * kLogs]);
    }
    return statistics::StandardDeviation(shares);
  };
  CHECK(scatter_of(0) == Approx(0.14).margin(0.02));  // both cut off: two scatters away,
  CHECK(scatter_of(1) == Approx(0.27).margin(0.02));  // and at the ends of the range
}

TEST_CASE("A fit by features of what nothing depends on is what it was") {
  Calibration found = Before();
  found.parameters = {found.parameters[1]};
  std::vector<double> asked;
  const TwinAt twin = [&asked](size_t log, const std::vector<double>& values) {
    asked.push_back(values[0]);
    return Twin(log, {0.0, 0.0, 0.001});
  };
  for (const auto& [value, tried] : {std::pair(0.1, 0.3), {1.9, 1.7}}) {  // a tenth of the range
    asked.clear();
    found.trials_simulated = 0;
    found.parameters[0].value = value;
    FitFeatures(Logs(), twin, Options(1, 12), kSeed, 1, {}, found);
    CHECK(found.parameters[0].value == value);
    CHECK_FALSE(found.parameters[0].has_effect);
    CHECK(found.trials_simulated == 2 * 2);
    REQUIRE(asked.size() == 4);
    for (const size_t log : {0, 2}) {
      CHECK(asked[log] == value);
      CHECK(asked[log + 1] == Approx(tried));
    }
  }
}

TEST_CASE("A parameter acts by the times of a drive, by its places, or by how long it is alone") {
  const auto acts = [](const std::function<void(SimulatedTrial&, double)>& change) {
    const TwinAt twin = [&](size_t log, const std::vector<double>& values) {
      control::ProgramOptions ahead;  // by powers, whatever is seen
      ahead.segments.push_back({.straight_m = 0.1});
      SimulatedTrial one{.task = control::Program(ahead, {}, {}), .seed = 100 + log};
      change(one, values[0]);
      return one;
    };
    Calibration found = Before();
    found.parameters = {found.parameters[1]};
    found.parameters[0].parameter.max = 1.0;
    try {
      FitFeatures(Logs(), twin, Options(1, 1), kSeed, 1, {}, found);
    } catch (const std::invalid_argument&) {
      // One draw is too few for any parameter that acts.
    }
    return found.parameters[0].has_effect;
  };
  CHECK_FALSE(acts([](SimulatedTrial&, double) {}));
  CHECK(acts([](SimulatedTrial& one, double value) {
    one.simulation.mocap.stamp_jitter_s = 0.001 * value;
  }));
  CHECK(acts([](SimulatedTrial& one, double value) {
    one.simulation.mocap.noise_across_m = 0.001 * value;
  }));
  // The rows of the shorter one are those of the longer one.
  CHECK(acts([](SimulatedTrial& one, double value) { one.trial.timeout_s = 0.5 + value; }));
}

TEST_CASE("A value is the prior's where the prior is more than half of what is known of it") {
  std::vector<double> shares;
  for (const double prior_sd : {0.01, 0.02}) {
    const CalibratedParameter one = Fitted(Before(prior_sd), Options(1, 10)).parameters[0];
    REQUIRE(one.low > one.parameter.min);  // none is cut off
    REQUIRE(one.high < one.parameter.max);
    const double sd = 0.5 * (one.high - one.low) / 1.2815515655;
    shares.push_back(std::pow(sd / prior_sd, 2));  // 1 / sd^2 of the prior over that of all
    CAPTURE(prior_sd, shares.back());
    CHECK(one.is_from_prior == (shares.back() > 0.5));
  }
  CHECK((shares[0] > 0.5 && shares[0] < 0.9));
  CHECK((shares[1] > 0.1 && shares[1] < 0.5));
}

TEST_CASE("Features are driven at no values that are not allowed, and the estimate is none") {
  // The logs' noise is 0.001 and their mismatch 0.03, which together are beyond.
  const auto is_allowed = [](const std::vector<double>& values) {
    return values[0] + 50.0 * values[2] <= 0.05;
  };
  const TwinAt twin = [&](size_t log, const std::vector<double>& values) {
    CHECK(is_allowed(values));
    return Twin(log, values);
  };
  Calibration found = Before();
  found.parameters[0].parameter.start = 0.09;  // beyond as well
  FitFeatures(
      Logs(), twin, Options(2, 24), kSeed, 1,
      [&](const CalibrationProgress& one) { CHECK(is_allowed(one.values)); }, found, is_allowed);
  std::vector<double> values;
  for (const CalibratedParameter& one : found.parameters) values.push_back(one.value);
  CHECK(is_allowed(values));
  CHECK(found.parameters[0].has_effect);
  CHECK(found.parameters[2].has_effect);
  CHECK_FALSE(found.parameters[1].has_effect);
}

TEST_CASE("Whether a parameter acts is tried to its other side, or nearer, where that is allowed") {
  // From `value` of [1, 3] a tenth of the range to the middle, else to both sides, ever nearer.
  const auto tried = [](double value, double least, double most) {
    double asked = 0.0;
    const TwinAt twin = [&asked](size_t log, const std::vector<double>& values) {
      asked = values[0];
      return Twin(log, {0.0, 0.0, 0.001});
    };
    Calibration found = Before();
    found.parameters = {found.parameters[1]};
    found.parameters[0].parameter.min = 1.0;
    found.parameters[0].parameter.max = 3.0;
    found.parameters[0].value = value;
    std::vector<CalibrationLog> logs = Logs();
    logs.resize(1);
    FitFeatures(logs, twin, Options(1, 12), kSeed, 1, {}, found,
                [=](const std::vector<double>& at) { return at[0] >= least && at[0] <= most; });
    return asked;
  };
  CHECK(tried(1.5, 0.0, 9.0) == Approx(1.7));
  CHECK(tried(1.5, 0.0, 1.6) == Approx(1.3));
  CHECK(tried(1.1, 0.0, 1.25) == Approx(1.0));  // 0.9 is none
  CHECK(tried(2.9, 2.75, 9.0) == Approx(2.8));  // 3.1 is none
  CHECK(tried(2.9, 2.85, 9.0) == Approx(3.0));
  CHECK(tried(2.5, 2.46, 2.53) == Approx(2.475));
  CHECK(tried(2.5, 2.5, 2.5) == 2.5);
}

}  // namespace
}  // namespace rift::sweep
