#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>

namespace rift::benchmarks {

/// The same robot the usual way, as a yardstick: cylinders and a ball collided with a plane by ODE,
/// the caster a ball on a ball joint, wheel motors as velocity servos. Starts at the origin.
class CylinderWheelWorld {
 public:
  explicit CylinderWheelWorld(double step_s);
  ~CylinderWheelWorld();

  void Step(const std::array<double, 2>& wheel_rates_rad_s);
  Eigen::Vector2d Position_m() const;

 private:
  struct Bodies;
  std::unique_ptr<Bodies> bodies_;
};

}  // namespace rift::benchmarks
