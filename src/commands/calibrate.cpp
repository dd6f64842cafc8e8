#include "calibrate.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "calibrate_output.hpp"
#include "files.hpp"
#include "rift/commands/command.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "robot_file.hpp"

namespace rift::commands {

int Calibrate(const experiment::Experiment& experiment, const CalibrateRequest& request) {
  const auto say = [&request](const std::string& line) {
    if (!request.quiet) fmt::print(stderr, "{}\n", line);
  };
  sweep::Evaluator evaluator(experiment, request.experiment_file, FileInputs());
  const sweep::CalibrationReport report = sweep::Identify(evaluator, request.jobs, say);
  WriteFile(request.out / "experiment.yaml", experiment::WriteExperiment(experiment));
  WriteFile(request.out / "inputs.txt", evaluator.InputsText());
  const std::string json = CalibrationJson(experiment, report);
  WriteFile(request.out / "calibration.json", json);
  if (!request.robot_file.empty()) {
    WriteFile(request.robot_file,
              RobotYaml(experiment, report, evaluator.InputsText(), request.experiment_file));
  }
  fmt::print("{}", request.json ? json : CalibrationText(report));
  WriteCalibrationFigures(request.out, experiment, report);
  say(fmt::format("written: {}", (request.out / "calibration.json").string()));
  return kDone;
}

}  // namespace rift::commands
