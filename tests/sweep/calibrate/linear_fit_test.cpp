// A fit of simulators whose errors are straight lines: what it must find is in any textbook.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "support/inputs/paths.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"
#include "sweep/calibrate/model.hpp"

namespace rift::sweep {
namespace {

using experiment::FreeParameter;
using trajectory::Trajectory;

/// A log holds measurements: y0 as x and y1 as y of each pose, the logged trait as the first yaw.
/// Channel 0 predicts y0 by `first`, channel 1 predicts y1 by `second`.
class Lines : public FittedSimulator {
 public:
  using Law = std::function<double(const std::vector<double>& values)>;

  Lines(Law first, Law second) : first_(std::move(first)), second_(std::move(second)) {}

  std::vector<LogPrediction> Predict(const std::vector<CalibrationLog>& logs,
                                     const std::vector<double>& values,
                                     const CalibrationOptions&) override {
    std::vector<LogPrediction> predictions;
    for (const CalibrationLog& log : logs) {
      LogPrediction one;
      const auto rows = static_cast<Eigen::Index>(log.log.poses.size());
      one.motions = Eigen::VectorXd::Zero(3 * rows);
      for (Eigen::Index i = 0; i < rows; ++i) {
        const trajectory::StampedPose& pose = log.log.poses[static_cast<size_t>(i)];
        one.motions[3 * i] = first_(values) + offset - pose.x_m;
        one.motions[3 * i + 1] = second_(values) - pose.y_m;
        one.frames.push_back(1);
      }
      if (trait) one.mean_traits = Eigen::Vector4d(0.0, trait(values), 0.0, 0.0);
      predictions.push_back(std::move(one));
    }
    return predictions;
  }
  std::vector<Trajectory> LogsAt(const std::vector<CalibrationLog>& logs,
                                 const std::vector<double>& values, int repeat) override {
    repeats.push_back(repeat);
    std::vector<Trajectory> made;
    for (const CalibrationLog& log : logs) {
      Trajectory& one = made.emplace_back(log.log);
      for (size_t i = 0; i < one.poses.size(); ++i) {  // noise that cancels
        one.poses[i].x_m = first_(values) + (i % 2 == 0 ? 0.01 : -0.01);
        one.poses[i].y_m = second_(values) + (i % 4 < 2 ? 0.01 : -0.01);
      }
    }
    return made;
  }
  Traits TraitsOf(const Trajectory& path, size_t, const std::vector<double>&) const override {
    if (!trait) return {};
    return Eigen::Vector4d(0.0, path.poses.front().yaw_rad, 0.0, 0.0);
  }
  bool HasWholeRunsOnly() const override { return whole_runs_only; }

  double offset = 0.0;  ///< of every prediction, of real and of simulated logs alike
  Law trait;
  bool whole_runs_only = false;
  std::vector<int> repeats;

