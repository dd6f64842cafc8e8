// What drives are like, regressed on the values they were driven at: made-up drives with a known
// answer, no simulator.

#include "sweep/calibrate/feature_model.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "rift/statistics/descriptive.hpp"
#include "rift/statistics/random.hpp"

namespace rift::sweep {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr int kLogs = 6;

/// Three features that answer two parameters: linear, with a square, and not at all.
Eigen::Vector3d MeanAt(const Eigen::Vector2d& z) {
  return {2.0 + 0.5 * z[0] - 0.2 * z[1], -1.0 + 0.3 * z[1] + 0.1 * z[0] * z[0], 4.0};
}

struct Made {
  Eigen::MatrixXd real, draws;
  std::vector<FeatureRows> driven;
  FeatureModel::Acts acts = FeatureModel::Acts::Constant(kLogs, 2, true);
  std::vector<std::string> groups = std::vector<std::string>(kLogs, "ground");
};

/// Logs that differ from each other by `log`, driven at `truth` for real, each scattering by
/// `noise`; `failing` of the drives where the first parameter is above 0.
Made MakeDrives(const Eigen::Vector2d& truth, double noise, double failing = 0.0, int draws = 400,
                std::uint64_t seed = 5) {
  statistics::Random random(seed, 1);
  const auto row = [&](const Eigen::Vector2d& z, int log) -> Eigen::RowVectorXd {
    Eigen::RowVectorXd one = MeanAt(z).transpose().array() + 0.3 * log;
    for (double& value : one) value += noise * random.Normal();
    return one;
  };
  Made made{.real = Eigen::MatrixXd(kLogs, 3), .draws = Eigen::MatrixXd(draws, 2)};
  for (int log = 0; log < kLogs; ++log) {
    made.real.row(log) = MeanAt(truth).transpose().array() + 0.3 * log;
  }
  for (Eigen::Index i = 0; i < made.draws.rows(); ++i) {
    made.draws.row(i) << random.Normal(), random.Normal();
    FeatureRows& at = made.driven.emplace_back();
    at.rows.resize(kLogs, 3);
    at.has_failed = Eigen::VectorXd::Zero(kLogs);
    for (int log = 0; log < kLogs; ++log) {
      at.rows.row(log) = row(made.draws.row(i), log);
      if (made.draws(i, 0) > 0.0 && random.Uniform() < failing) {
        at.has_failed[log] = 1.0;
        at.rows.row(log).setConstant(kNone);
      }
    }
  }
  return made;
}

double LossAt(const FeatureModel& model, double first, double second) {
  return model.At(Eigen::Vector2d(first, second)).loss;
}

TEST_CASE("Drives are like the logs at the values that the logs were driven with") {
  const Eigen::Vector2d truth(0.8, -0.6);
  const Made made = MakeDrives(truth, 0.05);
  const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
  CHECK(model.FeatureCount() == 3);
  const double least = LossAt(model, truth[0], truth[1]);
  CHECK(least < 1.0);
  for (const double off : {-0.4, 0.4}) {
    CHECK(LossAt(model, truth[0] + off, truth[1]) > least + 1.0);
    CHECK(LossAt(model, truth[0], truth[1] + off) > least + 1.0);
  }
}

TEST_CASE("Slope and curvature of the loss are those of the loss") {
  const Made made = MakeDrives({0.8, -0.6}, 0.05, 0.3);
  const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
  const Eigen::Vector2d z(0.5, 0.3);
  const FeatureModel::Expansion at = model.At(z);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 2; ++k) {
    Eigen::Vector2d above = z, below = z;
    above[k] += kStep, below[k] -= kStep;
    CHECK(at.gradient[k] ==
          Approx((model.At(above).loss - model.At(below).loss) / (2.0 * kStep)).epsilon(1e-4));
  }
  CHECK(at.hessian(0, 1) == Approx(at.hessian(1, 0)));
  CHECK(at.hessian.determinant() > 0.0);

