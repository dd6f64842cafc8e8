// How far the scales of Kriging go.
#include "search/surrogate.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/statistics/random.hpp"

namespace rift::search {
namespace {

const std::vector<Axis> kOne{{"a", AxisKind::kContinuous, 0.0, 1.0}};

/// The variance of the noise as a share n of the signal's: of one value 1 the mean at its place is
/// 1 / (1 + n).
double NoiseOf(Kriging model) {
  statistics::Random random(1, 1);
  const Eigen::MatrixXd place = Eigen::MatrixXd::Constant(1, 1, 0.5);
  model.Fit(place, Eigen::VectorXd::Ones(1), 0, random);
  return 1.0 / model.Predict(place).mean[0] - 1.0;
}

/// After a fit to `count` values at even places from 0 to `width`.
template <class Value>
Kriging Fitted(const Space& space, int count, double width, const Value& value) {
  statistics::Random random(5, 1);
  Eigen::MatrixXd points(count, 1);
  Eigen::VectorXd values(count);
  for (int i = 0; i < count; ++i) {
    points(i, 0) = width * i / (count - 1.0);
    values[i] = value(points(i, 0));
  }
  Kriging model(space);
  model.Fit(points, values, 150, random);
  return model;
}

TEST_CASE("Length scales stay between a fiftieth of an axis and twenty of it") {
  const Space space(kOne);
  CHECK(Fitted(space, 60, 1.0, [](double) { return 1.0; }).Scale(0) == Approx(20.0));
  // Neighbours half a thousandth apart agree, and have nothing to do with the next ones.
  statistics::Random dice(3, 1), random(5, 1);
  Eigen::MatrixXd points(80, 1);
  Eigen::VectorXd values(80);
  for (int i = 0; i < 80; ++i) {
    points(i, 0) = 0.025 * (i / 2) + 5e-4 * (i % 2);
    values[i] = i % 2 == 0 ? dice.Normal() : values[i - 1];
  }
  Kriging narrow(space);
  narrow.Fit(points, values, 150, random);
  CHECK(narrow.Scale(0) == Approx(0.02));
}

TEST_CASE("Noise stays between a millionth of the signal and ten of it") {
  const Space space(kOne);
  statistics::Random dice(3, 1);
  const Kriging noisy = Fitted(space, 120, 1.0, [&](double) { return dice.Normal(); });
  CHECK(NoiseOf(noisy) == Approx(10.0).epsilon(1e-3));
  const Kriging smooth = Fitted(space, 60, 1.0, [](double x) { return std::sin(6.0 * x); });
  CHECK(NoiseOf(smooth) == Approx(1e-6).epsilon(1e-3));
}

}  // namespace
}  // namespace rift::search