 private:
  Law first_, second_;
};

/// Four rows about (y0, y1), each `spread` to either side, so that the medians are that.
CalibrationLog Log(const std::string& name, double y0, double y1, double spread = 0.01,
                   double trait = 0.0) {
  CalibrationLog log{.name = name, .setting = name};
  for (const int i : {0, 1, 2, 3}) {
    log.log.poses.push_back({.t_s = 0.1 * i,
                             .x_m = y0 + (i % 2 == 0 ? spread : -spread),
                             .y_m = y1 + (i < 2 ? spread : -spread),
                             .yaw_rad = trait});
  }
  return log;
}

double A(const std::vector<double>& values) { return values[0]; }
double B(const std::vector<double>& values) { return values[1]; }
double Nothing(const std::vector<double>&) { return 0.0; }

/// Plain least squares of motions alone, with steps that end where they should.
CalibrationOptions LeastSquares() {
  CalibrationOptions options;
  options.horizon.most_frames = 1;
  options.runs = 0;
  options.corrections = 4;
  options.simulated_logs = 0;
  options.outlier_sd = 1e6;
  options.resamples = 4000;
  return options;
}

Calibration FitOf(const std::vector<FreeParameter>& parameters,
                  const std::vector<CalibrationLog>& logs, FittedSimulator& simulator,
                  const CalibrationOptions& options = LeastSquares(),
                  const CalibrationStep& on_step = {}) {
  std::mt19937_64 generator(3);
  return Calibrate(parameters, logs, simulator, options, generator, on_step);
}

const FreeParameter kA{.key = "a", .min = -1.0, .max = 3.0, .start = 2.5};
const FreeParameter kB{.key = "b", .min = 10.0, .max = 12.0, .start = 10.1};

/// Means 0.5 and 11.2; both vary independently, by +-0.04 and +-0.02.
std::vector<CalibrationLog> FourLogs() {
  return {Log("1", 0.46, 11.18), Log("2", 0.46, 11.22), Log("3", 0.54, 11.18),
          Log("4", 0.54, 11.22)};
}

TEST_CASE("Whole runs are fitted to the mean also where a step is many times their scatter") {
  Lines simulator(A, B);
  simulator.whole_runs_only = true;
  CalibrationOptions options = LeastSquares();
  options.outlier_sd = 3.0;  // a step changes the first prediction by 10 and the second by 20
  options.step = 0.1;
  options.corrections = GENERATE(0, 1, 4);
  options.simulated_logs = GENERATE(0, 4);
  const Calibration fit = FitOf({kA, kB}, FourLogs(), simulator, options);
  const CalibratedParameter &a = fit.parameters[0], &b = fit.parameters[1];
  CHECK(a.value == Approx(0.5).margin(1e-4));
  CHECK(b.value == Approx(11.2).margin(1e-4));
  // Student's 97.5 % quantile of three degrees, times the deviation of a mean of four.
  CHECK(0.5 * (a.high - a.low) == Approx(3.18 * 0.04 / std::sqrt(3.0)).epsilon(0.2));
  CHECK(0.5 * (b.high - b.low) == Approx(3.18 * 0.02 / std::sqrt(3.0)).epsilon(0.2));
}

TEST_CASE("A straight line is fitted by the mean of what it predicts, in the units of its range") {
  Lines simulator(A, B);
  const Calibration fit = FitOf({kA, kB}, FourLogs(), simulator);
  REQUIRE(fit.parameters.size() == 2);
  CHECK(fit.parameters[0].value == Approx(0.5).margin(1e-6));
  CHECK(fit.parameters[1].value == Approx(11.2).margin(1e-6));
  CHECK(fit.parameters[0].parameter.key == "a");
  CHECK(fit.parameters[1].parameter.key == "b");
  CHECK(fit.has_converged);
  CHECK(fit.steps >= 1);
  CHECK_FALSE(fit.IsWorseThanStart());
  CHECK(fit.loss_before > 10.0 * fit.loss_after);
  for (const CalibratedParameter& one : fit.parameters) {
    CHECK(one.has_effect);
    CHECK(one.is_identified);
    CHECK_FALSE(one.is_at_bound);
    CHECK_FALSE(one.is_from_prior);
  }
}

TEST_CASE("An interval is the bootstrap's with Student's quantile, and unlike things are apart") {
  Lines simulator(A, B);
  const Calibration fit = FitOf({kA, kB}, FourLogs(), simulator);
  // Four logs +-0.04 about their mean, drawn anew: one draw in sixteen has all four on one side.
  // A sample of four varies less about its own mean (4 / 3), and tells its scatter badly (Student).
  const double half_a = 0.04 * std::sqrt(4.0 / 3.0) * 3.18244630528 / 1.95996398454;
  CHECK(fit.parameters[0].high - fit.parameters[0].value == Approx(half_a).epsilon(1e-3));
  CHECK(fit.parameters[0].value - fit.parameters[0].low == Approx(half_a).epsilon(1e-3));
  CHECK(fit.parameters[1].high - fit.parameters[1].value == Approx(half_a / 2.0).epsilon(1e-3));
  CHECK(fit.correlation(0, 0) == Approx(1.0));
  CHECK(fit.correlation(1, 1) == Approx(1.0));
  CHECK(fit.correlation(0, 1) == Approx(0.0).margin(0.06));
}

TEST_CASE("A smaller confidence makes a narrower interval") {
  Lines simulator(A, B);
  CalibrationOptions options = LeastSquares();
  options.confidence = 0.8;
  const Calibration fit = FitOf({kA, kB}, FourLogs(), simulator, options);
  // One draw in four has three logs on one side and one on the other: half as far.
  const double half = 0.02 * std::sqrt(4.0 / 3.0) * 1.63774435369 / 1.28155156554;
  CHECK(fit.parameters[0].high - fit.parameters[0].value == Approx(half).epsilon(1e-3));
}

TEST_CASE("Estimates from a sum and one of its terms go against each other") {
  // a = y1, b = y0 - y1, where y0 and y1 scatter independently and alike: -1 / sqrt(2).
  Lines simulator([](const auto& v) { return v[0] + v[1]; }, A);
  const std::vector<CalibrationLog> logs{Log("1", 11.46, 0.46), Log("2", 11.46, 0.54),
                                         Log("3", 11.54, 0.46), Log("4", 11.54, 0.54)};
  const Calibration fit = FitOf({kA, kB}, logs, simulator);
  CHECK(fit.parameters[0].value == Approx(0.5).margin(1e-4));
  CHECK(fit.parameters[1].value == Approx(11.0).margin(1e-4));
  CHECK(fit.correlation(0, 1) == Approx(-1.0 / std::sqrt(2.0)).margin(0.06));
  CHECK(fit.correlation(1, 0) == fit.correlation(0, 1));
}

TEST_CASE("What lies beyond the range ends at its bound, below and above") {
  for (const bool is_above : {false, true}) {
    Lines simulator(A, B);
    std::vector<CalibrationLog> logs;
    for (const double offset : {-0.02, 0.02}) {
      logs.push_back(Log(std::to_string(offset), (is_above ? 3.5 : -1.5) + offset, 11.0 + offset));
    }
    const Calibration fit = FitOf({kA, kB}, logs, simulator);
    const CalibratedParameter &a = fit.parameters[0], &b = fit.parameters[1];
    CHECK(a.value == Approx(is_above ? 3.0 : -1.0).margin(1e-9));
    CHECK(a.is_at_bound);
    CHECK(a.low >= -1.0);
    CHECK(a.high <= 3.0);
    CHECK((is_above ? a.high : a.low) == a.value);
    CHECK(b.value == Approx(11.0).margin(1e-6));  // the bound stops the other no more
    CHECK_FALSE(b.is_at_bound);
  }
}

TEST_CASE("A parameter without effect keeps its start and the whole of its range") {
  Lines simulator(A, Nothing);
  std::vector<CalibrationLog> logs = FourLogs();
  const Calibration fit = FitOf({kA, kB}, logs, simulator);
  const CalibratedParameter& b = fit.parameters[1];
  CHECK(b.value == Approx(kB.start));
  CHECK_FALSE(b.has_effect);
  CHECK_FALSE(b.is_identified);
  CHECK_FALSE(b.is_at_bound);
  CHECK(b.low == kB.min);
  CHECK(b.high == kB.max);
  CHECK(std::isnan(fit.correlation(0, 1)));
  CHECK(std::isnan(fit.correlation(1, 0)));
  CHECK(std::isnan(fit.correlation(1, 1)));
  CHECK(fit.correlation(0, 0) == Approx(1.0));
  CHECK(fit.parameters[0].value == Approx(0.5).margin(1e-6));
}

TEST_CASE(
    "An interval that reaches beyond the share of the range that is asked for tells too little") {
  Lines simulator(A, B);
  CalibrationOptions options = LeastSquares();
  // The half width of a is 0.0750 of a range of 4: a share of 0.01875.
  options.identified_share = 0.0188;
  CHECK(FitOf({kA, kB}, FourLogs(), simulator, options).parameters[0].is_identified);
  options.identified_share = 0.0187;
  CHECK_FALSE(FitOf({kA, kB}, FourLogs(), simulator, options).parameters[0].is_identified);
}

TEST_CASE("A prior weighs as its precision beside that of the errors") {
  FreeParameter a = kA;
  a.prior_mean = 0.9;
  a.prior_sd = 0.005;
  Lines simulator(A, B);
  std::vector<CalibrationLog> logs{Log("1", 0.5, 11.2), Log("2", 0.5, 11.2)};
  const Calibration fit = FitOf({a, kB}, logs, simulator);
  // Errors of channel 0 count over their root mean square, of rows 0.01 to either side ...
  const double value = fit.parameters[0].value;
  CHECK(value > 0.5);
  CHECK(value < 0.9);
  // ... whatever that is, the fit stands where both pull alike: 8 (a - 0.5) / s^2 = (0.9 - a) /
  // sd^2
  const double scale_squared = 8.0 * (value - 0.5) * a.prior_sd * a.prior_sd / (0.9 - value);
  const double scale = std::sqrt(scale_squared);
  CHECK(scale >= 0.0099);
  CHECK(scale <= 0.41);
  CHECK(scale == Approx(std::hypot(0.01, value - 0.5)).epsilon(0.02));
  CHECK(fit.parameters[1].value == Approx(11.2).margin(1e-6));
}

TEST_CASE("A parameter that only its prior tells stands at its mean with the prior's interval") {
  FreeParameter b = kB;
  b.prior_mean = 11.5;
  b.prior_sd = 0.1;
  Lines simulator(A, Nothing);
  const Calibration fit = FitOf({kA, b}, FourLogs(), simulator);
  const CalibratedParameter& one = fit.parameters[1];
  CHECK(one.value == Approx(11.5).margin(1e-3));
  CHECK(one.is_from_prior);
  CHECK_FALSE(one.has_effect);
  CHECK(one.is_identified);
  CHECK(one.high - one.value == Approx(1.95996398454 * 0.1).epsilon(0.08));
  CHECK_FALSE(fit.parameters[0].is_from_prior);
}

/// Out of line: GCC 12 takes numbers that are there for not initialised otherwise.
[[gnu::noinline]] double LossOf(const Prior& prior, const Eigen::VectorXd& shares) {
  return prior.LossAt(shares);
}

TEST_CASE("Priors and shares are told in the range: mean, weight, loss, slope") {
  const Prior prior = PriorOf(
      {kA, {.key = "p", .min = 2.0, .max = 6.0, .start = 3.0, .prior_mean = 3.0, .prior_sd = 0.5}});
  CHECK(prior.weight[0] == 0.0);
  CHECK(prior.mean[1] == Approx(0.25));
  CHECK(prior.weight[1] == Approx(64.0));
  const Eigen::Vector2d at(0.7, 0.5);
  CHECK(LossOf(prior, at) == Approx(64.0 * 0.0625));
  CHECK(prior.GradientAt(at)[0] == 0.0);
  CHECK(prior.GradientAt(at)[1] == Approx(16.0));
  CHECK(prior.Hessian()(1, 1) == Approx(64.0));
  CHECK(prior.Hessian()(0, 1) == 0.0);
  const std::vector<double> values = ValuesAt({kA, kB}, Eigen::Vector2d(0.25, 1.0));
  CHECK(values[0] == Approx(0.0));
  CHECK(values[1] == Approx(12.0));
  CHECK(SquaredSum({Eigen::Vector2d(1.0, 2.0), Eigen::Vector3d(3.0, 0.0, 1.0)}) == 15.0);
  CHECK(Count({Eigen::Vector2d(1.0, 2.0), Eigen::Vector3d(3.0, 0.0, 1.0)}) == 5);
  CHECK(Sum(std::vector<double>{1.0, 2.5, 4.0}) == 7.5);
  CHECK(RidgeOf(Eigen::Matrix2d::Identity() * 3.0) == Approx(4e-9));
}

TEST_CASE("What biases real and simulated logs alike is taken out by the corrections") {
  Lines biased(A, B);
  biased.offset = 0.03;
  CalibrationOptions options = LeastSquares();
  CHECK(FitOf({kA, kB}, FourLogs(), biased, options).parameters[0].value ==
        Approx(0.47).margin(1e-5));
  CHECK(biased.repeats.empty());
  options.simulated_logs = 9;  // three of each of the four
  const Calibration fit = FitOf({kA, kB}, FourLogs(), biased, options);
  CHECK(fit.parameters[0].value == Approx(0.5).margin(1e-4));
  CHECK(fit.parameters[1].value == Approx(11.2).margin(1e-4));
  CHECK(biased.repeats == std::vector<int>{0, 1, 2, 0, 1, 2, 0, 1, 2, 0, 1, 2});
  biased.repeats.clear();
  options.simulated_logs = 8;
  options.corrections = 1;
  FitOf({kA, kB}, FourLogs(), biased, options);
  CHECK(biased.repeats == std::vector<int>{0, 1});
}

/// Its simulated logs are beside what it predicts for them.
class Off : public Lines {
 public:
  using Lines::Lines;
  std::vector<Trajectory> LogsAt(const std::vector<CalibrationLog>& real,
                                 const std::vector<double>& values, int repeat) override {
    std::vector<Trajectory> made = Lines::LogsAt(real, values, repeat);
    for (Trajectory& one : made) {
      for (auto& pose : one.poses) pose.x_m += by;
    }
    return made;
  }
  double by = 0.0;
};

TEST_CASE("A correction goes as far as errors follow their slopes, not across a leap") {
  CalibrationOptions options = LeastSquares();
  options.corrections = 1;
  options.simulated_logs = 4;
  options.first_step = 0.2;
  options.step = 0.005;
  FreeParameter a = kA;
  a.start = 0.5;
  const std::vector<CalibrationLog> logs{Log("1", 0.5, 11.0, 0.2), Log("2", 0.5, 11.0, 0.2)};
  for (const double leap : {0.0, 5.0}) {
    Off off([leap](const std::vector<double>& v) { return v[0] + (v[0] > 0.57 ? leap : 0.0); }, B);
    off.by = -0.1;
    const double value = FitOf({a, kB}, logs, off, options).parameters[0].value;
    if (leap == 0.0) CHECK(value == Approx(0.6).margin(0.003));
    if (leap > 0.0) CHECK(value == Approx(0.55).margin(0.003));  // half of the step
  }
}

TEST_CASE("A correction goes no further than the first step to either side") {
  for (const bool is_above : {false, true}) {
    Lines simulator(A, B);
    CalibrationOptions options = LeastSquares();
    options.corrections = 1;
    options.simulated_logs = 4;
    options.first_step = options.step = 0.05;
    const double target = is_above ? 2.0 : -0.5;
    std::vector<CalibrationLog> logs{Log("1", target, 11.0), Log("2", target, 11.0)};
    // Simulated logs are off by half the range: the correction would go as far.
    Off off(A, B);
    off.by = is_above ? -1.0 : 1.0;
    const double before = FitOf({kA, kB}, logs, simulator, options).parameters[0].value;
    const double moved = FitOf({kA, kB}, logs, off, options).parameters[0].value;
    CHECK(std::abs(moved - target) == Approx(0.05 * 4.0).margin(0.03));
    CHECK(before == Approx(target).margin(0.03));
  }
}

TEST_CASE("Traits of runs pull with their weight over their scatter among the logs") {
  for (const double weight : {1.0, 9.0}) {
    Lines simulator(A, B);
    simulator.trait = A;
    CalibrationOptions options = LeastSquares();
    options.runs = 1;
    options.likeness_weight = weight;
    // Motions say 0.5; traits say 0.56 with a standard deviation of 0.02 * sqrt(2) of two logs.
    std::vector<CalibrationLog> logs{Log("1", 0.5, 11.2, 0.1, 0.54),
                                     Log("2", 0.5, 11.2, 0.1, 0.58)};
    const double value = FitOf({kA, kB}, logs, simulator, options).parameters[0].value;
    const double motions = 8.0 / (0.1 * 0.1 + std::pow(value - 0.5, 2));
    const double traits = weight * 2.0 / 0.0008;
    CHECK(value == Approx((motions * 0.5 + traits * 0.56) / (motions + traits)).margin(2e-4));
  }
}

TEST_CASE("Whole runs descend by their motions first, and all of them tell how far they are") {
  for (const bool whole : {false, true}) {
    Lines simulator(A, B);
    simulator.whole_runs_only = whole;
    CalibrationOptions options = LeastSquares();
    options.iterations = 7;
    options.corrections = 2;
    std::vector<CalibrationProgress> told;
    const Calibration fit = FitOf({kA, kB}, FourLogs(), simulator, options,
                                  [&](const CalibrationProgress& one) { told.push_back(one); });
    using Part = CalibrationProgress::Part;
    REQUIRE(told.size() >= 3);
    CHECK((told.front().part == Part::kMotions) == whole);
    CHECK(told.front().step == 1);
    CHECK(told.front().most == 7);
    for (const CalibrationProgress& one : told) {
      CHECK(one.values.size() == 2);
      CHECK(one.values[0] >= kA.min);
      CHECK(one.values[0] <= kA.max);
      CHECK(one.values[1] >= kB.min);
      CHECK(one.values[1] <= kB.max);
    }
    const CalibrationProgress &last = told.back(), &before = told[told.size() - 2];
    CHECK(last.part == Part::kCorrection);
    CHECK(last.step == 2);
    CHECK(last.most == 2);
    CHECK(before.part == Part::kCorrection);
    CHECK(before.step == 1);
    CHECK(last.values[0] == Approx(fit.parameters[0].value));
    CHECK(last.values[1] == Approx(fit.parameters[1].value));
    CHECK(fit.steps == static_cast<int>(told.size()) - 2);
  }
}

TEST_CASE("The first step of a straight line is damped by a hundredth, and told with its loss") {
  Lines simulator(A, B);
  std::vector<CalibrationProgress> told;
  FitOf({kA, kB}, FourLogs(), simulator, LeastSquares(),
        [&](const CalibrationProgress& one) { told.push_back(one); });
  CHECK(told[0].values[0] == Approx(0.5 + (2.5 - 0.5) * 0.01 / 1.01).margin(1e-6));
  CHECK(told[0].values[1] == Approx(11.2 + (10.1 - 11.2) * 0.01 / 1.01).margin(1e-6));
}

TEST_CASE("Every prediction of a log counts its replays and its runs") {
  Lines simulator(A, B);
  CalibrationOptions options = LeastSquares();
  options.horizon.phases = 3;
  options.corrections = 0;
  const size_t few = FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated;
  CHECK(few % (4 * 3) == 0);
  options.horizon.phases = 6;
  CHECK(FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated == 2 * few);
  // Two of each log, predicted once and on both sides of each parameter.
  options.corrections = 1;
  const size_t real = FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated;
  options.simulated_logs = 8;
  CHECK(FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated ==
        real + 2 * 4 * 6 * (1 + 2 * 2));
  // Runs are predicted with the motions, and their slopes by themselves beside one replay.
  options.runs = 2;
  const size_t with_runs = FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated;
  options.simulated_logs = 0;
  CHECK(with_runs == FitOf({kA, kB}, FourLogs(), simulator, options).trials_simulated +
                         2 * 4 * ((6 + 2) + 2 * 2 * 6 + 2 * 2 * (1 + 2)));
}

TEST_CASE("Fits without parameters, with one log, or that start beyond their range are refused") {
  Lines simulator(A, B);
  CHECK_THROWS_WITH(FitOf({}, FourLogs(), simulator), "a calibration needs a free parameter");
  CHECK_THROWS_WITH(FitOf({kA, kB}, {FourLogs()[0]}, simulator),
                    "a calibration needs at least 2 logs, and there are 1");
  FreeParameter a = kA;
  const auto refusal = [&](double start) {
    a.start = start;
    try {
      FitOf({kB, a}, FourLogs(), simulator);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  CHECK(refusal(3.1) == "a starts at 3.1, but it must lie in its range [-1, 3]");
  CHECK(refusal(-1.5) == "a starts at -1.5, but it must lie in its range [-1, 3]");
  CHECK(refusal(3.0) == "accepted");
  CHECK(refusal(-1.0) == "accepted");
  a.max = a.min;
  CHECK(refusal(-1.0).starts_with("a starts at -1"));
}

Calibration Found(double value, double low, double high) {
  Calibration fit;
  fit.parameters = {{.value = value, .low = low, .high = high}};
  return fit;
}

TEST_CASE("Fits from several starts agree within 0.3 of half the first one's interval") {
  CHECK(AgreementOf({}).empty());
  CHECK(AgreementOf({Found(1.0, 0.0, 2.0)}).empty());
  const auto agreement = [](double second, double third) {
    return AgreementOf({Found(1.0, 0.0, 4.0), Found(second, 0.0, 100.0), Found(third, 0.9, 1.0)})
        .at(0);
  };
  CHECK(agreement(1.2, 0.8).values == std::vector<double>{1.0, 1.2, 0.8});
  CHECK(agreement(1.2, 0.8).difference == Approx(0.2));
  CHECK(agreement(1.2, 0.8).agrees);
  CHECK(agreement(1.3, 0.72).difference == Approx(0.29));
  CHECK(agreement(1.3, 0.72).agrees);
  CHECK_FALSE(agreement(1.3, 0.68).agrees);
  CHECK(agreement(1.0, 1.0).difference == 0.0);
  CHECK_FALSE(AgreementOf({Found(1.0, 1.0, 1.0), Found(1.1, 1.0, 1.0)})[0].agrees);
  CHECK(AgreementOf({Found(1.0, 1.0, 1.0), Found(1.0, 1.0, 1.0)})[0].agrees);
}

}  // namespace
}  // namespace rift::sweep
