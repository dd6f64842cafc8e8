#pragma once

#include <map>
#include <string>

#include "recorded_logs.hpp"
#include "rift/experiment/experiment.hpp"
#include "rift/sweep/falsify/grid_sweep.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"

namespace rift::commands {

/// Where a sweep's trajectories come from, as its experiment says: logs, simulated runs, the path.
class SweepSources {
 public:
  /// Throws std::invalid_argument, naming `experiment_file`, when the experiment lacks what its
  /// kinds of candidate and reference need.
  SweepSources(const experiment::Experiment& experiment, std::string experiment_file);

  /// One trial as its row. A setting that breaks a rule of the experiment is a row that says so.
  sweep::TrialRow Evaluate(const sweep::TrialRequest& request);
  sweep::Recording Candidate(const sweep::TrialRequest& request, const sweep::Recording& reference);
  /// The simulated trial of a request; throws yaml::Error when the setting breaks a rule.
  sweep::SimulatedTrial TrialFor(const sweep::TrialRequest& request,
                                 const sweep::Recording& reference) const;
  sweep::Recording Reference(const sweep::TrialRequest& request);
  /// How far the references of a setting are apart. Nominal runs are simulated in a process of
  /// their own.
  double NoiseFloor_m(const experiment::Theta& theta);

  sweep::GridPlan Plan() const;
  /// Reads every log that some setting names, so that worker processes find them loaded.
  void LoadLogs();
  /// Everything that a trial depends on beside the experiment itself, as one line.
  std::string KeyOf(const sweep::TrialRequest& request) const;
  /// Fingerprints of every log that was read.
  std::string InputsText() const;

 private:
  void RequirePath(const experiment::PathTemplate& path, const std::string& key) const;
  std::string Filled(const experiment::PathTemplate& path, const experiment::Theta& theta,
                     const std::string& trial) const;
  std::string ReferencePath(const experiment::Theta& theta, const std::string& trial) const;
  const sweep::Recording& Nominal(const sweep::TrialRequest& request);
  double NominalNoiseFloor_m();

  const experiment::Experiment& experiment_;
  std::string experiment_file_;
  RecordedLogs candidate_logs_;
  RecordedLogs reference_logs_;
  std::map<std::uint64_t, sweep::Recording> nominal_runs_;  ///< by seed
  std::map<std::string, double> noise_floors_m_;            ///< by the references' sources
};

}  // namespace rift::commands
