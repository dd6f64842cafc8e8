// The steps of a fit, one by one: over which values slopes are read, how steps are damped, and what
// is told on the way.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "sweep/calibrate/fitted_simulator.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Predicts the x of each pose of a log by a law of one parameter, and writes down what it is
/// asked.
class OneLaw : public FittedSimulator {
 public:
  using Law = std::function<double(double)>;

  explicit OneLaw(Law law) : law_(std::move(law)) {}

  std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                     const std::vector<double>& values,
                                     const CalibrationOptions& options) override {
    asked.push_back({values[0], options.runs});
    std::vector<LogPrediction> predictions;
    for (const CalibrationLog& log : logs) {
      LogPrediction& one = predictions.emplace_back();
      const auto rows = static_cast<Eigen::Index>(log.log.poses.size());
      one.motions = Eigen::VectorXd::Zero(3 * rows);
      for (Eigen::Index i = 0; i < rows; ++i) {
        one.motions[3 * i] = law_(values[0]) - log.log.poses[static_cast<size_t>(i)].x_m;
        one.frames.push_back(1);
      }
      if (trait && options.runs > 0) {
        one.mean_traits = Eigen::Vector4d(0.0, trait(values[0]), 0.0, 0.0);
      }
    }
    return predictions;
  }
  std::vector<Trajectory> LogsAt(const std::vector<CalibrationLog>&, const std::vector<double>&,
                                 int) override {
    return {};
  }
  Traits TraitsOf(const Trajectory& path, size_t, const std::vector<double>&) const override {
    if (!trait) return {};
    return Eigen::Vector4d(0.0, path.poses.front().yaw_rad, 0.0, 0.0);
  }
  bool HasWholeRunsOnly() const override { return whole_runs_only; }

  /// How far apart slopes were read, each once, in that order: two neighbours, the upper one first.
  /// The last prediction is that of the start, for its loss.
  std::vector<double> Ways(int runs = 0) const {
    std::vector<double> ways;
    for (size_t i = 1; i + 1 < asked.size(); ++i) {
      const double way = asked[i - 1].first - asked[i].first;
      const bool is_slope = asked[i].second == runs && asked[i - 1].second == runs && way > 0.0;
      if (is_slope && (ways.empty() || std::abs(ways.back() - way) > 1e-9)) ways.push_back(way);
    }
    return ways;
  }

  Law trait;
  bool whole_runs_only = false;
  std::vector<std::pair<double, int>> asked;  ///< value and runs of each prediction

 private:
  Law law_;
};

double Itself(double value) { return value; }

/// Two logs of four rows about `x`, each `spread` to either side; traits as far from `trait`.
std::vector<CalibrationLog> TwoLogs(double x, double spread = 0.01, double trait = 0.0) {
  std::vector<CalibrationLog> logs;
  for (const double side : {1.0, -1.0}) {
    CalibrationLog& log = logs.emplace_back();
    log.name = log.setting = side > 0.0 ? "1" : "2";
    for (const int i : {0, 1, 2, 3}) {
      log.log.poses.push_back({.t_s = 0.1 * i,
                               .x_m = x + (i % 2 == 0 ? spread : -spread),
                               .yaw_rad = trait + 0.01 * side});
    }
  }
  return logs;
}

CalibrationOptions Options() {
  CalibrationOptions options;
  options.horizon.most_frames = 1;
  options.runs = 0;
  options.corrections = 0;
  options.simulated_logs = 0;
  options.outlier_sd = 1e6;
  options.resamples = 200;
  return options;
}

struct Fitted {
  Calibration fit;
  std::vector<CalibrationProgress> told;
};

Fitted FitFrom(double start, OneLaw& simulator, const std::vector<CalibrationLog>& logs,
               const CalibrationOptions& options, experiment::FreeParameter parameter = {}) {
  parameter.key = "a";
  parameter.start = start;
  std::mt19937_64 generator(3);
  Fitted fitted;
  fitted.fit = Calibrate({parameter}, logs, simulator, options, generator,
                         [&fitted](const CalibrationProgress& one) { fitted.told.push_back(one); });
  return fitted;
}

void CheckWays(const std::vector<double>& ways, const std::vector<double>& expected) {
  REQUIRE(ways.size() == expected.size());
  for (size_t i = 0; i < ways.size(); ++i) CHECK(ways[i] == Approx(expected[i]));
}

/// `expected` first; then those of the search along the parameter, whose last one slopes have.
void CheckWaysOfSearch(const std::vector<double>& ways, const std::vector<double>& expected) {
  REQUIRE(ways.size() > expected.size());
  CheckWays({ways.begin(), ways.begin() + static_cast<std::ptrdiff_t>(expected.size())}, expected);
  CHECK(ways[expected.size()] == Approx(0.1));  // from where it stands to the first it looks at
  CHECK(ways.back() == Approx(0.04));
}

