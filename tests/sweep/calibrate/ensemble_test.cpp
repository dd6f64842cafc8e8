#include "rift/sweep/calibrate/ensemble.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

constexpr double kConfidence = 0.95;
constexpr double kReach = 1.959964;  // of a normal distribution at that confidence, in deviations

CalibratedParameter Parameter(const std::string& key, double value, double sd) {
  return {.parameter = {.key = key, .min = value - 1.0, .max = value + 1.0},
          .value = value,
          .low = value - kReach * sd,
          .high = value + kReach * sd};
}

std::vector<double> Column(const experiment::Ensemble& ensemble, size_t column) {
  std::vector<double> values;
  for (const std::vector<double>& draw : ensemble.draws) values.push_back(draw[column]);
  return values;
}

/// Three parameters, of which the first and the last go together.
Calibration Fit() {
  Calibration fit;
  fit.parameters = {Parameter("a", 3.0, 0.1), Parameter("b", -2.0, 0.05), Parameter("c", 0.5, 0.2)};
  fit.correlation = Eigen::MatrixXd::Identity(3, 3);
  fit.correlation(0, 2) = fit.correlation(2, 0) = -0.8;
  return fit;
}

TEST_CASE("The draws of an ensemble have the values, deviations and correlations of the fit") {
  const experiment::Ensemble ensemble = EnsembleOf(Fit(), kConfidence, 4000, 1);
  REQUIRE(ensemble.keys == std::vector<std::string>{"a", "b", "c"});
  REQUIRE(ensemble.draws.size() == 4000);
  const std::vector<double> a = Column(ensemble, 0), b = Column(ensemble, 1),
                            c = Column(ensemble, 2);
  CHECK(statistics::Mean(a) == Approx(3.0).margin(0.006));
  CHECK(statistics::Mean(c) == Approx(0.5).margin(0.012));
  CHECK(statistics::StandardDeviation(a) == Approx(0.1).epsilon(0.05));
  CHECK(statistics::StandardDeviation(b) == Approx(0.05).epsilon(0.05));
  CHECK(statistics::StandardDeviation(c) == Approx(0.2).epsilon(0.05));
  double with_c = 0.0, with_b = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    with_c += (a[i] - 3.0) * (c[i] - 0.5) / (0.1 * 0.2);
    with_b += (a[i] - 3.0) * (b[i] + 2.0) / (0.1 * 0.05);
  }
  CHECK(with_c / 4000.0 == Approx(-0.8).margin(0.05));
  CHECK(with_b / 4000.0 == Approx(0.0).margin(0.05));
}

TEST_CASE("No draw lies beyond the range of its parameter") {
  Calibration fit = Fit();
  fit.parameters[0].parameter.max = 3.02;  // a fifth of a deviation above the value
  fit.parameters[1].parameter.min = -2.0;  // at its bound
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 500, 1);
  for (const double a : Column(ensemble, 0)) CHECK((a >= 2.0 && a <= 3.02));
  for (const double b : Column(ensemble, 1)) CHECK((b >= -2.0 && b <= -1.0));

  // What lies beyond is folded back, as a path between mirrors.
  const experiment::Ensemble free = EnsembleOf(Fit(), kConfidence, 500, 1);
  const std::vector<double> a = Column(ensemble, 0), b = Column(ensemble, 1),
                            free_a = Column(free, 0), free_b = Column(free, 1);
  for (size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i] == Approx(3.02 - std::abs(3.02 - free_a[i])));
    CHECK(b[i] == Approx(-2.0 + std::abs(free_b[i] + 2.0)));
  }
}

TEST_CASE("Near a bound, where the interval ends, draws scatter as they would without it") {
  const bool is_low = GENERATE(true, false);
  Calibration fit = Fit();
  CalibratedParameter &at = fit.parameters[0], &near = fit.parameters[1];
  if (is_low) {
    at.low = at.parameter.min = at.value;
    near.low = near.parameter.min = near.value - 0.02;
  } else {
    at.high = at.parameter.max = at.value;
    near.high = near.parameter.max = near.value + 0.02;
  }
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 200, 1);
  const experiment::Ensemble free = EnsembleOf(Fit(), kConfidence, 200, 1);
  const double side = is_low ? 1.0 : -1.0;
  for (size_t i = 0; i < 200; ++i) {
    CHECK(ensemble.draws[i][0] == Approx(3.0 + side * std::abs(free.draws[i][0] - 3.0)));
    const double bound = -2.0 - side * 0.02;
    CHECK(ensemble.draws[i][1] == Approx(bound + side * std::abs(free.draws[i][1] - bound)));
  }
}

TEST_CASE("A parameter that logs and prior leave open stays out of the ensemble") {
  Calibration fit = Fit();
  fit.parameters[0].has_effect = false;
  fit.correlation.row(0).setConstant(std::nan(""));
  fit.correlation.col(0).setConstant(std::nan(""));
  fit.parameters[1].is_identified = false;
  CHECK(EnsembleOf(fit, kConfidence, 5, 1).keys == std::vector<std::string>{"c"});
  fit.parameters[1].is_from_prior = true;
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 5, 1);
  CHECK(ensemble.keys == std::vector<std::string>{"b", "c"});
  for (const double b : Column(ensemble, 0)) CHECK(b == Approx(-2.0).margin(0.3));
}