  // Where the errors are small, Gauss and Newton's curvature is that of the loss.
  const Made at_truth = MakeDrives({0.8, -0.6}, 0.05);
  const FeatureModel near(at_truth.groups, at_truth.real, at_truth.draws, at_truth.acts,
                          at_truth.driven);
  const auto slope = [&near](double first, double second) {
    return near.At(Eigen::Vector2d(first, second)).gradient;
  };
  const Eigen::MatrixXd curvature = near.At(Eigen::Vector2d(0.8, -0.6)).hessian;
  const Eigen::Vector2d along_first = (slope(0.81, -0.6) - slope(0.79, -0.6)) / 0.02;
  const Eigen::Vector2d along_second = (slope(0.8, -0.59) - slope(0.8, -0.61)) / 0.02;
  CHECK(along_first[0] == Approx(curvature(0, 0)).epsilon(0.05));
  CHECK(along_first[1] == Approx(curvature(1, 0)).epsilon(0.05));
  CHECK(along_second[1] == Approx(curvature(1, 1)).epsilon(0.05));
}

TEST_CASE("A parameter that does not act on a group has no slope there, and chance tells nothing") {
  Made made = MakeDrives({0.8, -0.6}, 0.3);
  for (int log = 0; log < kLogs / 2; ++log) made.groups[static_cast<size_t>(log)] = "cardboard";
  const Eigen::Vector2d z(0.3, 0.4);
  const auto told = [&] {
    const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
    return std::pair(model.At(z), model.InformationAt(z));
  };
  made.acts.col(0).head(kLogs / 2) = false;
  const auto [half, half_information] = told();
  made.acts.col(0) = false;
  const auto [none, none_information] = told();
  CHECK(none.gradient[0] == 0.0);
  CHECK(none.hessian(0, 1) == 0.0);
  CHECK(none_information(0, 0) == 0.0);
  CHECK(half.gradient[0] != 0.0);
  CHECK(half_information(0, 0) > 0.0);
  made.acts = true;
  // The other half tells it as well.
  CHECK(told().second(0, 0) > 1.5 * half_information(0, 0));
}

TEST_CASE("Estimates scatter by what the information says, in noise that logs and drives share") {
  constexpr int kFits = 60;
  const Eigen::Vector2d truth(0.3, -0.2);
  double scatter = 0.0, told = 0.0;
  for (int fit = 0; fit < kFits; ++fit) {
    Made made = MakeDrives(truth, 0.3);
    statistics::Random random(static_cast<std::uint64_t>(fit), 7);
    for (double& value : made.real.reshaped()) value += 0.3 * random.Normal();
    const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
    Eigen::Vector2d z = truth;
    for (int i = 0; i < 20; ++i) {
      const FeatureModel::Expansion at = model.At(z);
      z -= at.hessian.inverse() * at.gradient;
    }
    scatter += (z - truth).squaredNorm() / kFits;
    told += model.InformationAt(z).inverse().trace() / kFits;
  }
  // A simulator is never quite the robot (a tenth of a drive's scatter), which is told as well.
  CHECK(told > scatter);
  CHECK(told < 2.0 * scatter);
}

/// Few drives that share noise among `alike` draws, beside features that answer nothing: those add
/// to the noise, and to nothing else. `real_noise`: of each log.
FeatureModel OfFewNoisyDraws(const Eigen::Vector2d& truth, std::uint64_t seed, int alike,
                             double real_noise) {
  constexpr int kDraws = 60, kIdle = 30;
  constexpr double kNoise = 0.6;
  Made made = MakeDrives(truth, 0.0, 0.0, kDraws, seed);
  statistics::Random random(seed, 8);
  const auto with_idle = [](const Eigen::MatrixXd& rows) {
    Eigen::MatrixXd wide = Eigen::MatrixXd::Zero(rows.rows(), rows.cols() + kIdle);
    wide.leftCols(rows.cols()) = rows;
    return wide;
  };
  made.real = with_idle(made.real);
  Eigen::MatrixXd noise;
  for (size_t i = 0; i < made.driven.size(); ++i) {
    Eigen::MatrixXd& rows = made.driven[i].rows;
    rows = with_idle(rows);
    if (i % static_cast<size_t>(alike) == 0) {
      noise.resize(rows.rows(), rows.cols());
      for (double& value : noise.reshaped()) value = kNoise * random.Normal();
    }
    rows += noise;
  }
  for (double& value : made.real.reshaped()) value += real_noise * random.Normal();
  return {made.groups, made.real, made.draws, made.acts, made.driven, 1.0, alike};
}

