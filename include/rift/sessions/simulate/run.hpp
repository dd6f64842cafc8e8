#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/trial/steering_check.hpp"

namespace rift::sessions {

/// A simulated run and what it was made from.
struct Simulated {
  experiment::Experiment experiment;
  sweep::SimulatedTrial trial;
  sweep::SimulatedRun run;
};

/// Puts the first waypoint to `-0.28,-0.06,10`: metres, metres, degrees. Throws
/// std::invalid_argument for other words, and yaml::Error for a place that no waypoint may have.
void PutStart(const std::string& text, experiment::Experiment& experiment);

/// The trial of an experiment alone, begun as a drive is: its tag on the first waypoint. Throws
/// like sweep::SimulatedTrialOf.
sweep::SimulatedTrial TrialAlone(const experiment::Experiment& experiment,
                                 const std::string& experiment_file, const sweep::Inputs& inputs);

/// Why the run circled or did not arrive, with those proposals alone with which the same trial
/// arrives.
trial::SteeringCheck CheckOf(const Simulated& made);

/// The files of a run: DIR/trajectory.csv, DIR/summary.json ...; or, where a CSV file was named,
/// FILE.csv with FILE.summary.json ... beside it.
struct RunFiles {
  explicit RunFiles(const std::filesystem::path& out);

  std::filesystem::path trajectory, truth, commands, encoders, experiment, summary;
};

/// Throws std::invalid_argument for a folder, or a log in one, that holds a drive of the robot (its
/// stages.csv, which nothing else writes): a run that looks the same would take its place for good.
void RefuseDriveFolder(const std::filesystem::path& out);

/// Throws std::invalid_argument when a file of the run in `out` ("-": none), or one of `others`, is
/// an input or another output, or is there and not to be replaced. The run of this very experiment
/// may be: made again it comes out the same.
void CheckRunNames(const std::filesystem::path& out, const experiment::Experiment& experiment,
                   const std::vector<std::filesystem::path>& inputs,
                   const std::vector<std::filesystem::path>& others, bool force);

void SaveRun(const RunFiles& files, const Simulated& made, const trial::SteeringCheck& check);

}  // namespace rift::sessions
