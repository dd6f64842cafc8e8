#include "rift/report/json/likeness.hpp"

#include "rift/report/json/fields.hpp"

namespace rift::report {
namespace {

using gap::BothSides;
using nlohmann::ordered_json;

ordered_json BothJson(const BothSides& both) {
  return {{"sim", NumberOrNull(both.sim)},
          {"real", NumberOrNull(both.real)},
          {"ratio", NumberOrNull(both.Ratio())}};
}

}  // namespace

ordered_json LikenessJson(const gap::Likeness& likeness) {
  return {{"sims", likeness.sims},
          {"reals", likeness.reals},
          {"spread_m", BothJson(likeness.spread_m)},
          {"weave_m", BothJson(likeness.weave_m)},
          {"wavelength_m", BothJson(likeness.wavelength_m)},
          {"speed_mps", BothJson(likeness.speed_mps)},
          {"mean_gap_m", NumberOrNull(likeness.mean_gap_m)},
          {"mean_path_gap_m", NumberOrNull(likeness.mean_path_gap_m)},
          {"energy_m", NumberOrNull(likeness.energy_m)},
          {"energy_p", NumberOrNull(likeness.energy_p)},
          {"inside_share", NumberOrNull(likeness.inside_share)},
          {"inside_expected", NumberOrNull(likeness.inside_expected)}};
}

ordered_json LikenessJson(const sweep::DriveLikeness& likeness) {
  ordered_json json = LikenessJson(likeness.path);
  json["loop_delay_s"] = BothJson(likeness.loop_delay_s);
  json["loop_r2"] = BothJson(likeness.loop_r2);
  json["steering_gain_rad_s"] = BothJson(likeness.steering_gain_rad_s);
  json["failed_runs"] = likeness.failed_runs;
  return json;
}

ordered_json LikenessJson(const std::vector<sweep::GroupLikeness>& groups) {
  ordered_json json = ordered_json::object();
  for (const auto& [level, likeness] : groups) json[level] = LikenessJson(likeness);
  return json;
}

}  // namespace rift::report
