#include "motion_guess.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace rift::vision {
namespace {

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

void MotionGuess::Saw(double t_s, const TagCorners& corners) {
  before_ = last_;
  last_ = Seen{t_s, corners};
}

void MotionGuess::Forget() {
  before_.reset();
  last_.reset();
}

std::optional<TagCorners> MotionGuess::At(double t_s, double lost_after_s) const {
  if (!last_ || !(std::abs(t_s - last_->t_s) <= lost_after_s)) return std::nullopt;
  if (!before_ || !(last_->t_s - before_->t_s > 0.0) || last_->t_s - before_->t_s > lost_after_s) {
    return last_->corners;
  }
  const Similarity step = FitSimilarity(before_->corners, last_->corners);
  const double share = (t_s - last_->t_s) / (last_->t_s - before_->t_s);
  const Complex middle = step.middle_to + share * (step.middle_to - step.middle_from);
  const Complex turn = std::polar(1.0, share * std::arg(step.ratio));
  TagCorners corners;
  for (int i = 0; i < 4; ++i) {
    const Complex corner = middle + turn * (Plane(last_->corners[i]) - step.middle_to);
    corners[i] = {corner.real(), corner.imag()};
  }
  return corners;
}

Region Around(const TagCorners& corners, double margin) {
  Eigen::Vector2d least = corners[0];
  Eigen::Vector2d greatest = corners[0];
  for (const Eigen::Vector2d& corner : corners) {
    least = least.cwiseMin(corner);
    greatest = greatest.cwiseMax(corner);
  }
  const double spare_px = margin * Side_px(corners);
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
