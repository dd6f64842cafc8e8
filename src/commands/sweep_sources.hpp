#pragma once

#include <string>

#include "recorded_logs.hpp"
#include "rift/config/experiment.hpp"
#include "rift/sweep/grid_sweep.hpp"

namespace rift::commands {

/// Where a sweep's trajectories come from, as its experiment says: logs, simulated runs, the path.
class SweepSources {
 public:
  /// Throws std::invalid_argument, naming `experiment_file`, when the experiment lacks what its
  /// kinds of candidate and reference need.
  SweepSources(const config::Experiment& experiment, std::string experiment_file);

  sweep::Recording Candidate(const sweep::Theta& theta, const std::string& trial,
                             const sweep::Recording& reference);
  sweep::Recording Reference(const sweep::Theta& theta, const std::string& trial);

  sweep::GridPlan Plan() const;
  /// Fingerprints of every log that was read.
  std::string InputsText() const;

 private:
  void RequirePath(const sweep::PathTemplate& path, const std::string& key) const;
  std::uint64_t SeedOf(const std::string& trial) const;
  sweep::Recording Simulate(const config::Experiment& at, const std::string& trial,
                            const geometry::Pose2& start) const;

  const config::Experiment& experiment_;
  std::string experiment_file_;
  RecordedLogs candidate_logs_;
  RecordedLogs reference_logs_;
};

}  // namespace rift::commands
