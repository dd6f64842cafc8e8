#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/odometry/calibration.hpp"
#include "rift/odometry/program_runs.hpp"

namespace rift::sessions {

/// How runs are held together with their encoders.
struct OdometryJob {
  bool odometry = false;
  std::string program;  ///< experiment of all runs; empty: the one in the folder of each
  bool calibrate = false;
  odometry::RunOptions run_options;
  odometry::CalibrationOptions calibration;  ///< of `calibrate`

  bool IsAsked() const { return odometry || calibrate || !program.empty(); }

  /// As GapJob::Fields.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("odometry", self.odometry,
          "SIM and REAL are run folders: hold camera, encoders and program of each together");
    field("program", self.program, "EXPERIMENT",
          "the same for runs of this experiment's program, with or without encoders");
    field("calibrate_odometry", self.calibrate,
          "the same, and find wheel radii and track from all runs (squares both ways tell them "
          "best)");
    odometry::RunOptions::Fields(self.run_options, field);
    field("window_s", self.calibration.window_s, 0.2, 1e4,
          "of --calibrate-odometry: runs are cut into pieces of this length, and each counts as "
          "one observation");
  }
};

/// A run with the encoders beside it, and the experiment that it was of.
struct LoadedRun {
  odometry::ProgramRun run;
  std::optional<experiment::Experiment> experiment;
  std::vector<std::filesystem::path> files;  ///< what it was read from, there or not
};

/// `name`: a run folder, or a log with encoders.csv beside it. `program`: the experiment that it
/// was of; empty: the one in its folder. Throws std::invalid_argument when there is nothing to hold
/// the log against.
LoadedRun LoadRun(const std::string& name, const std::string& program);

/// Holds camera, encoders and program of runs (at least one) together; finds wheel radii and track
/// as well where the job says so.
odometry::OdometryResult MeasureOdometry(const std::vector<LoadedRun>& runs,
                                         const OdometryJob& job);

}  // namespace rift::sessions
