#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/gap/goal.hpp"
#include "rift/search/strategy.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"

namespace rift::sweep {

// A setting (theta): where it comes from (the grid of a space, a point of a search), which trials
// it needs, and the forms in which it leaves for a simulator, the journal and JSON.

/// Axes for a search: a range as it is, or its natural logarithm where it is logarithmic; a list of
/// numbers as the ranks of its values; a list with a text in it as categories.
std::vector<search::Axis> AxesOf(const std::vector<experiment::Parameter>& parameters);

/// The values of the parameters at a point of those axes.
experiment::Theta ThetaAt(const std::vector<experiment::Parameter>& parameters,
                          const search::Point& point);

/// "control.v_min=0.15 " for each value, numbers in their shortest form, ambiguous text quoted: the
/// same for two settings only when all their values are. What the journal knows a setting by.
std::string SettingKey(const std::vector<experiment::Parameter>& parameters,
                       const experiment::Theta& theta);

/// The same of a trial.
std::string TrialKey(const std::vector<experiment::Parameter>& parameters,
                     const TrialRequest& request);

/// The same values, however their numbers are written.
bool IsSameSetting(const experiment::Theta& a, const experiment::Theta& b);

/// A value in JSON: a number where it is one, else its text.
nlohmann::ordered_json ValueJson(const experiment::ParameterValue& value);

/// The experiment at the setting of a trial; as it is where its candidates are no simulated runs,
/// whose parameters are names. Throws as experiment::ExperimentAt does.
experiment::Experiment ExperimentFor(const experiment::Experiment& experiment,
                                     const TrialRequest& request);

/// How far the tag of a trial's simulated robot is ahead of its axle, at its setting and in the
/// draw of its seed; 0 of other candidates, of which nobody says it. Throws as ExperimentFor does.
double TagAhead_m(const experiment::Experiment& experiment, const TrialRequest& request);

/// The controller of a log: the experiment's, with those parameters of the trial's setting that
/// name its keys ("v_max"). Parameters of a sweep over logs name columns and parts of file names;
/// some of them are also keys of the controller, and these tell how the log was driven.
control::NavigatorOptions ControllerFor(const experiment::Experiment& experiment,
                                        const TrialRequest& request);

/// Where the runs of a row's setting may end; nothing where their ends count as all their other
/// points.
std::optional<gap::Goal> WayGoalOf(const experiment::Experiment& experiment, const TrialRow& row);

/// The trial at the experiment's own values, of the first of reference.trials.
TrialRequest NominalRequest(const experiment::Experiment& experiment,
                            std::optional<std::uint64_t> seed = std::nullopt);

/// Seed of a setting's first trial, the next has the next; nothing where the candidates are logs.
std::optional<std::uint64_t> FirstSeed(const experiment::Experiment& experiment);

/// A seed beside those that are counted up from the experiment's, short enough to be read.
std::uint64_t FreshSeed(std::uint64_t seed, std::uint64_t stream);

/// Which random numbers the trials of a setting meet.
enum class TrialKind {
  kComparison,  ///< trial i of every setting the same: settings differ by themselves alone
  kRandomDraw,  ///< numbers of its own for each setting: draws are independent of each other
};

/// Each of these trials of every setting of a grid, without seeds.
std::vector<TrialRequest> GridTrials(const std::vector<experiment::Parameter>& parameters,
                                     const std::vector<std::string>& trials);

/// The first trials of a setting, one for each of reference.trials.
std::vector<TrialRequest> TrialsAt(const experiment::Experiment& experiment,
                                   const experiment::Theta& theta,
                                   TrialKind kind = TrialKind::kComparison);

/// `count` more of the same kind behind its first `before` ones, each with a seed of its own.
std::vector<TrialRequest> FurtherTrials(const experiment::Experiment& experiment,
                                        const experiment::Theta& theta, TrialKind kind, int before,
                                        int count);

/// A result without rows, its head filled in from the experiment.
SweepResult EmptyResult(const experiment::Experiment& experiment);

}  // namespace rift::sweep
