#pragma once

#include <string>

#include "rift/gap/result.hpp"

namespace rift::report {

/// `rift gap --json`: {definition, trials, mean_gap_m, noise_floor_m, verdict, repeats, likeness}.
std::string GapJson(const gap::GapResult& result);

/// Columns real,u,error_m,yaw_error_rad,sim_x_m,sim_y_m,real_x_m,real_y_m; `real` counts from 1.
std::string ProfileCsv(const gap::GapResult& result);

}  // namespace rift::report
