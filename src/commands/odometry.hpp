#pragma once

#include <string>
#include <vector>

#include "rift/odometry/calibration.hpp"
#include "rift/odometry/program_runs.hpp"

namespace rift::commands {

/// `rift gap --odometry`.
struct OdometryRequest {
  std::vector<std::string> runs;  ///< run folders, or logs with encoders.csv beside them
  std::string program;            ///< an experiment; empty: the one in each run folder
  bool calibrate = false;
  odometry::RunOptions options;
  odometry::CalibrationOptions calibration;
  std::string json;    ///< a file, - for stdout, or empty
  bool force = false;  ///< replace that file
};

/// Compares camera, encoders and program of runs, and prints it; returns the exit code.
int MeasureOdometry(const OdometryRequest& request);

}  // namespace rift::commands
