// Whatever the tracker reports and however the controller is set, what it sends is finite and
// within full power.

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "rift/control/navigator.hpp"

namespace rift::control {
namespace {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : generator_(seed) {}
  double Between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }
  bool OneIn(int n) { return std::uniform_int_distribution<int>(1, n)(generator_) == 1; }

 private:
  std::mt19937_64 generator_;
};

NavigatorOptions RandomOptions(Chance& chance) {
  NavigatorOptions options;
  options.distance = {chance.Between(0.0, 10.0), chance.Between(0.0, 5.0),
                      chance.Between(0.0, 1.0)};
  options.heading = {chance.Between(0.0, 10.0), chance.Between(0.0, 5.0), chance.Between(0.0, 1.0)};
  options.derivative_kick = chance.OneIn(2);
  options.v_min = chance.Between(0.0, 0.5);
  options.v_max = chance.Between(options.v_min, 1.0);
  options.w_min = chance.Between(0.0, 0.5);
  options.w_max = chance.Between(options.w_min, 1.0);
  if (chance.OneIn(2)) options.cruise_speed = chance.Between(options.v_min, options.v_max);
  if (chance.OneIn(2)) options.slew_rate_per_s = chance.Between(0.01, 100.0);
  if (chance.OneIn(2)) options.latency.delay_s = chance.Between(0.0, 1.0);
  return options;
}

double Spoil(Chance& chance, double value) {
  if (!chance.OneIn(20)) return value;
  if (chance.OneIn(3)) return std::numeric_limits<double>::quiet_NaN();
  if (chance.OneIn(2)) return std::numeric_limits<double>::infinity();
  return chance.Between(-1e308, 1e308);
}

bool IsPower(double power) { return std::isfinite(power) && std::abs(power) <= 1.0; }

TEST_CASE("Random poses and options never make a power beyond one or not finite") {
  Chance chance(20240607);
  int driven = 0;
  for (int run = 0; run < 300; ++run) {
    std::vector<Waypoint> waypoints;
    for (int i = 0; i < 4; ++i) {
      waypoints.push_back(
          {"w", chance.Between(-1.0, 1.0), chance.Between(-1.0, 1.0), {}, chance.OneIn(2)});
    }
    Navigator navigator(RandomOptions(chance), waypoints);
    geometry::Pose2 pose{chance.Between(-1.0, 1.0), chance.Between(-1.0, 1.0), 0.0};
    for (int step = 0; step < 100; ++step) {
      const double now_s = 0.02 * step;
      pose.x_m += chance.Between(-0.02, 0.02);
      pose.y_m += chance.Between(-0.02, 0.02);
      pose.yaw_rad += chance.Between(-0.5, 0.5);
      const Decision decision = navigator.Step(
          {now_s,
           Spoil(chance, 0.02),
           now_s,
           {Spoil(chance, pose.x_m), Spoil(chance, pose.y_m), Spoil(chance, pose.yaw_rad)}});
      navigator.NoteSent(now_s, decision.power);
      REQUIRE(IsPower(decision.power.left));
      REQUIRE(IsPower(decision.power.right));
      REQUIRE(std::isfinite(decision.raw_v));
      REQUIRE(std::isfinite(decision.raw_w));
      driven += !(decision.power == WheelPower{});
    }
  }
  CHECK(driven > 10'000);
}

}  // namespace
}  // namespace rift::control