TEST_CASE("Slopes are read over the first step, then over half of the last, at the end over one") {
  CalibrationOptions options = Options();
  options.first_step = 0.4;
  options.step = 0.15;
  OneLaw simulator(Itself);
  const Fitted fitted = FitFrom(0.5, simulator, TwoLogs(0.52), options);
  CHECK(fitted.fit.has_converged);
  CheckWaysOfSearch(simulator.Ways(), {0.8, 0.4, 0.3});

  // A first step below the last is none.
  options.first_step = 0.05;
  OneLaw other(Itself);
  FitFrom(0.5, other, TwoLogs(0.52), options);
  CheckWaysOfSearch(other.Ways(), {0.3});

  // Corrections are at the end, also of a descent that was cut short, which is not searched.
  options.first_step = 0.4;
  options.iterations = 1;
  options.corrections = 1;
  OneLaw cut(Itself);
  CHECK_FALSE(FitFrom(0.5, cut, TwoLogs(0.52), options).fit.has_converged);
  CheckWays(cut.Ways(), {0.8, 0.3});
}

TEST_CASE("Slopes of runs are read over a fifth of the range to either side, or more") {
  CalibrationOptions options = Options();
  options.runs = 2;
  for (const double step : {0.1, 0.3}) {
    options.first_step = options.step = step;
    OneLaw simulator(Itself);
    simulator.trait = Itself;
    FitFrom(0.5, simulator, TwoLogs(0.5, 0.01, 0.5), options);
    CheckWays(simulator.Ways(0), {2.0 * step});
    CheckWays(simulator.Ways(2), {std::max(0.4, 2.0 * step)});
  }
}

TEST_CASE("No value beyond the range is ever asked for") {
  for (const double target : {-0.3, 0.02, 0.97, 1.4}) {
    for (const double start : {0.0, 0.05, 1.0}) {
      OneLaw simulator(Itself);
      FitFrom(start, simulator, TwoLogs(target), Options());
      REQUIRE(simulator.asked.size() > 4);
      for (const auto& [value, runs] : simulator.asked) {
        CHECK((value >= 0.0 && value <= 1.0));
      }
    }
  }
}

TEST_CASE("Steps are damped a tenth as much after each that helps") {
  OneLaw simulator(Itself);
  const Fitted fitted = FitFrom(0.0, simulator, TwoLogs(0.99), Options());
  REQUIRE(fitted.told.size() == 2);
  const double left = 0.99 * 0.01 / 1.01;
  CHECK(fitted.told[0].values[0] == Approx(0.99 - left).margin(1e-8));
  CHECK(fitted.told[1].values[0] == Approx(0.99 - left * 0.001 / 1.001).margin(1e-8));
  CHECK(fitted.told[1].step == 2);
}

TEST_CASE("A step below half a hundredth of the range is none") {
  for (const auto& [off, steps] : {std::pair(0.0052, 1), {0.0049, 0}}) {
    for (const double side : {1.0, -1.0}) {
      OneLaw simulator(Itself);
      const Calibration fit = FitFrom(0.5, simulator, TwoLogs(0.5 + side * off), Options()).fit;
      CHECK(fit.steps == steps);
      CHECK(fit.has_converged);
    }
  }
}

TEST_CASE("A step that makes it worse is tried again with ten times the damping") {
  // Ever so flat where it starts, steep behind: a whole step is far too long.
  OneLaw bent([](double v) { return v < 0.5 ? 0.1 * v : 0.05 + 10.0 * (v - 0.5); });
  CalibrationOptions options = Options();
  options.first_step = options.step = 0.01;
  options.iterations = 1;
  const Fitted fitted = FitFrom(0.3, bent, TwoLogs(0.55), options);
  REQUIRE(fitted.told.size() == 1);
  CHECK(fitted.told[0].values[0] == Approx(0.3 + 5.2 / 101.0).margin(1e-4));
}

TEST_CASE("What a long slope leads astray a shorter one finds, damped anew") {
  // Rising between 0.3 and 0.7, where 0.6 is meant; over 0.1 to 0.9 it seems to fall.
  OneLaw folded([](double v) {
    return v > 0.7 ? 0.7 - 3.0 * (v - 0.7) : v < 0.3 ? 0.3 + 3.0 * (0.3 - v) : v;
  });
  CalibrationOptions options = Options();
  options.first_step = 0.4;
  options.step = 0.1;
  const Calibration fit = FitFrom(0.5, folded, TwoLogs(0.6, 0.001), options).fit;
  CHECK(fit.parameters[0].value == Approx(0.6).margin(0.005));
  CHECK(fit.has_converged);
}