/// The least loss within two scatters of the draws.
Eigen::Vector2d LeastOf(const FeatureModel& model) {
  Eigen::Vector2d z = Eigen::Vector2d::Zero();
  for (int i = 0; i < 100; ++i) {
    const FeatureModel::Expansion at = model.At(z);
    z = (z - at.hessian.inverse() * at.gradient).cwiseMax(-2.0).cwiseMin(2.0);
  }
  return z;
}

TEST_CASE(
    "Estimates of few noisy draws lie about the truth, also of draws that share their noise") {
  constexpr int kFits = 400;
  const Eigen::Vector2d truth(0.8, -0.6);
  for (const int alike : {1, 2}) {
    std::vector<double> first, second;
    for (int fit = 0; fit < kFits; ++fit) {
      const Eigen::Vector2d z =
          LeastOf(OfFewNoisyDraws(truth, static_cast<std::uint64_t>(fit + 1), alike, 0.0));
      first.push_back(z[0]), second.push_back(z[1]);
    }
    CAPTURE(alike);
    CHECK(statistics::Median(first) == Approx(truth[0]).margin(0.04));
    CHECK(statistics::Median(second) == Approx(truth[1]).margin(0.04));
  }
}

TEST_CASE("Intervals of few noisy draws hold the truth, which the information alone does not") {
  constexpr int kFits = 400;
  constexpr double kDeviations = 1.96;
  const Eigen::Vector2d truth(0.3, -0.2);
  for (const int alike : {1, 2}) {
    int held = 0, held_by_information = 0;
    for (int fit = 0; fit < kFits; ++fit) {
      const FeatureModel model =
          OfFewNoisyDraws(truth, static_cast<std::uint64_t>(fit + 1), alike, 0.6);
      const Eigen::Vector2d z = LeastOf(model);
      const Eigen::Matrix2d inverse = model.InformationAt(z).inverse();
      const Eigen::Matrix2d covariance = inverse * model.ScoreCovarianceAt(z) * inverse;
      for (int k = 0; k < 2; ++k) {
        const double off = std::abs(z[k] - truth[k]);
        held += off < kDeviations * std::sqrt(covariance(k, k));
        held_by_information += off < kDeviations * std::sqrt(inverse(k, k));
      }
    }
    CAPTURE(alike);
    CHECK(held > 0.90 * 2 * kFits);
    CHECK(held_by_information < 0.88 * 2 * kFits);
  }
}

TEST_CASE("What most drives of some values fail with is no drive of the logs, which all arrived") {
  const Made made = MakeDrives({0.0, 0.0}, 0.05, 0.5);
  const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
  CHECK(model.FailingShareAt(Eigen::Vector2d(1.5, 0.0)) > 0.25);
  CHECK(model.FailingShareAt(Eigen::Vector2d(-1.5, 0.0)) < 0.1);
  const Made sound = MakeDrives({0.0, 0.0}, 0.05, 0.0);
  const FeatureModel all(sound.groups, sound.real, sound.draws, sound.acts, sound.driven);
  CHECK(all.FailingShareAt(Eigen::Vector2d(1.5, 0.0)) == 0.0);
  // Twice the share for each log (-2 log (1 - p)), and as often as is asked for.
  const auto weighted = [&](double failures) {
    return LossAt(
        FeatureModel(made.groups, made.real, made.draws, made.acts, made.driven, failures), 1.0,
        0.0);
  };
  const double by_failures = 2.0 * kLogs * model.FailingShareAt(Eigen::Vector2d(1.0, 0.0));
  CHECK(weighted(1.0) - weighted(0.0) == Approx(by_failures));
  CHECK(weighted(10.0) - weighted(0.0) == Approx(10.0 * by_failures));
}

