#include "page_evidence.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <stdexcept>

#include "rift/report/text/gap_flags.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sessions {
namespace {

sweep::Recording Finished(sweep::Recording recording) {
  if (recording.status != sweep::TrialStatus::kOk) {
    throw std::runtime_error(fmt::format("a row that had a gap has none now: {}: {}",
                                         recording.source, recording.reason));
  }
  return recording;
}

/// The simulated and the reference path of a row, computed again.
report::ComparedPair PathsOf(const sweep::SweepResult& result, const sweep::TrialRow& row,
                             const std::string& name, sweep::Evaluator& evaluator) {
  const sweep::TrialRequest request = sweep::RequestOf(row);
  const sweep::Recording reference = Finished(evaluator.Reference(request));
  const sweep::Recording candidate = Finished(evaluator.Candidate(request, reference));
  return report::ComparePair("simulator", candidate.trajectory, name, reference.trajectory,
                             result.gap);
}

std::string PathName(const experiment::Experiment& experiment) {
  return experiment.program.segments.empty() ? "waypoint path" : "program path";
}

std::string ReferenceName(const sweep::SweepResult& result, const sweep::TrialRow& row,
                          const experiment::Experiment& experiment) {
  if (result.reference_kind == "logs") return "robot, trial " + row.trial;
  if (result.reference_kind == "nominal") return "undisturbed run";
  if (result.reference_kind == "program") return "reference run " + row.trial;
  return PathName(experiment);
}

/// The references of a page by what they are, equal ones once.
class References {
 public:
  References(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
             report::PageEvidence& evidence)
      : result_(result), evaluator_(evaluator), evidence_(evidence) {
    evidence.reference_of_row.assign(result.rows.size(), -1);
  }

  /// Takes that of the row. False when there is none: at its setting no task may be possible.
  bool Take(int index) {
    const sweep::TrialRow& row = result_.rows[index];
    if (row.status == sweep::TrialStatus::kInvalid) return false;
    sweep::Recording reference;
    try {
      reference = evaluator_.Reference(sweep::RequestOf(row));
    } catch (const std::invalid_argument&) {
      return false;
    } catch (const yaml::Error&) {
      return false;
    }
    if (reference.status != sweep::TrialStatus::kOk) return false;
    const auto [found, is_new] = known_.try_emplace(sweep::Fingerprint(reference.trajectory),
                                                    static_cast<int>(evidence_.references.size()));
    if (is_new) {
      evidence_.references.push_back({ReferenceName(result_, row, evaluator_.experiment()),
                                      sweep::EvenPath(reference.trajectory, result_.gap)});
      // Nobody drove the path of a task.
      if (result_.reference_kind != "path") {
        evidence_.references.back().times_s = sweep::EvenTimes_s(reference.trajectory, result_.gap);
      }
    }
    evidence_.reference_of_row[index] = found->second;
    return true;
  }

 private:
  const sweep::SweepResult& result_;
  sweep::Evaluator& evaluator_;
  report::PageEvidence& evidence_;
  std::map<std::uint64_t, int> known_;
};

/// What the paths are drawn against. The path of a task is that of all repeats; of logs each is
/// read already; a reference that has to be computed is the worst trial's alone.
void TakeReferences(const sweep::SweepResult& result, sweep::Evaluator& evaluator, bool may_compute,
                    report::PageEvidence& evidence) {
  constexpr size_t kMostReferences = 100;
  if (evaluator.experiment().objective == experiment::Objective::kOdometry) return;
  References references(result, evaluator, evidence);
  if (result.reference_kind != "logs" && result.reference_kind != "path") {
    if (!may_compute) return;
    if (const std::optional<int> worst = sweep::WorstRow(result)) references.Take(*worst);
    return;
  }
  for (const sweep::SettingResult& setting : result.settings) {
    for (const int row : setting.rows) {
      if (evidence.references.size() >= kMostReferences) return;
      if (!references.Take(row)) continue;
      if (result.reference_kind == "logs") continue;
      for (const int repeat : setting.rows) {
        evidence.reference_of_row[repeat] = evidence.reference_of_row[row];
      }
      break;
    }
  }
}

}  // namespace

std::optional<report::ComparedPair> WorstPair(const sweep::SweepResult& result,
                                              sweep::Evaluator& evaluator) {
  const std::optional<int> worst = sweep::WorstRow(result);
  if (!worst) return std::nullopt;
  const sweep::TrialRow& row = result.rows[*worst];
  return PathsOf(result, row, ReferenceName(result, row, evaluator.experiment()), evaluator);
}

report::PageEvidence EvidenceFor(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                 bool may_compute) {
  report::PageEvidence evidence;
  TakeReferences(result, evaluator, may_compute, evidence);
  evidence.gap_flags = report::GapFlags(evaluator.experiment());
  for (const control::Waypoint& waypoint : evaluator.experiment().waypoints) {
    evidence.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  return evidence;
}

}  // namespace rift::sessions
