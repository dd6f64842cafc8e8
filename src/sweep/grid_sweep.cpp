#include "rift/sweep/grid_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <set>
#include <stdexcept>

#include "rift/sweep/grid.hpp"
#include "rift/sweep/path_template.hpp"
#include "rift/sweep/statistics.hpp"

namespace rift::sweep {
namespace {

void Fail(TrialRow& row, const Recording& recording) {
  row.status = recording.status;
  // A reader's message begins with the path already.
  const bool is_named = recording.reason.find(recording.source) != recording.reason.npos;
  row.reason =
      is_named ? recording.reason : fmt::format("{}: {}", recording.source, recording.reason);
}

/// A path that never moves is a row of its own, not the sweep's end.
void Measure(const GridPlan& plan, const Recording& candidate, const Recording& reference,
             TrialRow& row) {
  try {
    row.comparison = gap::Compare(candidate.trajectory, reference.trajectory, plan.gap);
    row.evidence.fingerprint = Fingerprint(candidate.trajectory);
    row.evidence.errors_m = ErrorsAlong(candidate.trajectory, reference.trajectory, plan.gap);
  } catch (const std::invalid_argument& no_path) {
    row.status = TrialStatus::kUnreadable;
    row.reason =
        fmt::format("{} against {}: {}", candidate.source, reference.source, no_path.what());
  }
}

TrialRow CompareTrial(const GridPlan& plan, TrialRow row, const Recording& candidate,
                      const Recording& reference) {
  row.candidate = candidate.source;
  row.reference = reference.source;
  row.evidence.candidate_limits = candidate.limits;
  row.evidence.reference_limits = reference.limits;
  if (reference.status != TrialStatus::kOk) {
    Fail(row, reference);
  } else if (candidate.status != TrialStatus::kOk) {
    Fail(row, candidate);
  } else {
    Measure(plan, candidate, reference, row);
    row.falsified = row.comparison.gap_m > plan.gap.threshold_m;
  }
  return row;
}

/// All trials of one setting, appended to the rows; returns how far its references are apart.
double CompareSetting(const GridPlan& plan, const Theta& theta, const Candidate& candidate,
                      const Reference& reference, std::vector<TrialRow>& rows) {
  std::vector<trajectory::Trajectory> references;
  std::set<std::string> sources;
  for (const std::string& trial : plan.trials) {
    Recording real = reference(theta, trial);
    const Recording simulated = candidate(theta, trial, real);
    rows.push_back(CompareTrial(plan, {.theta = theta, .trial = trial}, simulated, real));
    const bool is_new = sources.insert(real.source).second;  // one path twice is no repeat
    if (real.status == TrialStatus::kOk && is_new) {
      references.push_back(std::move(real.trajectory));
    }
  }
  return gap::NoiseFloor_m(references, plan.gap);
}

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

void CheckPaths(const GridPlan& plan, const LogPaths& paths) {
  std::vector<std::string> names = TemplateNames(paths.candidate);
  const std::vector<std::string> more = TemplateNames(paths.reference);
  names.insert(names.end(), more.begin(), more.end());
  for (const Parameter& parameter : plan.parameters) {
    if (Has(names, parameter.Name())) continue;
    throw std::invalid_argument(
        fmt::format("space.{} is named in neither candidate.path nor reference.path as {{{}}}",
                    parameter.key, parameter.Name()));
  }
  if (plan.trials.size() > 1 && !Has(names, "trial")) {
    throw std::invalid_argument(
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
  }
}

SweepResult CompareGrid(const GridPlan& plan, const Candidate& candidate,
                        const Reference& reference) {
  SweepResult result;
  result.name = plan.name;
  result.candidate_kind = plan.candidate_kind;
  result.reference_kind = plan.reference_kind;
  result.gap = plan.gap;
  result.tag_offset_m = plan.tag_offset_m;
  result.parameters = plan.parameters;
  std::vector<double> noise_floors_m;
  for (const Theta& theta : GridPoints(plan.parameters)) {
    noise_floors_m.push_back(CompareSetting(plan, theta, candidate, reference, result.rows));
  }
  Summarise(result);
  assert(noise_floors_m.size() == result.settings.size());
  for (size_t i = 0; i < noise_floors_m.size(); ++i) {
    result.settings[i].noise_floor_m = noise_floors_m[i];
  }
  return result;
}

}  // namespace rift::sweep
