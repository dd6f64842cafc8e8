#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/sweep/falsify/evaluator.hpp"

namespace rift::sweep {
namespace {

void Fail(TrialRow& row, const Recording& recording) {
  row.status = recording.status;
  // A reader's message begins with the path already.
  const bool is_named = recording.reason.find(recording.source) != recording.reason.npos;
  row.reason =
      is_named ? recording.reason : fmt::format("{}: {}", recording.source, recording.reason);
}

bool IsFinite(const trajectory::Trajectory& path) {
  return std::all_of(path.poses.begin(), path.poses.end(), [](const auto& pose) {
    return std::isfinite(pose.x_m) && std::isfinite(pose.y_m);
  });
}

/// A path that never moves is a row of its own, not the sweep's end.
void Measure(const gap::GapOptions& options, const Recording& candidate, const Recording& reference,
             TrialRow& row) {
  if (!IsFinite(candidate.trajectory)) {
    row.status = TrialStatus::kNan;
    row.reason = fmt::format("{}: a position is not finite", candidate.source);
    return;
  }
  try {
    row.comparison = gap::Compare(candidate.trajectory, reference.trajectory, options);
    row.evidence.fingerprint = Fingerprint(candidate.trajectory);
    row.evidence.errors_m = ErrorsAlong(candidate.trajectory, reference.trajectory, options);
  } catch (const std::invalid_argument& no_path) {
    row.status = TrialStatus::kUnreadable;
    row.reason =
        fmt::format("{} against {}: {}", candidate.source, reference.source, no_path.what());
  }
}

}  // namespace

TrialRow CompareTrial(const experiment::Experiment& experiment, const TrialRequest& request,
                      const Recording& simulated, const Recording& real) {
  TrialRow row{.theta = request.theta,
               .trial = request.trial,
               .seed = request.seed,
               .is_random_draw = request.is_random_draw};
  row.candidate = simulated.source;
  row.reference = real.source;
  row.evidence.candidate_limits = simulated.limits;
  row.evidence.reference_limits = real.limits;
  if (real.status != TrialStatus::kOk) {
    Fail(row, real);
  } else if (simulated.status != TrialStatus::kOk) {
    Fail(row, simulated);
    row.falsified = experiment.falsify.falls_count && simulated.status == TrialStatus::kFell;
  } else {
    Measure(experiment.gap, simulated, real, row);
    row.falsified = row.comparison.gap_m > experiment.gap.threshold_m;
  }
  return row;
}

}  // namespace rift::sweep
