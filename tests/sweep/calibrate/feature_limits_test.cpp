// Which features of drives count, as which numbers, and up to where.
#include <catch2/catch.hpp>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "sweep/calibrate/feature_model.hpp"

namespace rift::sweep {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr Index kDraws = 101;

/// Drives of one parameter from -2 to 2; in the order of the draws the values of the one feature
/// are -50 to 50 in some order, so that the quartiles are +-25 and the shares of 1 % +-49.
struct Made {
  explicit Made(Index logs = 1) : real(MatrixXd::Constant(logs, 1, 3.0)) {
    for (Index i = 0; i < kDraws; ++i) {
      draws(i, 0) = 0.04 * static_cast<double>(i) - 2.0;
      const auto value = static_cast<double>((37 * i) % kDraws) - 50.0;
      driven.push_back({MatrixXd::Constant(logs, 1, value), VectorXd::Zero(logs)});
    }
  }
  FeatureRows& With(double value) {
    for (FeatureRows& one : driven) {
      if (one.rows(0, 0) == value) return one;
    }
    throw std::logic_error("no such drive");
  }
  FeatureModel Model() const {
    const std::vector<std::string> groups(static_cast<size_t>(real.rows()), "all");
    return {groups, real, draws, FeatureModel::Acts::Constant(real.rows(), 1, true), driven};
  }
  double Loss(double z = 0.7) const { return Model().At(VectorXd::Constant(1, z)).loss; }

  MatrixXd real, draws = MatrixXd(kDraws, 1);
  std::vector<FeatureRows> driven;
};

TEST_CASE("Outliers count as half a distance of the quartiles beyond the outermost hundredths") {
  for (const double side : {-1.0, 1.0}) {
    const auto loss = [side](double drive, double real) {
      Made made;
      made.With(side * 50.0).rows(0, 0) = side * drive;
      made.real(0, 0) = side * real;
      return made.Loss();
    };
    CAPTURE(side);
    CHECK(loss(1000.0, 3.0) == Approx(loss(74.0, 3.0)));
    CHECK(loss(73.0, 3.0) != Approx(loss(74.0, 3.0)));
    CHECK(loss(50.0, 1000.0) == Approx(loss(50.0, 74.0)));
    CHECK(loss(50.0, 73.0) != Approx(loss(50.0, 74.0)));
  }
}

TEST_CASE("A feature above zero counts as its logarithm, and one that reaches zero as itself") {
  const auto made = [](double scale, double shift, double least, double real) {
    Made one;
    for (FeatureRows& at : one.driven) {
      const double value = at.rows(0, 0) == -50.0 ? least : at.rows(0, 0) + 51.0;
      at.rows(0, 0) = scale * value + shift;
    }
    one.With(scale * 30.0 + shift).rows(0, 0) = kNone;  // what is not known is no sign of anything
    one.real(0, 0) = scale * real + shift;
    return one.Loss();
  };
  CHECK(made(1.0, 0.0, 1.0, 20.0) == Approx(made(7.0, 0.0, 1.0, 20.0)));
  CHECK(made(1.0, 0.0, 1.0, 20.0) != Approx(made(1.0, -90.0, 1.0, 20.0)));
  CHECK(made(1.0, 0.0, 0.0, 20.0) == Approx(made(1.0, -90.0, 0.0, 20.0)));
  CHECK(made(1.0, 0.0, 1.0, 0.0) == Approx(made(1.0, -90.0, 1.0, 0.0)));
}

TEST_CASE("A feature counts that two drives tell, or that four logs tell differently") {
  const auto count_of_known = [](int known) {
    Made made;
    for (size_t i = static_cast<size_t>(known); i < made.driven.size(); ++i) {
      made.driven[i].rows(0, 0) = kNone;
    }
    return made.Model().FeatureCount();
  };
  CHECK(count_of_known(1) == 0);
  Made silent;
  silent.real.setConstant(kNone);
  const FeatureModel of_none = silent.Model();
  CHECK(of_none.FeatureCount() == 0);
  CHECK(of_none.InformationAt(VectorXd::Constant(1, 0.7))(0, 0) == 0.0);
  CHECK(of_none.ScoreCovarianceAt(VectorXd::Constant(1, 0.7))(0, 0) == 0.0);
  CHECK(count_of_known(2) == 1);

  // A second feature that each log drives in its own way, and always so: only the logs scatter.
  const auto constant = [](Index logs) {
    Made made(logs);
    made.real.conservativeResize(logs, 2);
    for (FeatureRows& one : made.driven) {
      one.rows.conservativeResize(logs, 2);
      for (Index log = 0; log < logs; ++log) one.rows(log, 1) = static_cast<double>(log) - 1.0;
    }
    for (Index log = 0; log < logs; ++log) {
      made.real(log, 1) = static_cast<double>(log) - 1.0 + (log == 1 ? 0.5 : 0.0);
    }
    return made;
  };
  CHECK(constant(3).Model().FeatureCount() == 1);
  CHECK(constant(4).Model().FeatureCount() == 2);
  // It hangs together with nothing: 0.125 off in scatters of 0.25 / sqrt(4) and 0.25 / 10.
  CHECK(constant(4).Loss() == Approx(Made(4).Loss() + 0.125 * 0.125 / (0.0625 * 0.26)));
}

}  // namespace
}  // namespace rift::sweep
