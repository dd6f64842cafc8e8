#pragma once

#include <string>

#include "rift/sessions/gap/measure.hpp"
#include "rift/sessions/gap/odometry.hpp"

namespace rift::commands {

/// What `rift gap` was asked for.
struct GapRequest {
  sessions::GapJob job;  ///< but for how its logs are read
  trajectory::Format sim_format = trajectory::Format::kAuto;
  trajectory::Format real_format = trajectory::Format::kAuto;
  /// Of both sides, and of one; see trajectory::ReadOptions.
  std::string columns, sim_columns, real_columns, units, sim_units, real_units;
  std::string json, profile, figure;
  bool exit_code = false;
  bool force = false;
  /// Of runs held together with their encoders.
  bool odometry = false;
  std::string program;
  bool calibrate = false;
  odometry::RunOptions run_options;
  odometry::CalibrationOptions calibration;

  /// How the logs of each side are read.
  trajectory::ReadOptions SimLogs() const;
  trajectory::ReadOptions RealLogs() const;
  bool IsOdometry() const { return odometry || calibrate || !program.empty(); }
};

/// Holds logs together, or runs with their encoders, and prints and writes what comes out. Each
/// returns the exit code.
int MeasureLogs(const GapRequest& request);
int MeasureOdometry(const GapRequest& request);

}  // namespace rift::commands
