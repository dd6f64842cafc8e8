#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/task.hpp"
#include "rift/files/outputs.hpp"
#include "rift/flags/flags.hpp"
#include "rift/flags/usage.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::commands {

using files::CheckOutputs;
using files::Outputs;
using files::RequireFolderName;
using flags::AddFlags;
using flags::FlagMaker;
using flags::InRange;
using flags::Refuse;

/// `--set KEY=VALUE`, as often as one likes; `example` is one, such as control.v_min=0.2.
void AddSetFlag(CLI::App& app, std::vector<std::string>& overrides, const char* example);

/// `--keys`: lists every key that an experiment can have, and ends.
void AddKeysFlag(CLI::App& app);

/// `--any-waypoints`: drive them all the same.
void AddAnyWaypointsFlag(CLI::App& app, bool& any_waypoints);

/// `--force`, for every command that writes files.
void AddForceFlag(CLI::App& app, bool& force);

/// The experiment in a file, with `overrides` (`a.b=c`) on top. Throws as LoadExperiment does.
experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides = {});

/// Says what of the task does nothing (experiment::TaskNotes).
void SayTaskNotes(const experiment::Experiment& experiment, const std::string& file);
/// Says what the simulated line cannot take and what of the host does nothing (FullLineNote,
/// IdleHostNote).
void SaySimulatorNotes(const experiment::Experiment& experiment);

/// Says once that the simulated robot does not stand level, and what would make it.
void WarnOfTilt(const experiment::Experiment& experiment);

/// Files for computation, whose notes go to stderr.
sweep::Inputs FileInputs();

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

/// A run in the folder of a sweep would replace what its rows are made again from: throws
/// std::invalid_argument.
void RefuseSweepFolder(const std::filesystem::path& folder);

/// A sweep in the folder of a run would leave two experiments in one: throws std::invalid_argument.
void RefuseRunFolder(const std::filesystem::path& folder);

/// Files of other programs that a log is written to as well, whichever command made it.
struct LogCopies {
  std::string tum;
  std::string mcap;

  /// Those that were asked for, for CheckOutputs.
  std::vector<std::filesystem::path> Files() const;
  void Write(const trajectory::Trajectory& trajectory) const;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("tum", self.tum, "FILE.tum", "write the log for evo as well");
    field("mcap", self.mcap, "FILE.mcap", "write the log for Foxglove and PlotJuggler as well");
  }
};

}  // namespace rift::commands
