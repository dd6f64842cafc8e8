#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"

namespace rift::sessions {

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
};

/// Every setting of the experiment's grid (the paper's without a space), reference.trials times
/// each, below `out`. Throws std::invalid_argument for a space that is none of lists, or that
/// varies what no drive can.
SeriesPlan PlanGrid(const experiment::Experiment& experiment, const std::filesystem::path& out);

/// A setting that somebody chose.
struct ChosenSetting {
  std::string name;  ///< "experiment 3"
  std::vector<experiment::Parameter> parameters;
  experiment::Theta values;                      ///< of these
  std::vector<std::filesystem::path> folders{};  ///< one for each drive
};

/// Settings of an experiment, at least one, each as often as it says. The plan's sweep is the
/// experiment itself.
SeriesPlan PlanChosen(const experiment::Experiment& experiment,
                      const std::vector<ChosenSetting>& settings);

/// The experiment `count` times, into out/1, out/2, ...
SeriesPlan PlanRepeats(const experiment::Experiment& experiment, int count,
                       const std::filesystem::path& out);

}  // namespace rift::sessions