TEST_CASE(
    "A feature that no log tells or that no drive varies has no say, and one log is no outlier") {
  const Eigen::Vector2d truth(0.4, 0.2);
  Made made = MakeDrives(truth, 0.05);
  for (FeatureRows& one : made.driven) one.rows.col(2).setConstant(4.0);
  CHECK(FeatureModel(made.groups, made.real, made.draws, made.acts, made.driven).FeatureCount() ==
        2);
  made.real.col(1).setConstant(kNone);
  CHECK(FeatureModel(made.groups, made.real, made.draws, made.acts, made.driven).FeatureCount() ==
        1);

  Made wild = MakeDrives(truth, 0.05), wilder = wild;
  wild.real(3, 0) = 40.0;
  wilder.real(3, 0) = 4e6;
  CHECK(LossAt(FeatureModel(wild.groups, wild.real, wild.draws, wild.acts, wild.driven), 0.4,
               0.2) == Approx(LossAt(FeatureModel(wilder.groups, wilder.real, wilder.draws,
                                                  wilder.acts, wilder.driven),
                                     0.4, 0.2)));
}

TEST_CASE("Groups answer the parameters each in its own way") {
  Made made = MakeDrives({0.5, 0.0}, 0.05);
  // Of the second half of the logs the first feature falls where it rises in the first half.
  for (int log = kLogs / 2; log < kLogs; ++log) {
    made.groups[static_cast<size_t>(log)] = "cardboard";
    made.real(log, 0) = 10.0 - made.real(log, 0);
    for (FeatureRows& one : made.driven) one.rows(log, 0) = 10.0 - one.rows(log, 0);
  }
  const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
  CHECK(model.FeatureCount() == 6);
  const double least = LossAt(model, 0.5, 0.0);
  CHECK(least < 1.5);
  CHECK(LossAt(model, 0.0, 0.0) > least + 1.0);
  CHECK(LossAt(model, 1.0, 0.0) > least + 1.0);
}

TEST_CASE("The loss of drives is that of the regression where they were driven") {
  const Made made = MakeDrives({0.8, -0.6}, 0.05);
  const FeatureModel model(made.groups, made.real, made.draws, made.acts, made.driven);
  std::vector<FeatureRows> at_truth(40), elsewhere(40);
  statistics::Random random(9, 2);
  for (size_t i = 0; i < at_truth.size(); ++i) {
    at_truth[i].has_failed = elsewhere[i].has_failed = Eigen::VectorXd::Zero(kLogs);
    at_truth[i].rows = made.real;
    elsewhere[i].rows = made.real;
    elsewhere[i].rows.col(0).array() += 0.3;
    for (double& value : at_truth[i].rows.reshaped()) value += 0.05 * random.Normal();
  }
  CHECK(model.LossOf(at_truth) < 1.0);
  CHECK(model.LossOf(elsewhere) > model.LossOf(at_truth) + 1.0);
  for (FeatureRows& one : at_truth) one.has_failed.setConstant(0.5);
  CHECK(model.LossOf(at_truth) > kLogs);

  // Nothing that arrives is no drive like the logs, whatever weight failures have.
  const FeatureModel careless(made.groups, made.real, made.draws, made.acts, made.driven, 0.0);
  for (FeatureRows& one : at_truth) one.rows.setConstant(kNone);
  CHECK(careless.LossOf(at_truth) > careless.LossOf(elsewhere));
}

}  // namespace
}  // namespace rift::sweep
