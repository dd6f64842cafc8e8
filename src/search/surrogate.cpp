#include "surrogate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "rift/statistics/inference.hpp"

namespace rift::search {
namespace {

/// Space-filling points for each axis before the first model when it searches alone.
constexpr int kFirstPerAxis = 4;
constexpr double kFirstLength = 0.5;
constexpr double kFirstNoise = 1e-2;
constexpr double kLeastNoise = 1e-6;
constexpr double kMostNoise = 10.0;

Eigen::ArrayXXd Matern52(const Eigen::MatrixXd& squared) {
  const Eigen::ArrayXXd r = (5.0 * squared.array()).max(0.0).sqrt();
  return (1.0 + r + r.square() / 3.0) * (-r).exp();
}

constexpr std::uint64_t kStream = 0x400;
/// The model rests on so many evaluations at most, the best half and others: fitting costs their
/// cube, and a proposal shall cost less than a trial.
constexpr int kModelPoints = 128;
/// Points that compete for a place in a batch; the prediction costs kModelPoints^2 for each.
constexpr int kCandidates = 256;
/// Trials of other length scales when the model is fitted anew: each costs kModelPoints^3, and the
/// search goes on from the scales of the last fit.
constexpr int kFitSteps = 16;
/// The scales are looked for again when there are so many times the evaluations of the last time.
constexpr double kRefitGrowth = 1.25;
/// What a trial without a loss counts as: worse than the middle, so that it is not sought, and no
/// catastrophe, since trials often break just beside where the gap is widest.
constexpr double kScoreWithoutLoss = 0.5;
/// Share of the candidates that lies anywhere.
constexpr double kAnywhere = 0.3;
/// Probability of an axis to differ from the centre, beside one that does.
constexpr double kAxisMoves = 0.3;
/// The best evaluations that candidates are drawn around.
constexpr std::size_t kCentres = 8;
/// Standard deviations below the mean that the points of a batch hope for, in turn.
constexpr std::array kBoldness{0.5, 1.0, 2.0, 0.0, 1.5, 0.5, 3.0, 1.0};

/// Normal scores of the ranks 1..n, best first: most negative.
double NormalScore(std::size_t rank, std::size_t n) {
  return statistics::NormalQuantile((static_cast<double>(rank) + 0.5) / static_cast<double>(n));
}

}  // namespace

Kriging::Kriging(const Space& space) : space_(space), columns_(0) {
  for (int axis = 0; axis < space.Size(); ++axis) {
    (space.IsCategorical(axis) ? categorical_ : numeric_).push_back(axis);
    columns_ += space.IsCategorical(axis) ? static_cast<int>(space.Levels(axis)) : 1;
  }
  scales_.log_length = Eigen::VectorXd::Constant(space.Size(), std::log(kFirstLength));
  scales_.log_noise = std::log(kFirstNoise);
}

Eigen::MatrixXd Kriging::Stretched(const Eigen::MatrixXd& points, const Scales& scales) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(points.rows(), columns_);
  int column = 0;
  for (const int axis : numeric_) {
    out.col(column++) = points.col(axis) * std::exp(-scales.log_length[axis]);
  }
  for (const int axis : categorical_) {
    // Two levels are then one length scale's inverse apart, as 0 and 1 on a numeric axis.
    const double height = std::exp(-scales.log_length[axis]) / std::sqrt(2.0);
    const double levels = space_.Levels(axis);
    for (Eigen::Index row = 0; row < points.rows(); ++row) {
      const double level = std::min(std::floor(points(row, axis) * levels), levels - 1.0);
      out(row, column + static_cast<int>(level)) = height;
    }
    column += static_cast<int>(levels);
  }
  return out;
}

Eigen::MatrixXd Kriging::KernelBetween(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd squared = -2.0 * a * b.transpose();
  squared.colwise() += a.rowwise().squaredNorm();
  squared.rowwise() += b.rowwise().squaredNorm().transpose();
  return Matern52(squared);
}

