#pragma once

#include <filesystem>
#include <functional>
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
  std::optional<double> tag_ahead_m;  ///< of all runs; nothing: as the experiment of each has it
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
    field("tag_ahead_m", self.tag_ahead_m, -1.0, 1.0, "m",
          "the camera's point is this far ahead of the axle: its tag (else what the experiment of "
          "a run says, or 0)");
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
  std::vector<std::string> notes;            ///< what to tell of these, one line each
};

/// `name`: a run folder, or a log with encoders.csv beside it. `program`: the experiment that it
/// was of; empty: the one in its folder. Throws std::invalid_argument when there is nothing to hold
/// the log against.
LoadedRun LoadRun(const std::string& name, const std::string& program);

/// Leaves out those with the positions of one before them, and says so: a run that was copied, or
/// that a simulator without chance repeats, is no run of its own.
void LeaveOutCopies(std::vector<LoadedRun>& runs,
                    const std::function<void(const std::string&)>& say);

/// Holds camera, encoders and program of runs (at least one) together, each with the wheels and the
/// tag of its experiment; finds wheel radii and track as well where the job says so. Throws
/// std::invalid_argument when these are asked for of runs whose experiments name different robots.
odometry::OdometryResult MeasureOdometry(const std::vector<LoadedRun>& runs,
                                         const OdometryJob& job);

}  // namespace rift::sessions
