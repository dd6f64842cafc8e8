#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "rift/geometry/pose2.hpp"
#include "rift/simulation/body.hpp"
#include "rift/simulation/motor.hpp"
#include "rift/simulation/terrain.hpp"

namespace rift::simulation {

/// What moves, in the world frame.
struct WorldState {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< of the middle of the axle
  Eigen::Matrix3d world_from_robot = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< of the middle of the axle
  Eigen::Vector3d spin_rad_s = Eigen::Vector3d::Zero();    ///< of the chassis
  std::array<double, 2> wheel_angle_rad{};  ///< left, right against the chassis, since the start
  std::array<double, 2> wheel_rate_rad_s{};
};

/// Chassis, two wheels on hinges and a fixed caster in ODE, on a terrain. Contacts are made by
/// hand: one for each wheel, one for the caster, one for the rim. Nothing here ends the process:
/// an error that ODE reports or a number that is not finite becomes a fault, a robot that tipped
/// over or fell off a fall, and after either the world stands still. Worlds share nothing; each may
/// live in a thread of its own.
class OdeWorld {
 public:
  /// At rest on the terrain. Throws std::runtime_error when ODE refuses the bodies.
  OdeWorld(const BodyOptions& body, const Terrain& terrain, const geometry::Pose2& start,
           double step_s);
  ~OdeWorld();
  OdeWorld(OdeWorld&&) noexcept;
  OdeWorld& operator=(OdeWorld&&) noexcept;

  /// One step of step_s under the drives of the left and the right wheel. `uneven`: the way that
  /// each makes beyond what its rim turns, as a share of it.
  void Step(const std::array<WheelDrive, 2>& drives, const std::array<double, 2>& uneven = {});
  /// Sets the robot rolling straight ahead without slip.
  void Launch(double speed_mps);

  const WorldState& State() const;
  /// Grip under each wheel, left and right.
  std::array<Grip, 2> WheelGrip() const;
  /// Kinetic and potential energy of chassis and wheels; heights count from z = 0.
  double Energy_j() const;
  const std::optional<std::string>& Fault() const;
  /// That the robot tipped over or fell off the table, and where; it stays there.
  const std::optional<std::string>& Fall() const;

 private:
  struct Bodies;
  std::unique_ptr<Bodies> bodies_;
};

}  // namespace rift::simulation
