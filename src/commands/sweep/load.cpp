#include <fmt/format.h>

#include <initializer_list>
#include <string>
#include <utility>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "steps.hpp"

namespace rift::commands {
namespace {

void CheckFlags(const SweepRequest& request, const experiment::Experiment& experiment) {
  const bool has_limits = !request.budget.empty() || !request.seconds.empty();
  const bool has_robot = !request.write_robot.empty();
  const std::string& file = request.experiment;
  if (experiment.goal == experiment::Goal::kCalibrate) {
    for (const auto& [is_given, flag] : std::initializer_list<std::pair<bool, std::string>>{
             {!request.budget.empty(), "--budget"},
             {!request.seconds.empty(), "--seconds"},
             {request.suggest.has_value(), "--suggest"},
             {!request.further.shrink.empty(), "--shrink"},
             {request.further.rare_event, "--rare-event"},
             {request.brief, "--brief"},
             {request.exit_code, "--exit-code"},
             {request.serve, "--serve"}}) {
      Refuse({{is_given, file + ": goal is calibrate, a fit, and " + flag + " is of a sweep"}});
    }
  }
  Refuse(
      {{experiment.goal == experiment::Goal::kGrid && has_limits,
        file + ": goal is grid, which visits every setting: --budget and --seconds limit a search "
               "(goal: falsify)"},
       {experiment.goal != experiment::Goal::kCalibrate && has_robot,
        file + ": --write-robot needs goal: calibrate (configs/calibrate.yaml)"},
       {experiment.candidate.kind == experiment::CandidateKind::kProgram && has_robot,
        file + ": --write-robot writes the robot of rift's own simulator, and candidate.kind is "
               "program: the fitted values are in calibration.json"}});
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
    // Of a shard whoever submitted it has asked.
    const bool may_be_anywhere = request.any_waypoints || !request.engine.shard.empty();
    if (!may_be_anywhere) RequireReachableWaypoints(experiment, request.experiment);
  }
  return experiment;
}

std::filesystem::path FolderFor(const SweepRequest& request,
                                const experiment::Experiment& experiment) {
  const std::filesystem::path out = OutputOf(request.out, experiment.name);
  RefuseRunFolder(out);
  const std::filesystem::path others = request.fresh ? "" : sessions::OthersFile(out);
  Refuse({{!request.fresh && sessions::HoldsOtherExperiment(out, experiment),
           fmt::format("{} holds another experiment ({}): name another folder with --out, or give "
                       "--force to replace it",
                       out.string(), (out / "experiment.yaml").string())},
          {!others.empty(),
           fmt::format("{} is there, which a sweep would replace and did not write: name another "
                       "folder than {} with --out, or give --force to replace all such files",
                       others.string(), out.string())}});
  return out;
}

}  // namespace rift::commands
