#pragma once

#include <string>
#include <vector>

namespace rift::test {

/// One row of the authors' logs: planar pose and target as numbers of one right-handed frame, yaw
/// in radians (trials README: of the Webots logs pi/2 less than logged).
struct TrialRow {
  double t_s, x_m, y_m, yaw_rad, target_x_m, target_y_m;
};

enum class TrialKind { kReal, kWebots };

struct TrialFile {
  std::string name;  ///< "<surface>/<file>"
  std::string surface;
  double v_min = 0.0;
  double v_max = 0.0;
  std::vector<TrialRow> rows;
};

/// The authors' logs of a surface, in order of their names, or an empty list with a WARN
/// "SKIPPED" where this clone has no trials beside it.
std::vector<TrialFile> LoadTrials(const std::string& surface, TrialKind kind);

}  // namespace rift::test