Kriging::Model Kriging::ModelWith(const Scales& scales) const {
  const Eigen::MatrixXd stretched = Stretched(points_, scales);
  Eigen::MatrixXd kernel = KernelBetween(stretched, stretched);
  kernel.diagonal().array() += std::exp(scales.log_noise);
  Model model;
  model.cholesky.compute(kernel);
  model.solved = model.cholesky.solve(values_);
  const double n = static_cast<double>(values_.size());
  model.variance = std::max(values_.dot(model.solved) / n, 1e-12);
  const double log_determinant = 2.0 * model.cholesky.matrixLLT().diagonal().array().log().sum();
  model.likelihood = -0.5 * (n * std::log(model.variance) + log_determinant) + Prior(scales);
  if (!std::isfinite(model.likelihood)) model.likelihood = -std::numeric_limits<double>::max();
  return model;
}

double Kriging::Prior(const Scales& scales) {
  const Eigen::ArrayXd off = scales.log_length.array() - std::log(kFirstLength);
  const double noise = scales.log_noise - std::log(kFirstNoise);
  return -0.5 * off.square().sum() - 0.5 * noise * noise / 9.0;
}

Kriging::Scales Kriging::Varied(const Scales& scales, double spread,
                                statistics::Random& random) const {
  Scales varied = scales;
  for (double& length : varied.log_length) {
    length = std::clamp(length + spread * random.Normal(), std::log(0.02), std::log(20.0));
  }
  varied.log_noise = std::clamp(varied.log_noise + 2.0 * spread * random.Normal(),
                                std::log(kLeastNoise), std::log(kMostNoise));
  return varied;
}

void Kriging::Fit(const Eigen::MatrixXd& points, const Eigen::VectorXd& values, int fit_steps,
                  statistics::Random& random) {
  points_ = points;
  values_ = values;
  model_ = ModelWith(scales_);
  double spread = 0.7;
  for (int i = 0; i < fit_steps; ++i) {  // a (1+1) evolution strategy with a one-fifth rule
    const Scales varied = Varied(scales_, spread, random);
    Model model = ModelWith(varied);
    const bool is_better = model.likelihood > model_.likelihood;
    spread *= is_better ? 1.5 : 0.9;
    if (!is_better) continue;
    scales_ = varied;
    model_ = std::move(model);
  }
  stretched_ = Stretched(points_, scales_);
}

Kriging::Prediction Kriging::Predict(const Eigen::MatrixXd& points) const {
  const Eigen::MatrixXd kernel = KernelBetween(stretched_, Stretched(points, scales_));
  Prediction prediction;
  prediction.mean = kernel.transpose() * model_.solved;
  const Eigen::MatrixXd half = model_.cholesky.matrixL().solve(kernel);
  const Eigen::ArrayXd explained = half.colwise().squaredNorm().transpose();
  prediction.variance = model_.variance * (1.0 - explained).max(1e-12);
  return prediction;
}

Eigen::VectorXd Kriging::Correlation(const Eigen::MatrixXd& points,
                                     const Eigen::VectorXd& point) const {
  return KernelBetween(Stretched(points, scales_), Stretched(point.transpose(), scales_)).col(0);
}

Surrogate::Surrogate(const Known& known, std::uint64_t seed)
    : known_(known),
      random_(seed, kStream),
      sequence_(known.space.Size(), seed + kStream),
      model_(known.space) {}

