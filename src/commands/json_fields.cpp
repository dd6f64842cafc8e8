#include "json_fields.hpp"

namespace rift::commands {

std::string Dump(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

nlohmann::ordered_json ComparisonToJson(const gap::Comparison& comparison) {
  const gap::Comparison& c = comparison;
  return {{"gap_m", NumberOrNull(c.gap_m)},
          {"u", NumberOrNull(c.gap_u)},
          {"exact_gap_m", NumberOrNull(c.exact_gap_m)},
          {"exact_u", NumberOrNull(c.exact_gap_u)},
          {"mean_error_m", NumberOrNull(c.mean_error_m)},
          {"rms_error_m", NumberOrNull(c.rms_error_m)},
          {"median_error_m", NumberOrNull(c.median_error_m)},
          {"p95_error_m", NumberOrNull(c.p95_error_m)},
          {"mean_yaw_error_rad", NumberOrNull(c.mean_yaw_error_rad)},
          {"max_yaw_error_rad", NumberOrNull(c.max_yaw_error_rad)},
          {"start_offset_m", NumberOrNull(c.start_offset_m)},
          {"start_aligned_gap_m", NumberOrNull(c.start_aligned_gap_m)},
          {"shape_gap_m", NumberOrNull(c.shape_gap_m)},
          {"real_from_sim",
           {{"x_m", c.real_from_sim.x_m},
            {"y_m", c.real_from_sim.y_m},
            {"yaw_rad", c.real_from_sim.yaw_rad}}},
          {"sim_length_m", NumberOrNull(c.sim_length_m)},
          {"real_length_m", NumberOrNull(c.real_length_m)},
          {"length_ratio", NumberOrNull(c.length_ratio)},
          {"end_error_m", NumberOrNull(c.end_error_m)},
          {"sim_standstill_share", NumberOrNull(c.sim_standstill_share)},
          {"real_standstill_share", NumberOrNull(c.real_standstill_share)},
          {"hausdorff_m", NumberOrNull(c.hausdorff_m)},
          {"frechet_m", NumberOrNull(c.frechet_m)},
          {"dtw_m", NumberOrNull(c.dtw_m)},
          {"equal_time_m", NumberOrNull(c.equal_time_m)}};
}

}  // namespace rift::commands
