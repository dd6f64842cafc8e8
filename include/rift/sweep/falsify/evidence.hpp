#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "rift/control/options.hpp"
#include "rift/gap/options.hpp"
#include "rift/trajectory/trajectory.hpp"
#include "rift/trial/trial.hpp"

namespace rift::sweep {

/// What a trial leaves behind, beside its gap, for the question why.
struct TrialEvidence {
  std::uint64_t fingerprint = 0;  ///< of the candidate's path; 0: there is none
  std::optional<trial::LimitCounts> candidate_limits;
  std::optional<trial::LimitCounts> reference_limits;
  std::vector<Eigen::Vector2d> errors_m;  ///< ErrorsAlong; empty without a gap
  std::vector<Eigen::Vector2f> path_m;    ///< EvenPath of the candidate, for pictures
  std::vector<float> path_times_s;        ///< EvenTimes_s of it

  /// Of trials that no picture shows.
  void ForgetPath();
};

/// Steps of an EvenPath.
inline constexpr int kPathSteps = 64;

/// The points of a path at u = 0, 1/kPathSteps, ... 1, trimmed as the options say: what is drawn of
/// it. Empty when it does not move.
std::vector<Eigen::Vector2f> EvenPath(const trajectory::Trajectory& path,
                                      const gap::GapOptions& options);

/// The same of a candidate as it was held against its reference: aligned as the options say.
std::vector<Eigen::Vector2f> EvenPath(const trajectory::Trajectory& candidate,
                                      const trajectory::Trajectory& reference,
                                      const gap::GapOptions& options);

/// When the points of an EvenPath were passed, in s since the first of them. Empty when the path
/// does not move.
std::vector<float> EvenTimes_s(const trajectory::Trajectory& path, const gap::GapOptions& options);

/// Equal for paths whose poses are the same to the last bit; 0 for one without poses alone. Times
/// are left out, since some simulators stamp their rows with a wall clock; so are channels and
/// targets.
std::uint64_t Fingerprint(const trajectory::Trajectory& path);

/// Reference minus candidate, in world axes, at u = 1/8, 2/8, ... 1: enough to tell one kind of
/// failure from another. Empty when a path does not move.
std::vector<Eigen::Vector2d> ErrorsAlong(const trajectory::Trajectory& candidate,
                                         const trajectory::Trajectory& reference,
                                         const gap::GapOptions& options);

/// What the controller asked for in a recorded run: it is run again over the logged poses, towards
/// the targets that the log names, each of them a stop. `tag_offset_m` is how far ahead of the tag
/// the log was moved, and the controller saw the tag. Empty when the log has no yaw or no targets.
std::optional<trial::LimitCounts> RebuildLimits(const trajectory::Trajectory& log,
                                                const control::NavigatorOptions& options,
                                                double tag_offset_m = 0.0);

}  // namespace rift::sweep