TEST_CASE("Whole runs go to their motions first, then to traits as well, with steps of their own") {
  OneLaw simulator(Itself);
  simulator.whole_runs_only = true;
  simulator.trait = Itself;
  CalibrationOptions options = Options();
  options.runs = 2;
  options.likeness_weight = 9.0;
  options.first_step = 0.3;
  options.step = 0.1;
  options.iterations = 1;
  // Motions say 0.5; traits, which scatter by 0.01 sqrt(2), say 0.8.
  const Fitted fitted = FitFrom(0.0, simulator, TwoLogs(0.5, 0.2, 0.8), options);
  REQUIRE(fitted.told.size() == 2);
  CHECK(fitted.told[0].part == CalibrationProgress::Part::kMotions);
  CHECK(fitted.told[1].part == CalibrationProgress::Part::kDescent);
  for (const CalibrationProgress& one : fitted.told) {
    CHECK(one.step == 1);
    CHECK(one.most == 1);
  }
  CHECK(fitted.fit.steps == 2);
  const double by_motions = 0.5 / 1.01;
  CHECK(fitted.told[0].values[0] == Approx(by_motions).margin(1e-6));
  CheckWays(simulator.Ways(2), {0.3, 0.2});  // from 0 on above alone
  const double motions = 8.0 / std::pow(0.2, 2), traits = 9.0 * 2.0 / 0.0002;
  const double target = (motions * 0.5 + traits * 0.8) / (motions + traits);
  CHECK(fitted.told[1].values[0] == Approx(by_motions + (target - by_motions) / 1.01).margin(1e-4));
}

TEST_CASE("A fit whose motions come to rest and whose traits run out of steps has not converged") {
  OneLaw simulator(Itself);
  simulator.whole_runs_only = true;
  simulator.trait = Itself;
  CalibrationOptions options = Options();
  options.runs = 2;
  options.first_step = options.step = 0.1;
  options.iterations = 1;
  const Fitted fitted = FitFrom(0.5, simulator, TwoLogs(0.5, 0.2, 0.8), options);
  REQUIRE(fitted.told.size() == 1);
  CHECK(fitted.told[0].part == CalibrationProgress::Part::kDescent);
  CHECK_FALSE(fitted.fit.has_converged);
}

TEST_CASE("Losses are means over all errors, in standard deviations, and priors belong to them") {
  OneLaw simulator(Itself);
  CalibrationOptions options = Options();
  const experiment::FreeParameter a{.prior_mean = 0.7, .prior_sd = 0.1};
  const Fitted fitted = FitFrom(0.3, simulator, TwoLogs(0.5, 0.02), options, a);
  const double value = fitted.fit.parameters[0].value;
  // Of each log four rows of three channels, and five traits that nothing tells.
  constexpr double kErrors = 2.0 * (4.0 * 3.0 + 5.0);
  const auto squares = [](double at) {
    return 4.0 * (std::pow(at - 0.52, 2) + std::pow(at - 0.48, 2));
  };
  const auto scale = [&](double at) { return std::sqrt(squares(at) / 8.0); };
  REQUIRE_FALSE(fitted.told.empty());
  CHECK(fitted.told[0].loss == Approx(squares(0.3) / std::pow(scale(0.3), 2) / kErrors));
  const auto loss = [&](double at) {
    return (squares(at) / std::pow(scale(value), 2) + std::pow((at - 0.7) / 0.1, 2)) / kErrors;
  };
  CHECK(fitted.fit.loss_after == Approx(loss(value)));
  CHECK(fitted.fit.loss_before == Approx(loss(0.3)));
}

TEST_CASE("A descent ends where logs and prior pull alike, from either of both") {
  const experiment::FreeParameter a{.prior_mean = 0.9, .prior_sd = 0.05};
  for (const double start : {0.5, 0.9}) {
    OneLaw simulator(Itself);
    const double value =
        FitFrom(start, simulator, TwoLogs(0.5, 0.2), Options(), a).fit.parameters[0].value;
    // 8 x / s^2 = (0.4 - x) / sd^2 for x = value - 0.5, and s^2 = x^2 + 0.2^2: x = 0.3573.
    CHECK(value == Approx(0.8573).margin(0.005));
  }
}

