#include "calibrate.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "files.hpp"
#include "rift/commands/command.hpp"
#include "rift/report/figures/calibration_figure.hpp"
#include "rift/report/json/calibration.hpp"
#include "rift/report/text/calibration.hpp"
#include "rift/sweep/calibrate/identification.hpp"

namespace rift::commands {
namespace {

void WriteFigures(const std::filesystem::path& folder, const std::string& name,
                  const sweep::CalibrationReport& found) {
  const std::optional<report::Figure> figure = report::CalibrationFigure(name, found);
  if (!figure) {
    fmt::print(stderr,
               "note: no figure: no log has a simulated run that reached the end, both "
               "before and after the fit\n");
    return;
  }
  WriteFile(folder / (figure->name + ".svg"), report::Render(*figure, report::FigureFormat::kSvg));
  WriteFile(folder / (figure->name + ".png"), report::Render(*figure, report::FigureFormat::kPng));
}

}  // namespace

int Calibrate(const experiment::Experiment& experiment, const CalibrateRequest& request) {
  const auto say = [&request](const std::string& line) {
    if (!request.quiet) fmt::print(stderr, "{}\n", line);
  };
  sweep::Evaluator evaluator(experiment, request.experiment_file, FileInputs());
  const sweep::CalibrationReport found = sweep::Identify(evaluator, request.jobs, say);
  WriteFile(request.out / "experiment.yaml", experiment::WriteExperiment(experiment));
  WriteFile(request.out / "inputs.txt", evaluator.InputsText());
  const std::string json = report::CalibrationJson(experiment, found);
  WriteFile(request.out / "calibration.json", json);
  if (!request.robot_file.empty()) {
    WriteFile(request.robot_file, report::RobotYaml(experiment, found, evaluator.InputsText(),
                                                    request.experiment_file));
  }
  fmt::print("{}", request.json ? json : report::CalibrationText(found));
  WriteFigures(request.out / "figures", experiment.name, found);
  say(fmt::format("written: {}", (request.out / "calibration.json").string()));
  return kDone;
}

}  // namespace rift::commands
