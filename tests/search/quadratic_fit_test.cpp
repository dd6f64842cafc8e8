// The least value of a quadratic that is fitted to losses, against quadratics whose least is known.
#include "search/quadratic_fit.hpp"

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "rift/statistics/random.hpp"

namespace rift::search {
namespace {

using Eigen::MatrixXd, Eigen::VectorXd;

struct Planted {
  MatrixXd form;
  VectorXd least;
  double value;

  double operator()(const VectorXd& x) const { return value + (x - least).dot(form * (x - least)); }
  VectorXd At(const MatrixXd& places) const {
    VectorXd losses(places.cols());
    for (Eigen::Index i = 0; i < places.cols(); ++i) losses[i] = (*this)(places.col(i));
    return losses;
  }
};

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed, 0) {}
  double Between(double low, double high) { return low + (high - low) * random_.Uniform(); }
  MatrixXd Places(Eigen::Index axes, Eigen::Index n) {
    return MatrixXd::NullaryExpr(axes, n, [&] { return Between(0.0, 1.0); });
  }
  /// Its least lies well within the places, and is turned against the axes.
  Planted Bowl(Eigen::Index axes) {
    const MatrixXd any = MatrixXd::NullaryExpr(axes, axes, [&] { return Between(-1.0, 1.0); });
    const MatrixXd form = any * any.transpose() + 0.05 * MatrixXd::Identity(axes, axes);
    return {form, VectorXd::NullaryExpr(axes, [&] { return Between(0.35, 0.65); }),
            Between(-5.0, 5.0)};
  }

 private:
  statistics::Random random_;
};

TEST_CASE("The least of a quadratic is found from two points more than it has coefficients") {
  for (int axes = 1; axes <= 7; ++axes) {
    Dice dice(static_cast<std::uint64_t>(axes));
    const Planted bowl = dice.Bowl(axes);
    const MatrixXd places = 4.0 * dice.Places(axes, CoefficientsOf(axes) + 2).array() - 1.5;
    const VectorXd start = VectorXd::Constant(axes, 0.2);
    const auto found = MinimumOfQuadratic(places, bowl.At(places), start);
    INFO(axes << " axes");
    REQUIRE(found);
    CHECK((found->place - bowl.least).cwiseAbs().maxCoeff() < 1e-4);
    CHECK(found->loss == Approx(bowl.value).margin(1e-6));
  }
}

TEST_CASE("A quadratic that falls outward is least on the bounds of the places") {
  Dice dice(3);
  const MatrixXd places = dice.Places(2, 12);
  const Planted hill{-MatrixXd::Identity(2, 2), Eigen::Vector2d(0.4, 0.6), 0.0};
  const auto found = MinimumOfQuadratic(places, hill.At(places), Eigen::Vector2d(0.5, 0.5));
  REQUIRE(found);
  CHECK(found->place.x() == Approx(places.row(0).maxCoeff()));
  CHECK(found->place.y() == Approx(places.row(1).minCoeff()));
  CHECK(found->loss == Approx(hill(found->place)));
}

TEST_CASE("Losses with noise are not followed to each where there are many") {
  Dice dice(4);
  const Planted bowl = dice.Bowl(3);
  const MatrixXd places = 2.0 * dice.Places(3, 400).array() - 0.5;
  VectorXd losses = bowl.At(places);
  const double spread = losses.maxCoeff() - losses.minCoeff();
  for (double& loss : losses) loss += 0.02 * spread * dice.Between(-1.0, 1.0);
  const auto found = MinimumOfQuadratic(places, losses, VectorXd::Zero(3));
  REQUIRE(found);
  CHECK(bowl(found->place) - bowl.value < 0.01 * spread);
}

TEST_CASE("Places that do not determine a quadratic have none") {
  Dice dice(5);
  const Planted bowl = dice.Bowl(2);
  const VectorXd start = VectorXd::Zero(2);
  const MatrixXd few = dice.Places(2, CoefficientsOf(2) + 1);
  CHECK_FALSE(MinimumOfQuadratic(few, bowl.At(few), start));
  MatrixXd line = dice.Places(2, 20);
  line.row(1) = line.row(0);
  CHECK_FALSE(MinimumOfQuadratic(line, bowl.At(line), start));
  const MatrixXd many = dice.Places(2, 20);
  CHECK_FALSE(MinimumOfQuadratic(many, VectorXd::Constant(20, 3.0), start));
}