TEST_CASE("An interval is told by the slopes at the end, also of a fit that takes one step") {
  OneLaw square([](double v) { return v * v; });
  CalibrationOptions options = Options();
  options.iterations = 1;
  std::vector<CalibrationLog> logs;
  for (const double y : {0.21, 0.21, 0.29, 0.29}) {
    logs.push_back(TwoLogs(y).front());
    logs.back().setting = std::to_string(logs.size());
  }
  options.resamples = 4000;
  const CalibratedParameter one = FitFrom(0.8, square, logs, options).fit.parameters[0];
  const double end = 0.8 - (0.64 - 0.25) / 1.6 / 1.01;
  REQUIRE(one.value == Approx(end).margin(1e-3));
  const double half = 0.04 * std::sqrt(4.0 / 3.0) * 3.18244630528 / 1.95996398454;
  CHECK(0.5 * (one.high - one.low) == Approx(half / (2.0 * end)).epsilon(0.02));
}

TEST_CASE("A step that takes the value further from its prior than the logs ask for is shortened") {
  // Rising to 0.31 and flat behind: whatever lies beyond tells no more, and costs by the prior.
  OneLaw flat_behind([](double v) { return 0.1 * std::min(v, 0.31); });
  CalibrationOptions options = Options();
  options.first_step = options.step = 0.005;
  options.iterations = 1;
  const double weight = 8.0 / std::pow(0.12, 2);  // of eight rows, 0.12 off each
  const experiment::FreeParameter a{.prior_mean = 0.3, .prior_sd = 1.0 / std::sqrt(0.01 * weight)};
  const Fitted fitted = FitFrom(0.3, flat_behind, TwoLogs(0.15, 0.0), options, a);
  REQUIRE(fitted.told.size() == 1);
  // Undamped it would go by 0.6, and half of it is too far as well.
  CHECK(fitted.told[0].values[0] == Approx(0.3 + 0.6 / 11.0).margin(1e-3));
}

TEST_CASE("A fit asks for nothing beyond what is allowed, and ends where that does") {
  constexpr double kLimit = 0.6;
  const IsAllowed is_allowed = [](const std::vector<double>& values) {
    return values[0] <= kLimit;
  };
  for (const double start : {0.1, 0.6, 0.9}) {  // within, at the end, beyond
    INFO(start);
    OneLaw simulator(Itself);
    std::mt19937_64 generator(3);
    const experiment::FreeParameter parameter{.key = "a", .start = start};
    CalibrationOptions options = Options();
    options.corrections = 1;
    const Calibration fit =
        Calibrate({parameter}, TwoLogs(0.8), simulator, options, generator, {}, is_allowed);
    for (const auto& [value, runs] : simulator.asked) CHECK(value <= kLimit);
    CHECK(fit.parameters[0].value == Approx(kLimit).margin(2e-2));
    CHECK(fit.parameters[0].value <= kLimit);
    CHECK(fit.parameters[0].has_effect);
    CHECK(fit.has_converged);
  }
}

TEST_CASE("Two values bound by a rule end where it does, though both alone would go beyond") {
  // The first log tells the sum of both, the second one their difference.
  struct SumAndDifference : public OneLaw {
    SumAndDifference() : OneLaw(Itself) {}
    std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                       const std::vector<double>& values,
                                       const CalibrationOptions&) override {
      if (values[0] > values[1]) ++broken;
      std::vector<LogPrediction> predictions(logs.size());
      for (size_t i = 0; i < logs.size(); ++i) {
        const double told = i == 0 ? values[0] + values[1] : values[0] - values[1];
        const auto rows = static_cast<Eigen::Index>(logs[i].log.poses.size());
        predictions[i].motions = Eigen::VectorXd::Zero(3 * rows);
        for (Eigen::Index row = 0; row < rows; ++row) {
          predictions[i].motions[3 * row] = told - logs[i].log.poses[static_cast<size_t>(row)].x_m;
        }
        predictions[i].frames.assign(static_cast<size_t>(rows), 1);
      }
      return predictions;
    }
    int broken = 0;
  } simulator;
  std::vector<CalibrationLog> logs = TwoLogs(1.1);  // 0.7 and 0.4: the first is to be at most
  for (auto& pose : logs[1].log.poses) pose.x_m -= 0.8;
  std::mt19937_64 generator(3);
  const std::vector<experiment::FreeParameter> parameters{{.key = "a", .start = 0.2},
                                                          {.key = "b", .start = 0.2}};
  const Calibration fit =
      Calibrate(parameters, logs, simulator, Options(), generator, {},
                [](const std::vector<double>& values) { return values[0] <= values[1]; });
  CHECK(simulator.broken == 0);
  CHECK(fit.parameters[0].value <= fit.parameters[1].value);
  CHECK(fit.parameters[0].value == Approx(0.55).margin(0.15));
  CHECK(fit.parameters[1].value == Approx(0.55).margin(0.15));
}

}  // namespace
}  // namespace rift::sweep
