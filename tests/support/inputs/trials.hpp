#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::test {

/// One of the authors' trials that lie beside a clone of the project, never in it.
struct TrialPair {
  std::string surface, v_min, v_max;  ///< as in the file names: "ground", "0.15", "0.30"
  int trial = 0;
  double published_gap_m = 0.0;
  std::filesystem::path webots, real;
};

/// Folder of the authors' trials; empty when this machine does not have it.
std::filesystem::path TrialsFolder();

/// The 48 pairs of published_gaps.csv.
std::vector<TrialPair> PublishedPairs();

/// One of the authors' logs, and how fast it was to be driven.
struct TrialLog {
  std::string name;  ///< "<surface>/<file>"
  double v_min = 0.0;
  double v_max = 0.0;
  trajectory::Trajectory log;
};

/// The authors' logs of a surface, `format` being their robot's or their simulator's, in order of
/// their names.
std::vector<TrialLog> LogsOn(const std::string& surface, trajectory::Format format);

/// A log read from a file. Throws when it cannot be read.
trajectory::Trajectory LoadTrajectory(const std::filesystem::path& path, trajectory::Format format);

std::string ReadFile(const std::filesystem::path& path);

}  // namespace rift::test

/// Ends the test case, visibly: CTest counts it as skipped.
#define RIFT_SKIP_WITHOUT_TRIALS()                                                     \
  if (rift::test::TrialsFolder().empty()) {                                            \
    WARN("SKIPPED: the authors' trials are not beside this clone (../shared/trials)"); \
    return;                                                                            \
  }
