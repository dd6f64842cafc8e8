#pragma once

#include <filesystem>
#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::commands {

struct CalibrateRequest {
  std::string experiment_file;
  std::filesystem::path out;
  std::string robot_file;  ///< empty: none
  int jobs = 1;
  bool quiet = false;
  bool json = false;
};

/// Fits, judges, writes calibration.json, experiment.yaml, inputs.txt, figures and the robot's
/// file, and prints the table; returns the exit code.
int Calibrate(const experiment::Experiment& experiment, const CalibrateRequest& request);

}  // namespace rift::commands
