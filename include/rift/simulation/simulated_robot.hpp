#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "rift/simulation/options.hpp"
#include "rift/trial/robot.hpp"

namespace rift::simulation {

/// The robot, its radio and its overhead camera, simulated. Same options, start, seed and calls:
/// same bytes. Instances share nothing.
class SimulatedRobot : public trial::Robot {
 public:
  /// At rest at `start` (middle of the axle, world frame), motors off, clock at 0. `image` is the
  /// heightfield of the chosen surface, if that is one (DecodeHeightImage makes it).
  /// Throws std::invalid_argument when a value of the options breaks its rule.
  SimulatedRobot(const SimulationOptions& options, const geometry::Pose2& start, std::uint64_t seed,
                 std::shared_ptr<const HeightImage> image = nullptr);

  trial::Sensed Sense() override;
  /// Throws std::invalid_argument when a power is not a number in [-1, 1].
  void Command(const control::WheelPower& power) override;
  /// Runs the whole steps that end by then; the rest of dt_s is kept for the next call, so the
  /// physics lags by less than a step and never drifts. Throws std::invalid_argument unless
  /// 0 <= dt_s <= 1e6.
  void Advance(double dt_s) override;
  /// Over the same radio, before the lines that still wait.
  void Stop() noexcept override;

  /// Where it really is, at the end of the last step.
  TruePose Truth() const { return truth_; }
  const WorldState& State() const { return world_.State(); }
  /// The power at the motors now.
  control::WheelPower HeldPower() const { return link_.Held(); }

 private:
  double Now_s() const { return 1e-9 * static_cast<double>(now_ns_); }
  void Step();
  double Drag_nm(const Grip& grip) const;
  double Uneven(int side, const Grip& grip) const;

  SimulationOptions options_;
  OdeWorld world_;
  std::array<Motor, 2> motors_;
  Link link_;
  Mocap mocap_;
  statistics::CounterRandom ground_;
  double counts_per_rev_;
  std::int64_t step_ns_;
  std::int64_t now_ns_ = 0;
  std::int64_t steps_ = 0;
  TruePose truth_;
};

}  // namespace rift::simulation