std::vector<Point> Surrogate::Ask(int most) {
  std::vector<Point> points;
  if (static_cast<int>(known_.archive.Size()) < kFirstPerAxis * known_.space.Size()) {
    for (int i = 0; i < most; ++i) points.push_back(known_.space.FromUnit(sequence_.Next()));
    return points;
  }
  FitModel();
  const Eigen::MatrixXd candidates = Candidates();
  const Kriging::Prediction prediction = model_.Predict(candidates);
  Eigen::ArrayXd deviation = prediction.variance.array().sqrt();
  for (int i = 0; i < most; ++i) {
    const double boldness = kBoldness[static_cast<std::size_t>(i) % kBoldness.size()];
    Eigen::Index chosen = 0;
    (prediction.mean.array() - boldness * deviation).minCoeff(&chosen);
    const Eigen::VectorXd unit = candidates.row(chosen);
    points.push_back(known_.space.FromUnit(unit));
    // What the choice will tell about its neighbours is no reason to choose them, too.
    const Eigen::ArrayXd shared = model_.Correlation(candidates, unit).array();
    deviation *= (1.0 - shared.square()).max(0.0).sqrt();
    deviation[chosen] = -1e9;
  }
  return points;
}

std::vector<std::size_t> Surrogate::ModelPoints() {
  const std::size_t n = known_.archive.Size();
  const auto most = static_cast<std::size_t>(kModelPoints);
  std::vector<std::size_t> order = known_.archive.Best(n);
  // The best half and an even choice of the others.
  for (std::size_t i = most / 2; i < most && n > most; ++i) {
    const double share = static_cast<double>(i - most / 2) / static_cast<double>(most - most / 2);
    order[i] =
        order[most / 2 + static_cast<std::size_t>(share * static_cast<double>(n - most / 2))];
  }
  order.resize(std::min(n, most));
  return order;
}

void Surrogate::FitModel() {
  const std::vector<std::size_t> chosen = ModelPoints();
  Eigen::MatrixXd points(chosen.size(), known_.space.Size());
  Eigen::VectorXd values(chosen.size());
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    points.row(row) = known_.space.ToUnit(known_.archive[chosen[i]].point);
    const bool has_loss = std::isfinite(known_.archive[chosen[i]].loss);
    values[row] = has_loss ? NormalScore(i, chosen.size()) : kScoreWithoutLoss;
  }
  const double grown = kRefitGrowth * static_cast<double>(fitted_at_);
  const bool is_due = static_cast<double>(known_.archive.Size()) >= grown;
  if (is_due) fitted_at_ = known_.archive.Size();
  model_.Fit(points, values, is_due ? kFitSteps : 0, random_);
}

Eigen::VectorXd Surrogate::Near(const Eigen::VectorXd& centre) {
  Eigen::VectorXd unit = centre;
  const double size = std::pow(10.0, -2.0 * random_.Uniform());
  const auto axes = static_cast<std::uint64_t>(unit.size());
  const auto surely = static_cast<int>(random_.Below(axes));
  for (int axis = 0; axis < known_.space.Size(); ++axis) {
    if (axis != surely && random_.Uniform() > kAxisMoves) continue;
    if (known_.space.IsCategorical(axis)) {
      unit[axis] = random_.Uniform();
    } else if (random_.Uniform() < 0.1) {
      unit[axis] = random_.Uniform() < 0.5 ? 0.0 : 1.0;
    } else {
      const double cell = known_.space.IsContinuous(axis) ? 0.0 : 1.0 / known_.space.Levels(axis);
      const double spread = std::max(size * std::min(1.0, model_.Scale(axis)), cell);
      unit[axis] = std::clamp(unit[axis] + spread * random_.Normal(), 0.0, 1.0);
    }
  }
  return unit;
}

Eigen::MatrixXd Surrogate::Candidates() {
  const std::vector<std::size_t> best = known_.archive.Best(kCentres);
  Eigen::MatrixXd candidates(kCandidates, known_.space.Size());
  const auto anywhere = static_cast<Eigen::Index>(kAnywhere * kCandidates);
  for (Eigen::Index i = 0; i < candidates.rows(); ++i) {
    const Eigen::VectorXd unit =
        i < anywhere
            ? sequence_.Next()
            : Near(known_.space.ToUnit(known_.archive[best[random_.Below(best.size())]].point));
    candidates.row(i) = known_.space.ToUnit(known_.space.FromUnit(unit));
  }
  return candidates;
}

}  // namespace rift::search
