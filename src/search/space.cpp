#include "space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rift::search {
namespace {

/// Beyond this, doubles skip whole numbers.
constexpr double kMostLevels = 9007199254740992.0;

void Check(const Axis& axis) {
  const auto fail = [&](const std::string& rule) {
    throw std::invalid_argument(
        fmt::format("search: axis {} from {} to {}: {}", axis.name, axis.min, axis.max, rule));
  };
  if (!std::isfinite(axis.min) || !std::isfinite(axis.max)) fail("the bounds must be finite");
  if (axis.min > axis.max) fail("the lower bound must not exceed the upper one");
  if (axis.kind == AxisKind::kContinuous) return;
  const bool are_whole = axis.min == std::floor(axis.min) && axis.max == std::floor(axis.max);
  if (!are_whole) fail("the bounds of integers and categories must be whole");
  if (axis.kind == AxisKind::kCategorical && axis.min != 0.0) fail("categories count from 0");
  const double largest = std::max(std::abs(axis.min), std::abs(axis.max));
  if (largest > kMostLevels / 2.0) fail("integers must stay below 2^52");
}

double LevelsOf(const Axis& axis) {
  if (axis.kind == AxisKind::kContinuous) return axis.min == axis.max ? 1.0 : 0.0;
  return axis.max - axis.min + 1.0;
}

std::optional<std::uint64_t> Count(const std::vector<double>& levels) {
  double points = 1.0;
  for (const double n : levels) points *= n;
  if (points < 1.0 || points > kMostLevels) return std::nullopt;
  return static_cast<std::uint64_t>(points);
}

}  // namespace

Space::Space(std::vector<Axis> axes) : axes_(std::move(axes)) {
  if (axes_.empty()) throw std::invalid_argument("search: a space needs at least one axis");
  for (const Axis& axis : axes_) {
    Check(axis);
    levels_.push_back(LevelsOf(axis));
  }
  for (int axis = 0; axis < Size(); ++axis) {
    (IsContinuous(axis) ? continuous_ : discrete_).push_back(axis);
  }
  points_ = Count(levels_);
}

double Space::Corners() const {
  double corners = 1.0;
  for (int axis = 0; axis < Size(); ++axis) {
    const bool is_one_value = axes_[axis].min == axes_[axis].max;
    corners *= IsCategorical(axis) ? levels_[axis] : is_one_value ? 1.0 : 2.0;
  }
  return corners;
}

Point Space::FromUnit(const Eigen::VectorXd& unit) const {
  Point point(axes_.size());
  for (int i = 0; i < Size(); ++i) {
    const double u = std::clamp(unit[i], 0.0, 1.0);
    point[i] =
        IsContinuous(i)
            ? std::clamp(std::lerp(axes_[i].min, axes_[i].max, u), axes_[i].min, axes_[i].max)
            : axes_[i].min + std::min(std::floor(u * levels_[i]), levels_[i] - 1.0);
  }
  return point;
}

Eigen::VectorXd Space::ToUnit(const Point& point) const {
  Eigen::VectorXd unit(Size());
  for (int i = 0; i < Size(); ++i) {
    // Halves first: the width of an axis may be beyond the largest double.
    unit[i] = IsContinuous(i) ? (0.5 * point[i] - 0.5 * axes_[i].min) /
                                    (0.5 * axes_[i].max - 0.5 * axes_[i].min)
                              : (point[i] - axes_[i].min + 0.5) / levels_[i];
  }
  return unit;
}

bool Space::HaveSameLevels(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
  return ((a - b)(discrete_).array().abs() <= 1e-9).all();
}

Point Space::AtIndex(std::uint64_t index) const {
  Point point(axes_.size());
  for (int i = 0; i < Size(); ++i) {
    const auto levels = static_cast<std::uint64_t>(levels_[i]);
    point[i] = axes_[i].min + static_cast<double>(index % levels);
    index /= levels;
  }
  return point;
}

}  // namespace rift::search
