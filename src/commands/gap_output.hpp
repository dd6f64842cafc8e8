#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/gap/verdict.hpp"
#include "rift/trajectory/trajectory.hpp"

namespace rift::commands {

/// All that `rift gap` found out.
struct GapEvidence {
  struct Trial {
    std::string path;
    gap::Comparison comparison;
  };

  gap::GapOptions options;
  double tag_offset_m = 0.0;
  std::string sim_path;
  trajectory::Trajectory sim;
  std::vector<Trial> trials;
  std::vector<trajectory::Trajectory> reals;  ///< one for each trial
  double mean_gap_m = gap::kNotComputed;
  double noise_floor_m = gap::kNotComputed;  ///< NaN for one real log
  gap::RepeatVerdict verdict;
  std::optional<gap::Likeness> likeness;  ///< only with repeats of the simulator
};

/// Fills in the mean, the noise floor and the verdict from the trials.
void Judge(GapEvidence& evidence);

std::string GapText(const GapEvidence& evidence);
std::string GapJson(const GapEvidence& evidence);
/// Columns real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m; `real` counts from 1.
std::string ProfileCsv(const GapEvidence& evidence);
/// Paths, error over u and error distribution in one file, SVG or PNG by its name.
void WriteGapFigure(const std::filesystem::path& path, const GapEvidence& evidence);

}  // namespace rift::commands
