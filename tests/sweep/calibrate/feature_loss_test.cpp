// The loss of features beside its definition, written out draw by draw for one group of logs.
#include <Eigen/LU>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"
#include "sweep/calibrate/feature_model.hpp"

namespace rift::sweep {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Made {
  MatrixXd real, draws;
  std::vector<FeatureRows> driven;
};

/// Two features of each log, on both sides of 0, that answer each parameter differently and have a
/// part of their noise in common; logs scatter by `between`.
Made MakeDrives(Index logs, Index parameters, Index draws, double between) {
  statistics::Random random(17, static_cast<std::uint64_t>(logs));
  const auto even = [&random] { return 2.0 * random.Uniform() - 1.0; };
  Made made{.real = MatrixXd(logs, 2), .draws = MatrixXd(draws, parameters)};
  for (double& value : made.draws.reshaped()) value = 2.0 * even();
  for (Index i = 0; i < draws; ++i) {
    FeatureRows& at = made.driven.emplace_back();
    at.rows = MatrixXd(logs, 2);
    at.has_failed = VectorXd::Zero(logs);
    const double z = made.draws(i, 0), other = made.draws(i, parameters - 1);
    for (Index log = 0; log < logs; ++log) {
      const double noise = 0.3 * even();
      at.rows(log, 0) = 0.5 * z - 0.2 * other + 0.1 * static_cast<double>(log) + noise;
      at.rows(log, 1) = 0.3 * other + 0.15 * z * z - noise + 0.2 * even();
      if (z > 0.5 && random.Uniform() < 0.4) at.has_failed[log] = 1.0;
    }
  }
  made.real.setZero();
  for (const FeatureRows& at : made.driven) made.real += at.rows / draws;
  for (Index log = 0; log < logs; ++log) {
    made.real.row(log) += Eigen::RowVector2d(0.1 + 0.05 * even(), 0.05 - between);
    between = -between;
  }
  return made;
}

/// The second feature as a number above 0 whose logarithm it is.
Made WithExponentials(Made made) {
  made.real.col(1) = made.real.col(1).array().exp();
  for (FeatureRows& at : made.driven) at.rows.col(1) = at.rows.col(1).array().exp();
  return made;
}

FeatureModel ModelOf(const Made& made, double failures = 1.0, int alike = 1,
                     std::vector<std::string> groups = {}) {
  if (groups.empty()) groups.assign(static_cast<size_t>(made.real.rows()), "all");
  const auto acts = FeatureModel::Acts::Constant(made.real.rows(), made.draws.cols(), true);
  return {groups, made.real, made.draws, acts, made.driven, failures, alike};
}

VectorXd BasisAt(const VectorXd& z) {
  VectorXd basis(1 + 2 * z.size());
  basis << 1.0, z, z.cwiseProduct(z);
  return basis;
}

/// d BasisAt / dz.
MatrixXd SlopesAt(const VectorXd& z) {
  MatrixXd slopes = MatrixXd::Zero(z.size(), 1 + 2 * z.size());
  for (Index k = 0; k < z.size(); ++k)
    slopes(k, 1 + k) = 1.0, slopes(k, 1 + z.size() + k) = 2 * z[k];
  return slopes;
}

struct Definition {
  double logs = 0.0;
  MatrixXd mean_of_log, coefficients, weights, noise;
  VectorXd real_off, failing;

