#include "world_fault.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rift::simulation {
namespace {

constexpr double kTippedOver_rad = 1.05;
constexpr double kThroughFloor_m = 0.012;
constexpr double kFallen_m = 0.5;

bool IsFinite(const WorldState& state) {
  return state.position_m.allFinite() && state.velocity_mps.allFinite() &&
         state.world_from_robot.allFinite() &&
         std::isfinite(state.wheel_rate_rad_s[0] + state.wheel_rate_rad_s[1]);
}

}  // namespace

std::optional<std::string> FaultOf(const WorldState& state, const Terrain& terrain) {
  if (!IsFinite(state)) return "the simulated motion is no longer finite";
  const Eigen::Vector3d& p = state.position_m;
  const auto at = [&p](const char* what) {
    return fmt::format("{} at ({:.3f}, {:.3f}) m", what, p.x(), p.y());
  };
  const double ground_m = terrain.HeightAt(p.x(), p.y());
  const bool is_on_table = std::isfinite(ground_m);
  if (!is_on_table && p.z() < -kFallen_m) return at("fell off the table");
  if (is_on_table && p.z() < ground_m - kThroughFloor_m) return at("sank through the floor");
  if (state.world_from_robot(2, 2) < std::cos(kTippedOver_rad)) return at("tipped over");
  return std::nullopt;
}

}  // namespace rift::simulation