TEST_CASE("The same seed gives the same ensemble, another seed another one, none gives none") {
  CHECK(EnsembleOf(Fit(), kConfidence, 5, 1).draws == EnsembleOf(Fit(), kConfidence, 5, 1).draws);
  CHECK(EnsembleOf(Fit(), kConfidence, 5, 1).draws != EnsembleOf(Fit(), kConfidence, 5, 2).draws);
  CHECK(EnsembleOf(Fit(), kConfidence, 0, 1).IsEmpty());
}

TEST_CASE("A seed gives the same ensemble in every version of rift") {
  Calibration fit = Fit();
  fit.correlation = Eigen::MatrixXd::Identity(3, 3);
  const statistics::CounterRandom random(7, 91);
  const double values[] = {3.0, -2.0, 0.5}, deviations[] = {0.1, 0.05, 0.2};
  const auto expected = [&](size_t row, size_t attempt, size_t k) {
    return values[k] + deviations[k] * random.Normal(row, 2 * (3 * attempt + k));
  };
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 4, 7);
  // Its third draw is the first that is allowed of each row.
  int asked = 0;
  const experiment::Ensemble third = EnsembleOf(
      fit, kConfidence, 4, 7, [&asked](const std::vector<double>&) { return ++asked % 3 == 0; });
  for (size_t row = 0; row < 4; ++row) {
    for (size_t k = 0; k < 3; ++k) {
      CHECK(ensemble.draws[row][k] == Approx(expected(row, 0, k)).epsilon(1e-6));
      CHECK(third.draws[row][k] == Approx(expected(row, 2, k)).epsilon(1e-6));
    }
  }
}

TEST_CASE("A row is drawn a thousand times before the fitted values take its place") {
  int asked = 0;
  const auto allowed_at = [&asked](int attempt) {
    asked = 0;
    return EnsembleOf(Fit(), kConfidence, 1, 1,
                      [&asked, attempt](const std::vector<double>&) { return ++asked == attempt; })
        .draws[0];
  };
  const std::vector<double> fitted{3.0, -2.0, 0.5};
  CHECK(allowed_at(1000) != fitted);
  CHECK(allowed_at(1001) == fitted);
  CHECK(asked == 1000);
}

TEST_CASE("Draws of parameters that do not go together tell nothing of each other") {
  Calibration fit = Fit();
  fit.parameters.pop_back();
  fit.correlation = Eigen::MatrixXd::Identity(2, 2);
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 40'000, 1);
  double products = 0.0, squares = 0.0;
  for (const std::vector<double>& draw : ensemble.draws) {
    const double a = (draw[0] - 3.0) / 0.1, b = (draw[1] + 2.0) / 0.05;
    products += a * b / 40'000.0;
    squares += a * a * b * b / 40'000.0;
  }
  CHECK(products == Approx(0.0).margin(0.02));
  CHECK(squares == Approx(1.0).margin(0.06));  // nor by how far they are off
}

TEST_CASE("A draw of values that are not allowed is drawn again, and the others stay") {
  Calibration fit = Fit();
  fit.parameters[1].has_effect = false;  // asked about with its fitted value
  const auto is_allowed = [](const std::vector<double>& values) {
    CHECK(values[1] == -2.0);
    return values[0] >= 6.0 * values[2] - 0.1;
  };
  const experiment::Ensemble any = EnsembleOf(fit, kConfidence, 200, 1),
                             allowed = EnsembleOf(fit, kConfidence, 200, 1, is_allowed);
  REQUIRE(allowed.draws.size() == 200);
  size_t kept = 0;
  for (size_t i = 0; i < 200; ++i) {
    const std::vector<double>& draw = allowed.draws[i];
    CHECK(draw[0] >= 6.0 * draw[1] - 0.1);
    const bool is_kept = any.draws[i][0] >= 6.0 * any.draws[i][1] - 0.1;
    kept += is_kept;
    CHECK((draw == any.draws[i]) == is_kept);
  }
  CHECK((kept > 80 && kept < 140));
  CHECK(EnsembleOf(fit, kConfidence, 200, 1, is_allowed).draws == allowed.draws);
}

TEST_CASE("Where no draw is allowed the fitted values stand in the ensemble") {
  const auto is_allowed = [](const std::vector<double>&) { return false; };
  const experiment::Ensemble ensemble = EnsembleOf(Fit(), kConfidence, 2, 1, is_allowed);
  for (const std::vector<double>& draw : ensemble.draws) {
    CHECK(draw == std::vector<double>{3.0, -2.0, 0.5});
  }
}

TEST_CASE("A parameter whose range has no width is drawn at its place") {
  Calibration fit = Fit();
  fit.parameters[1].parameter.min = fit.parameters[1].parameter.max = -2.0;
  const experiment::Ensemble ensemble = EnsembleOf(fit, kConfidence, 5, 1);
  for (const std::vector<double>& draw : ensemble.draws) {
    CHECK(draw[1] == -2.0);
    CHECK(draw[0] != 3.0);
  }
}

}  // namespace
}  // namespace rift::sweep
