#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "rift/search/strategy.hpp"

namespace rift::search {

/// The axes as a unit cube: 0 and 1 are the bounds of a continuous axis; an integer or categorical
/// axis is cut into equal cells, one a level.
class Space {
 public:
  /// Throws std::invalid_argument for axes that break a rule of MakeStrategy.
  explicit Space(std::vector<Axis> axes);

  int Size() const { return static_cast<int>(axes_.size()); }
  bool IsCategorical(int axis) const { return axes_[axis].kind == AxisKind::kCategorical; }
  bool IsContinuous(int axis) const { return levels_[axis] == 0.0; }
  /// Combinations of the bounds of every axis with each value of the categorical ones.
  double Corners() const;
  const std::vector<int>& ContinuousAxes() const { return continuous_; }
  const std::vector<int>& DiscreteAxes() const { return discrete_; }
  /// How many values the axis has; 0 for any.
  double Levels(int axis) const { return levels_[axis]; }

  /// Values outside of [0, 1] go to the bounds.
  Point FromUnit(const Eigen::VectorXd& unit) const;
  /// The middle of its cell where an axis has levels.
  Eigen::VectorXd ToUnit(const Point& point) const;

  /// Of two points in unit coordinates: whether their integers and categories are the same.
  bool HaveSameLevels(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const;

  /// How many points there are when there is no continuous axis and they can be counted.
  const std::optional<std::uint64_t>& Points() const { return points_; }
  /// The points in a fixed order, index < *Points().
  Point AtIndex(std::uint64_t index) const;

 private:
  std::vector<Axis> axes_;
  std::vector<double> levels_;
  std::vector<int> continuous_, discrete_;
  std::optional<std::uint64_t> points_;
};

}  // namespace rift::search
