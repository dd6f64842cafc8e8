#include "page_evidence.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <stdexcept>
#include <utility>

#include "rift/report/text/gap_flags.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sessions {
namespace {

struct Sides {
  sweep::Recording candidate, reference;
};

/// A program runs in a process that is given up when it hangs, as in the trials of the sweep.
Sides RunAgain(const sweep::TrialRequest& request, sweep::Evaluator& evaluator) {
  const experiment::Experiment& experiment = evaluator.experiment();
  if (experiment.candidate.kind == experiment::CandidateKind::kProgram ||
      experiment.reference.kind == experiment::ReferenceKind::kProgram) {
    sweep::ProgramTrial trial = sweep::RunProgramTrial(evaluator, request);
    return {std::move(trial.candidate), std::move(trial.reference)};
  }
  Sides sides{.reference = evaluator.Reference(request)};
  sides.candidate = evaluator.Candidate(request, sides.reference);
  return sides;
}

/// Throws std::invalid_argument where one of the sides has no path now.
WorstPaths PathsOf(Sides sides, const std::string& reference_name, const gap::GapOptions& gap) {
  for (const sweep::Recording* side : {&sides.reference, &sides.candidate}) {
    if (side->status == sweep::TrialStatus::kOk) continue;
    throw std::invalid_argument(
        fmt::format("{}{}{}", side->source, side->source.empty() ? "" : ": ", side->reason));
  }
  return {report::ComparePair("simulator", sides.candidate.trajectory, reference_name,
                              sides.reference.trajectory, gap),
          std::move(sides.reference)};
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
    Add(index, reference);
    return true;
  }

  void Add(int index, const sweep::Recording& reference) {
    const sweep::TrialRow& row = result_.rows[index];
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
  }

 private:
  const sweep::SweepResult& result_;
  sweep::Evaluator& evaluator_;
  report::PageEvidence& evidence_;
  std::map<std::uint64_t, int> known_;
};

/// What the paths are drawn against. The path of a task is that of all repeats; of logs each is
/// read already; a reference that has to be run is the worst trial's alone.
void TakeReferences(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                    const sweep::Recording* worst_reference, report::PageEvidence& evidence) {
  constexpr size_t kMostReferences = 100;
  if (evaluator.experiment().objective == experiment::Objective::kOdometry) return;
  References references(result, evaluator, evidence);
  if (result.reference_kind != "logs" && result.reference_kind != "path") {
    const std::optional<int> worst = sweep::WorstRow(result);
    if (worst && worst_reference != nullptr) references.Add(*worst, *worst_reference);
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

std::optional<WorstPaths> WorstPair(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                    const std::function<void(const std::string&)>& say) {
  const std::optional<int> worst = sweep::WorstRow(result);
  if (!worst) return std::nullopt;
  const sweep::TrialRow& row = result.rows[*worst];
  const auto leave_out = [&](const std::string& why) {
    say(fmt::format(
        "note: row {}, the worst, is not drawn against its reference: run again for that, it gave "
        "no path: {}",
        *worst + 1, why));
    return std::nullopt;
  };
  try {
    return PathsOf(RunAgain(sweep::RequestOf(row), evaluator),
                   ReferenceName(result, row, evaluator.experiment()), result.gap);
  } catch (const std::invalid_argument& no_path) {
    return leave_out(no_path.what() + std::string("; the same command tries it once more"));
  } catch (const sweep::MachineTrouble& no_program) {
    return leave_out(no_program.what());
  }
}

report::PageEvidence EvidenceFor(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                 const sweep::Recording* worst_reference) {
  report::PageEvidence evidence;
  TakeReferences(result, evaluator, worst_reference, evidence);
  evidence.gap_flags = report::GapFlags(evaluator.experiment());
  for (const control::Waypoint& waypoint : evaluator.experiment().waypoints) {
    evidence.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  return evidence;
}

}  // namespace rift::sessions