/// Two ranges and a category, and what is told of them so far.
struct Told {
  Known known{{{"a", AxisKind::kContinuous, -2.0, 2.0},
               {"b", AxisKind::kContinuous, 10.0, 12.0},
               {"c", AxisKind::kCategorical, 0, 1}}};
  QuadraticFit fit{known};
  Dice dice{6};

  /// In category 0 a bowl with its least at -0.5 and 11.2, in category 1 another that is higher.
  static double Loss(const Point& p) {
    const double a = p[0] + (p[2] > 0.5 ? -1.0 : 0.5), b = p[1] - 11.2;
    return a * a + 3.0 * b * b + a * b + 10.0 * p[2];
  }
  void AddAnywhere(int count, double category) {
    for (int i = 0; i < count; ++i) {
      const Point point{dice.Between(-2.0, 2.0), dice.Between(10.0, 12.0), category};
      known.archive.Add({point, Loss(point)});
    }
  }
};

TEST_CASE("A quadratic is fitted within the category of the best point") {
  Told told;
  told.AddAnywhere(20, 1.0);
  told.AddAnywhere(7, 0.0);
  CHECK_FALSE(told.fit.IsDue());  // six coefficients and one point more
  told.AddAnywhere(10, 0.0);
  REQUIRE(told.fit.IsDue());
  const std::vector<Point> asked = told.fit.Ask(8);
  REQUIRE(asked.size() == 1);
  CHECK(asked[0][0] == Approx(-0.5).margin(1e-4));
  CHECK(asked[0][1] == Approx(11.2).margin(1e-4));
  CHECK(asked[0][2] == 0.0);
}

TEST_CASE("After a quadratic that did not come true the next waits for a quarter more points") {
  for (const bool comes_true : {true, false}) {
    Told told;
    told.AddAnywhere(40, 0.0);
    const double best = told.known.archive.BestLoss();
    REQUIRE(told.fit.IsDue());
    const Point asked = told.fit.Ask(8).front();
    // Of a model of the others' bowl, a tenth of the promise is enough.
    const double promised = best - Told::Loss(asked);
    const Evaluation found{asked, best - (comes_true ? 0.2 : 0.05) * promised};
    told.known.archive.Add(found);
    told.fit.Tell({&found, 1});
    CHECK(told.fit.IsDue() == comes_true);
    if (comes_true) continue;
    told.AddAnywhere(9, 1.0);
    CHECK_FALSE(told.fit.IsDue());  // 41 then, 51 are waited for
    told.AddAnywhere(1, 1.0);
    CHECK(told.fit.IsDue());
  }
}

TEST_CASE("A quadratic that promises nothing better than the best point is not asked for") {
  // A hole of depth 1 in the middle of a square of eight others at 0. By symmetry the model is
  // -5/9 + r^2 / 3, in steps of the square: less deep than the hole.
  Told told;
  for (const int i : {0, -1, 1}) {
    for (const int j : {0, -1, 1}) {
      const double loss = i == 0 && j == 0 ? -1.0 : 0.0;
      told.known.archive.Add({{0.4 * i, 11.0 + 0.2 * j, 0.0}, loss});
    }
  }
  MatrixXd places(2, 9);
  VectorXd losses = VectorXd::Zero(9);
  for (Eigen::Index k = 0; k < 9; ++k) {
    places.col(k) << static_cast<double>(k / 3) - 1.0, static_cast<double>(k % 3) - 1.0;
  }
  losses[4] = -1.0;
  const auto least = MinimumOfQuadratic(places, losses, Eigen::Vector2d(0.4, 0.3));
  REQUIRE(least);
  CHECK(least->place.norm() < 1e-6);
  CHECK(least->loss == Approx(-5.0 / 9.0));
  CHECK_FALSE(told.fit.IsDue());
  CHECK(told.fit.Ask(8).empty());
}

}  // namespace
}  // namespace rift::search
