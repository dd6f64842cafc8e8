#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"

namespace rift::sessions {

/// Which drives a person asks for. Without any of the first four it is one drive.
struct SeriesRequest {
  std::optional<int> repeat;
  bool grid = false;
  bool identify = false;    ///< drive the program of an identification instead of the waypoints
  std::string suggested;    ///< folder of a sweep whose suggested.yaml is driven
  std::string before_each;  ///< a command line

  bool IsSeries() const { return grid || identify || repeat || !suggested.empty(); }

  /// Calls field(key, member, min, max, what the value is called, help) for a number, else
  /// field(key, member, [what the value is called,] help).
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("repeat", self.repeat, 1, 1000, "N",
          "drive so many times, into DIR/1, DIR/2, ...; the same command goes on after a break. A "
          "key, a closed window or a signal ends all of them; with --yes a fault as well, unless "
          "--before-each puts the scene back");
    field("grid", self.grid,
          "drive every setting of the experiment's space, reference.trials times each, and "
          "report on them against the simulator; the same command goes on after a break");
    field("identify", self.identify,
          "drive a program that tells what waypoint drives cannot, instead of the waypoints, and "
          "write DIR/sweep.yaml, which fits the simulated robot to it; half a minute of a "
          "3pi+ on 1 m by 1 m, as often as --repeat says [5]");
    field("suggested", self.suggested, "DIR",
          "drive the experiments that rift sweep --suggest wrote into its folder, into "
          "DIR/suggested; the same sweep takes their logs in");
    field("before_each", self.before_each, "COMMAND",
          "program to run before each trial of --repeat, --grid, --identify or --suggested; "
          "{trial} and the settings' names such as {surface} are filled in. It ends with 0, or "
          "prints port, camera and calibration as a line of JSON and is ended after the trial");
  }
};

/// One drive of a table of them.
struct PlannedTrial {
  experiment::Theta theta;
  std::string trial;                  ///< its name in reference.trials
  experiment::Experiment experiment;  ///< at the setting
  std::filesystem::path folder;       ///< it is there when the trial is done
  std::string label;                  ///< "surface ground, v_min 0.15, trial 2"

  /// Where it is driven into before it is done.
  std::filesystem::path Unfinished() const { return folder.string() + ".unfinished"; }
};

struct SeriesPlan {
  /// In the order of driving: floors change as seldom as can be.
  std::vector<PlannedTrial> trials;
  bool has_floors = false;  ///< the floor is part of the settings
  /// Those of the trials' settings, whose names a scene command may use.
  std::vector<experiment::Parameter> parameters;
  /// What holds the simulator against the logs: `rift sweep` runs it.
  experiment::Experiment sweep;
  bool sweeps_drives = true;  ///< the sweep was made for these drives; else they are for it
  std::string next;           ///< what a person does with the drives; empty: they are swept at once
};

/// Every setting of the experiment's grid (the paper's without a space), reference.trials times
/// each, below `out`. Throws std::invalid_argument for a space that is none of lists, or that
/// varies what no drive can.
SeriesPlan PlanGrid(const experiment::Experiment& experiment, const std::filesystem::path& out);

/// A setting that somebody chose.
struct ChosenSetting {
  std::string name;                               ///< "experiment 3"
  std::vector<experiment::Parameter> parameters;  ///< of the experiment's space, some of them
  experiment::Theta values;                       ///< of these
  std::vector<std::filesystem::path> folders{};   ///< one for each drive
};

/// Settings of an experiment, at least one, each as often as it says. The plan's sweep is the
/// experiment itself.
SeriesPlan PlanChosen(const experiment::Experiment& experiment,
                      const std::vector<ChosenSetting>& settings);

/// The drives that were asked for, below `out` unless they are suggested ones. Throws
/// std::invalid_argument where there is nothing to drive, or no fit could be made of the drives of
/// an identification.
SeriesPlan PlanSeries(const SeriesRequest& request, const experiment::Experiment& experiment,
                      const std::filesystem::path& out);

/// The experiment `count` times, into out/1, out/2, ...
SeriesPlan PlanRepeats(const experiment::Experiment& experiment, int count,
                       const std::filesystem::path& out);

}  // namespace rift::sessions