  double LossAt(const VectorXd& z, double failures) const {
    const VectorXd basis = BasisAt(z), error = coefficients.transpose() * basis - real_off;
    return error.dot(weights * error) - basis.dot(noise * basis) +
           2.0 * failures * logs * std::max(0.0, failing.dot(basis));
  }
};

/// Of one group whose drives are all known and within its limits.
Definition DefinitionOf(const Made& made, Index alike) {
  const Index draws = made.draws.rows(), parameters = made.draws.cols(), logs = made.real.rows();
  const Index terms = 1 + 2 * parameters, features = made.real.cols();
  Definition found{.logs = static_cast<double>(logs),
                   .mean_of_log = MatrixXd::Zero(logs, features)};
  for (const FeatureRows& at : made.driven) found.mean_of_log += at.rows / draws;
  const auto basis = [&](Index i) { return BasisAt(made.draws.row(i)); };
  const auto off = [&](Index i) -> MatrixXd {
    return made.driven[static_cast<size_t>(i)].rows - found.mean_of_log;
  };
  MatrixXd normal = MatrixXd::Zero(terms, terms), products = MatrixXd::Zero(terms, features);
  VectorXd failed = VectorXd::Zero(terms);
  for (Index i = 0; i < draws; ++i) {
    normal += basis(i) * basis(i).transpose();
    products += basis(i) * off(i).colwise().mean();
    failed += basis(i) * made.driven[static_cast<size_t>(i)].has_failed.mean();
  }
  for (Index k = 0; k < parameters; ++k) {
    normal(1 + k, 1 + k) += 0.5, normal(1 + parameters + k, 1 + parameters + k) += 4.0;
  }
  const MatrixXd inverse = normal.inverse();
  found.coefficients = inverse * products;
  found.failing = inverse * failed;

  MatrixXd squares = MatrixXd::Zero(features, features);
  std::vector<MatrixXd> left_of_block;
  for (Index i = 0; i < draws; ++i) {
    const MatrixXd left =
        off(i).rowwise() - (found.coefficients.transpose() * basis(i)).transpose();
    squares += left.transpose() * left;
    if (i % alike == 0) left_of_block.emplace_back(MatrixXd::Zero(terms, features));
    left_of_block.back() += basis(i) * left.colwise().mean();
  }
  const MatrixXd real_off = made.real - found.mean_of_log;
  found.real_off = real_off.colwise().mean();
  VectorXd scatter(features);
  for (Index k = 0; k < features; ++k) {
    scatter[k] = std::sqrt(squares(k, k) / static_cast<double>(draws * logs));
    const std::vector<double> of_logs(real_off.col(k).begin(), real_off.col(k).end());
    if (logs >= 4) scatter[k] = std::max(scatter[k], statistics::StandardDeviation(of_logs));
  }
  MatrixXd covariance(features, features);
  for (Index a = 0; a < features; ++a) {
    for (Index b = 0; b < features; ++b) {
      const double correlation = squares(a, b) / std::sqrt(squares(a, a) * squares(b, b));
      covariance(a, b) = scatter[a] * scatter[b] *
                         (a == b ? 1.0 / found.logs + 0.01 : 0.6 * correlation / found.logs);
    }
  }
  found.weights = covariance.inverse();
  MatrixXd sum = MatrixXd::Zero(terms, terms);
  for (const MatrixXd& left : left_of_block) sum += left * found.weights * left.transpose();
  found.noise = static_cast<double>(draws) / std::max(1.0, static_cast<double>(draws - terms)) *
                inverse * sum * inverse;
  return found;
}

TEST_CASE("Loss, slope, curvature and information of features are those of their definition") {
  struct Case {
    Index logs, parameters, draws;
    int alike;
    double between;  ///< of the logs
  };
  for (const Case& one : {Case{1, 1, 24, 1, 0.0},
                          {1, 1, 3, 1, 0.0},
                          {3, 2, 24, 2, 0.5},
                          {4, 2, 23, 5, 0.5},
                          {5, 3, 40, 2, 0.1}}) {
    CAPTURE(one.logs, one.parameters, one.draws, one.alike);
    const Made made = MakeDrives(one.logs, one.parameters, one.draws, one.between);
    const FeatureModel model = ModelOf(WithExponentials(made), 0.7, one.alike);
    const Definition definition = DefinitionOf(made, one.alike);
    for (const double scale : {-1.1, 0.3, 1.4}) {
      VectorXd z(one.parameters);
      for (Index k = 0; k < z.size(); ++k) z[k] = scale * (1.0 - 0.4 * static_cast<double>(k));
      CAPTURE(scale);
      const FeatureModel::Expansion at = model.At(z);
      CHECK(at.loss == Approx(definition.LossAt(z, 0.7)));
      const double failing = definition.failing.dot(BasisAt(z));
      CHECK(model.FailingShareAt(z) == Approx(std::max(0.0, failing)));
      const MatrixXd slopes = SlopesAt(z), of_features = slopes * definition.coefficients;
      const MatrixXd half = of_features * definition.weights * of_features.transpose();
      const MatrixXd information = half - slopes * definition.noise * slopes.transpose();
      for (Index a = 0; a < z.size(); ++a) {
        VectorXd above = z, below = z;
        above[a] += 1e-5, below[a] -= 1e-5;
        const double slope = (definition.LossAt(above, 0.7) - definition.LossAt(below, 0.7)) / 2e-5;
        CHECK(at.gradient[a] == Approx(slope).epsilon(1e-5).margin(1e-5));
        for (Index b = 0; b < z.size(); ++b) CHECK(at.hessian(a, b) == Approx(2.0 * half(a, b)));
      }
      // Regressed slopes are in both factors of the score: slope and error.
      const VectorXd basis = BasisAt(z),
                     error = definition.coefficients.transpose() * basis - definition.real_off;
      const MatrixXd noise = definition.noise / 2.0;  // of two features
      const MatrixXd score =
          model.InformationAt(z) + basis.dot(noise * basis) * half +
          error.dot(definition.weights * error) * slopes * noise * slopes.transpose();
      CHECK((model.ScoreCovarianceAt(z) - score).norm() < 1e-6 * score.norm());
      if (one.parameters == 1) {
        CHECK(model.InformationAt(z)(0, 0) == Approx(std::max(0.0, information(0, 0))));
      } else if (information.determinant() > 0.0 && information.trace() > 0.0 &&
                 one.parameters == 2) {
        CHECK((model.InformationAt(z) - information).norm() < 1e-9 * information.norm());
      }
    }
  }
}

TEST_CASE("Drives at one set of values have the loss of their mean, and of what failed") {
  const Made made = MakeDrives(3, 1, 30, 0.2);
  const FeatureModel model = ModelOf(WithExponentials(made), 0.7);
  const Definition definition = DefinitionOf(made, 1);
  const Eigen::Vector2d off(0.2, -0.1);
  const auto driven = [&](double side) {
    Made at{.real = definition.mean_of_log};
    at.real.rowwise() += (definition.real_off + off).transpose();
    at.real.row(0).array() += side, at.real.row(2).array() -= side;  // the logs even this out
    return FeatureRows{.rows = WithExponentials(at).real, .has_failed = Eigen::Vector3d(0, 1, 0)};
  };
  const double apart = off.dot(definition.weights * off);
  CHECK(model.LossOf({driven(0.0)}) == Approx(apart + 2.0 * 0.7 * 3.0 / 3.0));
  FeatureRows sound = driven(-0.1);
  sound.has_failed.setZero();
  CHECK(model.LossOf({driven(0.1), sound}) == Approx(apart + 2.0 * 0.7 * 3.0 / 6.0));

  // A feature that no drive tells is as far off as the drives have ever been.
  sound.rows.col(1).setConstant(kNone);
  std::vector<double> all;
  for (const FeatureRows& one : made.driven) {
    all.insert(all.end(), one.rows.col(1).begin(), one.rows.col(1).end());
  }
  const auto at = [&all](double share) { return statistics::Quantile(all, share); };
  const Eigen::Vector2d unknown(off[0], at(0.99) - at(0.01) + at(0.75) - at(0.25));
  CHECK(model.LossOf({sound}) == Approx(unknown.dot(definition.weights * unknown)));
}

TEST_CASE("The loss of groups is the sum of theirs, and their failures count log by log") {
  const Made made = WithExponentials(MakeDrives(5, 1, 30, 0.2));
  const FeatureModel both = ModelOf(made, 1.0, 1, {"a", "b", "a", "b", "a"});
  const auto part = [&made](const std::vector<Index>& logs) {
    Made some{.real = made.real(logs, Eigen::all), .draws = made.draws};
    for (const FeatureRows& one : made.driven) {
      some.driven.push_back({one.rows(logs, Eigen::all), one.has_failed(logs)});
    }
    return some;
  };
  const Made first = part({0, 2, 4}), second = part({1, 3});
  const FeatureModel a = ModelOf(first), b = ModelOf(second);
  for (const double place : {-1.0, 0.4, 1.5}) {
    const VectorXd z = VectorXd::Constant(1, place);
    CHECK(both.At(z).loss == Approx(a.At(z).loss + b.At(z).loss));
    CHECK(both.At(z).gradient[0] == Approx(a.At(z).gradient[0] + b.At(z).gradient[0]));
    CHECK(both.At(z).hessian(0, 0) == Approx(a.At(z).hessian(0, 0) + b.At(z).hessian(0, 0)));
    CHECK(both.FailingShareAt(z) ==
          Approx((3.0 * a.FailingShareAt(z) + 2.0 * b.FailingShareAt(z)) / 5.0));
  }
  CHECK(both.FeatureCount() == a.FeatureCount() + b.FeatureCount());
  CHECK(both.LossOf(made.driven) == Approx(a.LossOf(first.driven) + b.LossOf(second.driven)));
}

TEST_CASE("A parameter that acts on no log of a group is none of its regression") {
  const Made made = WithExponentials(MakeDrives(3, 3, 40, 0.2));
  FeatureModel::Acts acts = FeatureModel::Acts::Constant(3, 3, true);
  acts.col(1) = false;
  acts(0, 2) = acts(1, 2) = false;  // one log is enough
  const std::vector<std::string> groups(3, "all");
  const FeatureModel model(groups, made.real, made.draws, acts, made.driven);
  Made fewer = made;
  fewer.draws = made.draws(Eigen::all, std::vector<Index>{0, 2});
  const FeatureModel without = ModelOf(fewer);
  const FeatureModel::Expansion at = model.At(Eigen::Vector3d(0.7, 9.0, -0.6)),
                                expected = without.At(Eigen::Vector2d(0.7, -0.6));
  CHECK(at.loss == Approx(expected.loss));
  CHECK(at.gradient[0] == Approx(expected.gradient[0]));
  CHECK(at.gradient[1] == 0.0);
  CHECK(at.gradient[2] == Approx(expected.gradient[1]));
  CHECK(at.hessian(0, 2) == Approx(expected.hessian(0, 1)));
}

}  // namespace
}  // namespace rift::sweep
