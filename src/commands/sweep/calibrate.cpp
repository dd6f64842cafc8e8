#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "progress.hpp"
#include "rift/commands/arguments/arguments.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sessions/sweep/calibrate.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "steps.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment,
              const sweep::SlurmOptions* cluster) {
  const fs::path out = FolderFor(request, experiment);
  if (!request.write_robot.empty()) {
    // It is written after these, and would take the place of one.
    CheckOutputs({request.experiment, out / "calibration.json", out / "experiment.yaml",
                  out / "inputs.txt", out / sessions::kJournalName},
                 {.files = {request.write_robot}, .folder = out, .force = request.fresh});
  }
  const files::FolderLock lock(out);
  const auto say = [&request](const std::string& line) {
    if (!request.quiet || sessions::IsNote(line)) terminal::Say(line);
  };
  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  const sessions::SweepObserver observer =
      ObserverFor(StyleFor(request.quiet, request.json_progress));
  std::optional<terminal::EndSignal> end;  // a fit on a cluster goes on there
  if (cluster == nullptr) end.emplace(kStartsOver);
  const std::optional<sweep::CalibrationReport> found = sessions::Fit(
      evaluator, {.out = out, .jobs = request.jobs, .fresh = request.fresh, .cluster = cluster},
      observer, say);
  end.reset();
  if (!found) return SayStopped(GoesOnText(request, ""));
  lock.RequireInPlace();
  sessions::SaveCalibration(out, evaluator, *found);
  const std::string refusal = report::WhyNotWritten(found->calibration, request.write_robot);
  const bool is_written = !request.write_robot.empty() && refusal.empty();
  if (is_written) {
    files::WriteFile(
        request.write_robot,
        report::RobotYaml(experiment, *found, evaluator.InputsText(), request.experiment));
  }
  request.json ? terminal::PrintData(report::CalibrationJson(experiment, *found))
               : terminal::PrintText(report::CalibrationText(*found));
  if (!sessions::SaveCalibrationFigure(out, experiment.name, *found)) {
    terminal::Say(
        "note: no figure: no log has a simulated run that reached the end, both before and after "
        "the fit");
  }
  lock.RequireInPlace();
  say(fmt::format("written: {}", (out / "calibration.json").string()));
  if (refusal.empty()) return terminal::kDone;
  return terminal::Fail(refusal, terminal::kWorseThanStart);
}

}  // namespace rift::commands
