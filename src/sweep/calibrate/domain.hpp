#pragma once

#include <Eigen/Core>
#include <functional>

namespace rift::sweep {

/// Where a fit may go, in shares of the ranges: in [0, 1], and no rule between keys is broken.
class Domain {
 public:
  using Contained = std::function<bool(const Eigen::VectorXd& shares)>;

  /// Without a question to ask all of [0, 1]. `start` stands for the middle of a domain so small
  /// that chance does not meet it.
  explicit Domain(Contained contained = {}, const Eigen::VectorXd& start = {});

  bool Contains(const Eigen::VectorXd& shares) const { return !contained_ || contained_(shares); }
  /// The shares themselves, or where the way to them from the middle of the domain leaves it.
  Eigen::VectorXd Nearest(const Eigen::VectorXd& shares) const;

 private:
  Contained contained_;
  Eigen::VectorXd middle_;
};

}  // namespace rift::sweep
