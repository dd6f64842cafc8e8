#include "motion_guess.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace rift::vision {
namespace {

// Deviations of a small robot that starts, brakes or turns as hard as its tyres allow now and then.
constexpr double kAcceleration_mps2 = 2.0;
constexpr double kTurn_radps2 = 20.0;

using Complex = std::complex<double>;

Complex Plane(const Eigen::Vector2d& p) { return {p.x(), p.y()}; }

/// z -> middle_to + ratio (z - middle_from): the similarity that fits the corners best.
struct Similarity {
  Complex middle_from;
  Complex middle_to;
  Complex ratio;
};

Similarity FitSimilarity(const TagCorners& from, const TagCorners& to) {
  Similarity fit{0.0, 0.0, 0.0};
  for (int i = 0; i < 4; ++i) {
    fit.middle_from += 0.25 * Plane(from[i]);
    fit.middle_to += 0.25 * Plane(to[i]);
  }
  Complex product = 0.0;
  double weight = 0.0;
  for (int i = 0; i < 4; ++i) {
    const Complex arm = Plane(from[i]) - fit.middle_from;
    product += std::conj(arm) * (Plane(to[i]) - fit.middle_to);
    weight += std::norm(arm);
  }
  fit.ratio = product / weight;
  return fit;
}

}  // namespace

void MotionGuess::Saw(const Sighting& sighting) {
  before_ = last_;
  last_ = sighting;
}

void MotionGuess::Forget() {
  before_.reset();
  last_.reset();
}

bool MotionGuess::IsKnownAt(double t_s, double lost_after_s) const {
  return last_ && std::abs(t_s - last_->captured_s) <= lost_after_s;
}

bool MotionGuess::HasSpeed(double lost_after_s) const {
  if (!before_) return false;
  const double apart_s = last_->captured_s - before_->captured_s;
  return apart_s > 0.0 && apart_s <= lost_after_s;
}

std::optional<TagCorners> MotionGuess::CornersAt(double t_s, double lost_after_s) const {
  if (!IsKnownAt(t_s, lost_after_s)) return std::nullopt;
  if (!HasSpeed(lost_after_s)) return last_->corners;
  const Similarity step = FitSimilarity(before_->corners, last_->corners);
  const double share = (t_s - last_->captured_s) / (last_->captured_s - before_->captured_s);
  const Complex middle = step.middle_to + share * (step.middle_to - step.middle_from);
  const Complex turn = std::polar(1.0, share * std::arg(step.ratio));
  TagCorners corners;
  for (int i = 0; i < 4; ++i) {
    const Complex corner = middle + turn * (Plane(last_->corners[i]) - step.middle_to);
    corners[i] = {corner.real(), corner.imag()};
  }
  return corners;
}

std::optional<Sighting> MotionGuess::PoseAt(double t_s, double lost_after_s) const {
  const std::optional<TagCorners> corners = CornersAt(t_s, lost_after_s);
  if (!corners) return std::nullopt;
  Sighting guess = *last_;
  guess.captured_s = t_s;
  guess.corners = *corners;
  guess.state = TrackState::kPredicted;
  guess.decision_margin = guess.edge_px = guess.reprojection_px = NAN;
  guess.other_reprojection_px = guess.latency_s = NAN;
  const double ahead_s = t_s - last_->captured_s;
  if (HasSpeed(lost_after_s)) {
    const double share = ahead_s / (last_->captured_s - before_->captured_s);
    const Eigen::AngleAxisd turn(
        Eigen::Matrix3d(last_->map_from_tag.linear() * before_->map_from_tag.linear().transpose()));
    guess.map_from_tag.translation() +=
        share * (last_->map_from_tag.translation() - before_->map_from_tag.translation());
    guess.map_from_tag.linear() =
        Eigen::AngleAxisd(share * turn.angle(), turn.axis()) * last_->map_from_tag.linear();
    // Of (1 + share) times the last pose less share times the one before, which are as good.
    guess.covariance *= std::pow(1.0 + share, 2) + share * share;
  }
  const double moved_m = 0.5 * kAcceleration_mps2 * ahead_s * ahead_s;
  const double turned_rad = 0.5 * kTurn_radps2 * ahead_s * ahead_s;
  guess.covariance.topLeftCorner<2, 2>().diagonal().array() += moved_m * moved_m;
  guess.covariance(5, 5) += turned_rad * turned_rad;
  return guess;
}

Region Around(const TagCorners& corners, double spare_px) {
  Eigen::Vector2d least = corners[0];
  Eigen::Vector2d greatest = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    least = least.cwiseMin(corner);
    greatest = greatest.cwiseMax(corner);
  }
  const auto pixel = [](double v) { return static_cast<int>(std::clamp(v, -1e6, 1e6)); };
  const int left = pixel(std::floor(least.x() - spare_px));
  const int top = pixel(std::floor(least.y() - spare_px));
  return {left, top, pixel(std::ceil(greatest.x() + spare_px)) + 1 - left,
          pixel(std::ceil(greatest.y() + spare_px)) + 1 - top};
}

double Side_px(const TagCorners& corners) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) sum += (corners[(i + 1) % 4] - corners[i]).norm();
  return sum / 4.0;
}

}  // namespace rift::vision
