#include "simulate.hpp"

#include <filesystem>
#include <stdexcept>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sessions/simulate/pictures.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

RunToSave SimulateFile(const SimulateRequest& request) {
  std::vector<fs::path> inputs;
  const experiment::Experiment experiment = LoadFor(request, inputs);
  const fs::path out = OutputOf(request.out, experiment.name);
  CheckNames(request, out, experiment, inputs);
  sweep::SimulatedTrial trial =
      sweep::SimulatedTrialOf(experiment, {}, experiment.seed, request.experiment, FileInputs());
  trial.start = trial.task.Start();
  WarnOfTilt(experiment);
  return {out, {experiment, trial, sweep::Simulate(trial)}};
}

void RequireNothingBesideReplay(const SimulateRequest& request) {
  if (request.replay.empty()) return;
  const bool is_changed = !request.experiment.empty() || !request.overrides.empty() ||
                          !request.start.empty() || !request.seed.empty();
  if (is_changed) {
    throw std::invalid_argument(
        "--replay takes everything from the sweep: leave EXPERIMENT, --set, --start, --seed out");
  }
}

}  // namespace

int Simulate(const SimulateRequest& request,
             const std::function<void(const sessions::Simulated&)>& show) {
  RequireNothingBesideReplay(request);
  if (const std::optional<int> exit_code = ReplayProgram(request)) return *exit_code;
  const auto [out, made] = request.replay.empty() ? SimulateFile(request) : ReplayFor(request);
  const sessions::RunFiles files(out);
  const trial::SteeringCheck check = sessions::CheckOf(made);
  if (!request.IsStdout()) sessions::SaveRun(files, made, check);
  const trial::TrialResult& result = made.run.result;
  WriteLogCopies(request.copies, result.trajectory);
  if (!request.pictures.figure.empty()) {
    report::WriteFigure(request.pictures.figure, sessions::FigureOf(made));
  }
  if (show) show(made);
  if (request.IsStdout()) {
    terminal::PrintData(trajectory::WriteRift(result.trajectory));
  } else {
    terminal::Say("log: " + files.trajectory.string());
    request.json ? terminal::PrintData(report::SimulationJson(made.experiment, made.run, check))
                 : terminal::PrintText(report::SimulationText(made.experiment, made.run));
  }
  for (const std::string& line : report::SteeringLines(check, result.limits)) terminal::Say(line);
  return result.outcome == trial::Outcome::kReached ? terminal::kDone : terminal::kNotReached;
}

}  // namespace rift::commands
