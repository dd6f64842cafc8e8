#pragma once

#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/gap/result.hpp"
#include "rift/odometry/program_runs.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::report {

/// Parameters with intervals and flags, correlations, both simulators by level and side, what is
/// left of the errors.
std::string CalibrationText(const sweep::CalibrationReport& report);

/// Why the fitted robot is not written to a file; empty when nothing speaks against it.
std::string WhyNotWritten(const sweep::Calibration& fit, const std::string& file);

/// The fitted robot as YAML to be used as `include:`: every key of trial and simulation that is not
/// at its default, the fitted ones with their intervals, and on top how and from which logs.
/// `inputs` are the logs' fingerprints, one a line.
std::string RobotYaml(const experiment::Experiment& experiment,
                      const sweep::CalibrationReport& report, const std::string& inputs,
                      const std::string& experiment_file);

/// "at a bound", "not identifiable", "no effect" or "from the prior, not the logs"; empty when
/// there is nothing to warn of.
std::string FlagOf(const sweep::CalibratedParameter& parameter);

/// Definition, a table with a row for each trial, mean gap, noise floor, what the gap consists of,
/// verdict and likeness.
std::string GapText(const gap::GapResult& result);

/// The tables of figure 14 over the cells of a grid, and what its encoders add. Empty without
/// cells.
std::string ProgramText(const std::vector<experiment::Parameter>& parameters,
                        const std::vector<sweep::ProgramCell>& cells);

std::string OdometryText(const odometry::OdometryResult& result);

/// A table, a line for each group, with what its columns mean.
std::string LikenessText(const std::vector<sweep::GroupLikeness>& groups);

/// In sentences, without what only a controller's side can tell.
std::string LikenessText(const gap::Likeness& likeness);

/// What a person wants to know of a sweep first.
std::string SweepText(const sweep::SweepResult& result);

/// Five lines for a person in a hurry: what fails, where (the settings with the largest share of
/// failures), why, how sure, what next (the first sentence of the finding).
std::string BriefText(const sweep::SweepResult& result, const sweep::Explanation& explanation);

/// Because of what and how sure; with `suggest` the next experiments as well.
std::string ExplanationText(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                            bool suggest);

/// What a failing row was shrunk to; `folder` holds the table of its trials.
std::string ShrunkText(const sweep::SweepResult& result, const sweep::ShrunkRow& found,
                       const std::string& folder);

/// The command that drives row `row` (from 0) of the table in `folder` again.
std::string ReplayCommand(const std::string& folder, size_t row);

std::string RareEventSentence(const sweep::RareEvent& event);

/// Outcome, times, waypoints, and whether the speed limit was ever binding.
std::string SimulationText(const experiment::Experiment& experiment,
                           const sweep::SimulatedRun& run);

}  // namespace rift::report
