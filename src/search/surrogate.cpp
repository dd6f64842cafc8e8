#include "surrogate.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "rift/statistics/distributions.hpp"

namespace rift::search {
namespace {

constexpr std::uint64_t kStream = 0x400;
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

Surrogate::Surrogate(const Known& known, const SurrogateOptions& options, std::uint64_t seed)
    : known_(known),
      options_(options),
      random_(seed, kStream),
      sequence_(known.space.Size(), seed + kStream),
      model_(known.space) {
  if (options_.initial == 0) options_.initial = 4 * known.space.Size();
}

std::vector<Point> Surrogate::Ask(int most) {
  std::vector<Point> points;
  if (known_.archive.Size() < static_cast<std::size_t>(options_.initial)) {
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
  const auto most = static_cast<std::size_t>(options_.model_points);
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
  model_.Fit(points, values, is_due ? options_.fit_steps : 0, random_);
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
  Eigen::MatrixXd candidates(options_.candidates, known_.space.Size());
  const auto anywhere = static_cast<Eigen::Index>(kAnywhere * options_.candidates);
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
