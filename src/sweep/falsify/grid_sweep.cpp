#include "rift/sweep/falsify/grid_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/sweep/falsify/labels.hpp"
#include "rift/sweep/falsify/statistics.hpp"

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
void Measure(const GridPlan& plan, const Recording& candidate, const Recording& reference,
             TrialRow& row) {
  if (!IsFinite(candidate.trajectory)) {
    row.status = TrialStatus::kNan;
    row.reason = fmt::format("{}: a position is not finite", candidate.source);
    return;
  }
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

bool Has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string InBraces(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "{" : ", {") + name + "}";
  return text.empty() ? "nothing" : text;
}

/// One log under two settings would be counted twice.
void RefuseSharedLogs(const GridPlan& plan, const LogPaths& paths) {
  const auto is_continuous = [](const experiment::Parameter& parameter) {
    return parameter.IsContinuous();
  };
  if (std::any_of(plan.parameters.begin(), plan.parameters.end(), is_continuous)) return;
  std::map<std::pair<std::string, std::string>, experiment::Theta> seen;
  for (const experiment::Theta& theta : experiment::GridPoints(plan.parameters)) {
    const std::string& trial = plan.trials.front();
    const auto fill = [&](const std::string& path) {
      return experiment::FillTemplate(path, plan.parameters, theta, trial);
    };
    const auto [first, is_new] =
        seen.try_emplace({fill(paths.candidate), fill(paths.reference)}, theta);
    if (is_new) continue;
    throw std::invalid_argument(fmt::format(
        "two settings name the same logs, {} and {}: give the path templates more digits ({})",
        SettingText(plan.parameters, first->second), SettingText(plan.parameters, theta),
        first->first.second));
  }
}

}  // namespace

void CheckPaths(const GridPlan& plan, const LogPaths& paths) {
  std::vector<std::string> names = experiment::TemplateNames(paths.candidate);
  const std::vector<std::string> more = experiment::TemplateNames(paths.reference);
  names.insert(names.end(), more.begin(), more.end());
  for (const experiment::Parameter& parameter : plan.parameters) {
    if (Has(names, parameter.Name())) continue;
    throw std::invalid_argument(fmt::format(
        "{}space.{} is in neither candidate.path nor reference.path as {{{}}}: they name {}",
        parameter.origin.empty() ? "" : parameter.origin + ": ", parameter.key, parameter.Name(),
        InBraces({names.begin(), names.end()})));
  }
  if (plan.trials.size() > 1 && !Has(names, "trial")) {
    throw std::invalid_argument(
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
  }
  RefuseSharedLogs(plan, paths);
}

TrialRow CompareTrial(const GridPlan& plan, const TrialRequest& request, const Candidate& candidate,
                      const Reference& reference) {
  TrialRow row{.theta = request.theta,
               .trial = request.trial,
               .seed = request.seed,
               .is_random_draw = request.is_random_draw};
  const Recording real = reference(request);
  const Recording simulated = candidate(request, real);
  row.candidate = simulated.source;
  row.reference = real.source;
  row.evidence.candidate_limits = simulated.limits;
  row.evidence.reference_limits = real.limits;
  if (real.status != TrialStatus::kOk) {
    Fail(row, real);
  } else if (simulated.status != TrialStatus::kOk) {
    Fail(row, simulated);
    row.falsified = plan.falls_count && simulated.status == TrialStatus::kFell;
  } else {
    Measure(plan, simulated, real, row);
    row.falsified = row.comparison.gap_m > plan.gap.threshold_m;
  }
  return row;
}

std::vector<TrialRequest> TrialsAt(const GridPlan& plan, const experiment::Theta& theta,
                                   int repeat) {
  std::vector<TrialRequest> requests;
  const size_t first = plan.trials.size() * static_cast<size_t>(repeat);
  for (size_t i = 0; i < plan.trials.size(); ++i) {
    TrialRequest request{.theta = theta, .trial = plan.trials[i]};
    if (plan.seed) request.seed = *plan.seed + first + i;
    requests.push_back(std::move(request));
  }
  return requests;
}

SweepResult EmptyResult(const GridPlan& plan) {
  SweepResult result;
  result.name = plan.name;
  result.candidate_kind = plan.candidate_kind;
  result.reference_kind = plan.reference_kind;
  result.gap = plan.gap;
  result.tag_offset_m = plan.tag_offset_m;
  result.parameters = plan.parameters;
  return result;
}

void Conclude(SweepResult& result, const NoiseFloor& noise_floor_m) {
  Summarise(result);
  for (SettingResult& setting : result.settings) {
    setting.noise_floor_m = noise_floor_m(setting.theta);
  }
}

std::optional<SweepResult> SweepGrid(const GridPlan& plan, const RunTrials& run,
                                     const NoiseFloor& noise_floor_m) {
  std::vector<TrialRequest> requests;
  for (const experiment::Theta& theta : experiment::GridPoints(plan.parameters)) {
    for (TrialRequest& request : TrialsAt(plan, theta)) requests.push_back(std::move(request));
  }
  std::optional<std::vector<TrialRow>> rows = run(std::move(requests));
  if (!rows) return std::nullopt;
  SweepResult result = EmptyResult(plan);
  result.rows = std::move(*rows);
  Conclude(result, noise_floor_m);
  return result;
}

}  // namespace rift::sweep
