#include "rift/sweep/log_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rift/sweep/grid.hpp"
#include "rift/sweep/path_template.hpp"
#include "rift/sweep/statistics.hpp"

namespace rift::sweep {
namespace {

/// A parameter that neither path names would repeat the same rows under other labels.
void CheckEveryParameterIsNamed(const LogSweepPlan& plan) {
  std::vector<std::string> names = TemplateNames(plan.candidate_path);
  const std::vector<std::string> more = TemplateNames(plan.reference_path);
  names.insert(names.end(), more.begin(), more.end());
  for (const Parameter& parameter : plan.parameters) {
    if (std::find(names.begin(), names.end(), parameter.Name()) == names.end()) {
      throw std::invalid_argument(
          fmt::format("space.{} is named in neither candidate.path nor reference.path as {{{}}}",
                      parameter.key, parameter.Name()));
    }
  }
  const bool names_trial = std::find(names.begin(), names.end(), "trial") != names.end();
  if (plan.trials.size() > 1 && !names_trial) {
    throw std::invalid_argument(
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
  }
}

void Fail(TrialRow& row, const LoadedLog& log, const std::string& path) {
  row.status = log.status;
  // A reader's message begins with the path already.
  row.reason = log.reason.find(path) == log.reason.npos ? path + ": " + log.reason : log.reason;
}

TrialRow CompareTrial(const LogSweepPlan& plan, TrialRow row, const LoadedLog& candidate,
                      const LoadedLog& reference) {
  if (candidate.status != TrialStatus::kOk) {
    Fail(row, candidate, row.candidate);
  } else if (reference.status != TrialStatus::kOk) {
    Fail(row, reference, row.reference);
  } else {
    row.comparison = gap::Compare(candidate.trajectory, reference.trajectory, plan.gap);
    row.falsified = row.comparison.gap_m > plan.gap.threshold_m;
  }
  return row;
}

/// All trials of one setting, appended to the result, and how far its real trials are apart.
double CompareSetting(const LogSweepPlan& plan, const std::vector<ParameterValue>& theta,
                      const LogSource& source, std::vector<TrialRow>& rows) {
  std::vector<trajectory::Trajectory> references;
  for (const std::string& trial : plan.trials) {
    TrialRow row{.theta = theta, .trial = trial};
    row.candidate = FillTemplate(plan.candidate_path, plan.parameters, theta, trial);
    row.reference = FillTemplate(plan.reference_path, plan.parameters, theta, trial);
    const LoadedLog candidate = source(row.candidate, Side::kCandidate);
    LoadedLog reference = source(row.reference, Side::kReference);
    rows.push_back(CompareTrial(plan, std::move(row), candidate, reference));
    if (reference.status == TrialStatus::kOk) references.push_back(std::move(reference.trajectory));
  }
  return gap::NoiseFloor_m(references, plan.gap);
}

}  // namespace

SweepResult CompareLogs(const LogSweepPlan& plan, const LogSource& source) {
  CheckEveryParameterIsNamed(plan);
  SweepResult result;
  result.name = plan.name;
  result.candidate_kind = "logs";
  result.reference_kind = "logs";
  result.gap = plan.gap;
  result.parameters = plan.parameters;
  std::vector<double> noise_floors_m;
  for (const std::vector<ParameterValue>& theta : GridPoints(plan.parameters)) {
    noise_floors_m.push_back(CompareSetting(plan, theta, source, result.rows));
  }
  Summarise(result);
  for (size_t i = 0; i < noise_floors_m.size(); ++i) {
    result.settings[i].noise_floor_m = noise_floors_m[i];
  }
  return result;
}

}  // namespace rift::sweep
