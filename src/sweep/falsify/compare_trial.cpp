#include "rift/sweep/falsify/compare_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "rift/gap/doubts.hpp"
#include "rift/gap/goal.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {
namespace {

bool Counts(const CountOptions& count, TrialStatus status) {
  switch (status) {
    case TrialStatus::kTimedOut:
      return count.timed_out;
    case TrialStatus::kFell:
      return count.fell;
    case TrialStatus::kLeftArena:
      return count.left_arena;
    case TrialStatus::kLost:
      return count.lost;
    default:
      return false;
  }
}

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
void Measure(const experiment::Experiment& experiment, const Recording& candidate,
             const Recording& reference, TrialRow& row) {
  const gap::GapOptions& options = experiment.gap;
  if (!IsFinite(candidate.trajectory)) {
    row.status = TrialStatus::kNan;
    row.reason = fmt::format("{}: a position is not finite", candidate.source);
    return;
  }
  for (const Recording* const one : {&candidate, &reference}) {
    if (!options.trim_standstill || !gap::IsStanding(one->trajectory, options)) continue;
    row.status = TrialStatus::kUnreadable;
    row.reason = fmt::format(
        "{}: never leaves gap.standstill_radius_m, {:g} m, so that all of it is standstill",
        one->source, options.standstill_radius_m);
    return;
  }
  try {
    row.comparison = gap::Compare(candidate.trajectory, reference.trajectory, options);
    if (const std::optional<gap::Goal> goal = WayGoalOf(experiment, row)) {
      row.way_gap_m = gap::WayGap_m(candidate.trajectory, reference.trajectory, *goal, options);
    }
    row.evidence.fingerprint = Fingerprint(candidate.trajectory);
    row.evidence.errors_m = ErrorsAlong(candidate.trajectory, reference.trajectory, options);
    row.evidence.path_m = EvenPath(candidate.trajectory, reference.trajectory, options);
    row.evidence.path_times_s = EvenTimes_s(candidate.trajectory, options);
  } catch (const std::invalid_argument& no_path) {
    row.status = TrialStatus::kUnreadable;
    row.reason =
        fmt::format("{} against {}: {}", candidate.source, reference.source, no_path.what());
  }
}

}  // namespace

TrialRow CompareTrial(const experiment::Experiment& experiment, const TrialRequest& request,
                      const Recording& simulated, const Recording& real) {
  TrialRow row = RowFor(request);
  row.candidate = simulated.source;
  row.reference = real.source;
  row.evidence.candidate_limits = simulated.limits;
  row.evidence.reference_limits = real.limits;
  if (real.status != TrialStatus::kOk) {
    Fail(row, real);
  } else if (simulated.status != TrialStatus::kOk) {
    Fail(row, simulated);
    row.falsified = Counts(experiment.falsify.count, simulated.status);
    row.left_m = simulated.left_m;
    if (row.falsified) row.evidence.fingerprint = Fingerprint(simulated.trajectory);
    row.evidence.path_m = EvenPath(simulated.trajectory, experiment.gap);
    row.evidence.path_times_s = EvenTimes_s(simulated.trajectory, experiment.gap);
  } else {
    Measure(experiment, simulated, real, row);
    row.falsified = row.CountedGap_m() > experiment.gap.threshold_m;
  }
  return row;
}

}  // namespace rift::sweep
