#include "calibrate.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void WriteFigures(const std::filesystem::path& folder, const std::string& name,
                  const sweep::CalibrationReport& found) {
  const std::optional<report::Figure> figure = report::CalibrationFigure(name, found);
  if (!figure) {
    terminal::Say(
        "note: no figure: no log has a simulated run that reached the end, both before and after "
        "the fit");
    return;
  }
  WriteFigureFiles(folder, *figure);
}

}  // namespace

int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment) {
  const fs::path out = OutputOf(request.out, experiment.name);
  if (!request.write_robot.empty()) {
    CheckOutputs({request.experiment},
                 {.files = {request.write_robot}, .folder = out, .force = request.fresh});
  }
  const files::FolderLock lock(out);
  const auto say = [&request](const std::string& line) {
    if (!request.quiet) terminal::Say(line);
  };
  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  const sweep::CalibrationReport found = sweep::Identify(evaluator, request.jobs, say);
  lock.RequireInPlace();
  files::WriteFile(out / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(out / "inputs.txt", evaluator.InputsText());
  const std::string json = report::CalibrationJson(experiment, found);
  files::WriteFile(out / "calibration.json", json);
  const std::string refusal = report::WhyNotWritten(found.calibration, request.write_robot);
  const bool is_written = !request.write_robot.empty() && refusal.empty();
  if (is_written) {
    files::WriteFile(
        request.write_robot,
        report::RobotYaml(experiment, found, evaluator.InputsText(), request.experiment));
  }
  request.json ? terminal::PrintData(json) : terminal::PrintText(report::CalibrationText(found));
  WriteFigures(out / "figures", experiment.name, found);
  lock.RequireInPlace();
  say(fmt::format("written: {}", (out / "calibration.json").string()));
  if (request.write_robot.empty() || is_written) return terminal::kDone;
  return terminal::Fail(refusal, terminal::kWorseThanStart);
}

}  // namespace rift::commands
