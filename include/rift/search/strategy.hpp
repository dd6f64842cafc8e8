#pragma once

#include <span>
#include <string>
#include <vector>

namespace rift::search {

/// What the values of an axis are.
enum class AxisKind { kContinuous, kInteger, kCategorical };

/// One axis of a search space. Both bounds are inclusive; a categorical axis counts its levels from
/// 0 (min = 0, max = levels - 1).
struct Axis {
  std::string name;
  AxisKind kind = AxisKind::kContinuous;
  double min = 0.0;
  double max = 1.0;
};

/// A value for each axis, in the units of the axes; whole numbers on integer and categorical axes.
using Point = std::vector<double>;

/// A point and what it costs. The search minimises: for a falsification the loss is the robustness,
/// threshold minus gap, and below zero the point is a failure.
struct Evaluation {
  Point point;
  double loss = 0.0;  ///< NaN where the trial gave none; the search then learns to stay away
};

/// Proposes points in batches and is told what they cost. Which points come depends on the seed it
/// was made with and on what it was told, never on how many are evaluated at once: telling the same
/// evaluations again leads to the same proposals, which is how a stopped search goes on.
class Strategy {
 public:
  virtual ~Strategy() = default;

  /// The next batch, between 1 and `most` points (most >= 1); empty when there is nothing left to
  /// try.
  virtual std::vector<Point> Ask(int most) = 0;
  /// Every point of the last batch, in its order, before the next Ask.
  virtual void Tell(std::span<const Evaluation> batch) = 0;
};

}  // namespace rift::search
