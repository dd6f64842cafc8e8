#include "load.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

/// A simulated sweep over nothing means the paper's grid; logs without a space are one setting.
bool LacksSpace(const experiment::Experiment& experiment) {
  return experiment.candidate.kind == experiment::CandidateKind::kSimulation &&
         experiment.space.parameters.empty();
}

void CheckFlags(const SweepRequest& request, const experiment::Experiment& experiment) {
  const bool has_limits = !request.budget.empty() || !request.seconds.empty();
  if (experiment.goal == experiment::Goal::kGrid && has_limits) {
    throw std::invalid_argument(
        fmt::format("{}: goal is grid, which visits every setting: --budget and --seconds limit a "
                    "search (goal: falsify)",
                    request.experiment));
  }
  if (experiment.goal != experiment::Goal::kCalibrate && !request.write_robot.empty()) {
    throw std::invalid_argument(request.experiment +
                                ": --write-robot needs goal: calibrate (configs/calibrate.yaml)");
  }
  if (experiment.candidate.kind == experiment::CandidateKind::kProgram &&
      !request.write_robot.empty()) {
    throw std::invalid_argument(
        request.experiment +
        ": --write-robot writes the robot of rift's own simulator, and candidate.kind is program: "
        "the fitted values are in calibration.json");
  }
}

void CheckFurther(const sessions::FurtherQuestions& request,
                  const experiment::Experiment& experiment) {
  if (!request.Any()) return;
  const char* flag = request.rare_event ? "--rare-event" : "--shrink";
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(
        fmt::format("{} drives further trials, and candidate.kind is logs: recorded runs cannot be "
                    "driven at other settings; set candidate.kind=simulation",
                    flag));
  }
  if (experiment.space.parameters.empty()) {
    throw std::invalid_argument(fmt::format(
        "{} needs a space: name the parameters to vary, such as space.v_min: [0.15, 0.2]", flag));
  }
  const bool is_row = !request.shrink.empty() &&
                      request.shrink.find_first_not_of("0123456789") == std::string::npos;
  if (!request.shrink.empty() && request.shrink != "worst" && !is_row) {
    throw std::invalid_argument(
        fmt::format("--shrink {}: must be the id of a row in table.csv (a whole number), or worst",
                    request.shrink));
  }
}

void NoteTooFewRepeats(const experiment::Experiment& experiment) {
  if (experiment.goal != experiment::Goal::kFalsify) return;
  const int needed = sweep::TrialsToFalsify(experiment.falsify, experiment.search.budget);
  if (experiment.falsify.most_repeats >= needed) return;
  terminal::Say(fmt::format(
      "note: falsify.most_repeats is {}, and it takes {} failing trials to falsify the first of {} "
      "settings at {:g} % confidence: settings that fail may stay undecided",
      experiment.falsify.most_repeats, needed, experiment.search.budget,
      100.0 * experiment.falsify.confidence));
}

}  // namespace

experiment::Experiment LoadFor(const SweepRequest& request) {
  // Budgets become part of the experiment, so that what is saved is what was run.
  std::vector<std::string> overrides = request.overrides;
  if (!request.budget.empty()) overrides.push_back("search.budget=" + request.budget);
  if (!request.seconds.empty()) overrides.push_back("search.max_s=" + request.seconds);
  const experiment::Experiment experiment = ReadExperiment(request.experiment, overrides);
  CheckFlags(request, experiment);
  RequireFolderName(request.out, "a sweep");
  if (experiment.candidate.kind == experiment::CandidateKind::kSimulation) {
    RequireWaypoints(experiment, request.experiment);
  }
  if (!request.any_waypoints &&
      experiment.candidate.kind == experiment::CandidateKind::kSimulation) {
    RequireReachableWaypoints(experiment, request.experiment);
  }
  return experiment;
}

experiment::Experiment PlanFor(const SweepRequest& request, experiment::Experiment loaded) {
  if (LacksSpace(loaded)) loaded.space = experiment::PaperSpace();
  CheckFurther(request.further, loaded);
  return loaded;
}

void NotePlan(const SweepRequest& request, const experiment::Experiment& loaded,
              const experiment::Experiment& planned) {
  if (LacksSpace(loaded)) {
    terminal::Say(
        fmt::format("note: {} names no space: the paper's grid of surface, v_min and v_max",
                    request.experiment));
  }
  if (loaded.candidate.kind == experiment::CandidateKind::kSimulation) WarnOfTilt(loaded);
  NoteTooFewRepeats(planned);
}

std::filesystem::path FolderFor(const SweepRequest& request,
                                const experiment::Experiment& experiment) {
  const std::filesystem::path out = OutputOf(request.out, experiment.name);
  RefuseRunFolder(out);
  if (request.fresh || !sessions::HoldsOtherExperiment(out, experiment)) return out;
  throw std::invalid_argument(
      fmt::format("{} holds another experiment ({}): name another folder with --out, or give "
                  "--force to replace "
                  "it",
                  out.string(), (out / "experiment.yaml").string()));
}

}  // namespace rift::commands
