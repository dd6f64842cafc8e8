#include "rift/simulation/body.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::simulation {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("A body that no robot has is refused with the key, from its limit on") {
  BodyOptions body;
  CHECK_NOTHROW(body.Check());

  body.rim_clearance_m = body.wheel_radius_m;
  CHECK_THROWS_WITH(body.Check(), Contains("rim_clearance_m") && Contains("below the axle"));
  body.rim_clearance_m = std::nextafter(body.wheel_radius_m, 0.0);
  CHECK_NOTHROW(body.Check());

  body = {};
  for (const double side : {-1.0, 1.0}) {
    body.caster_below_m = body.wheel_radius_m - body.caster_radius_m;
    body.com_ahead_m = 0.0;
    body.caster_ahead_m = side * 0.0049;
    CHECK_THROWS_WITH(body.Check(), Contains("caster_ahead_m") && Contains("0.005 m"));
    body.caster_ahead_m = side * 0.005;
    CHECK_NOTHROW(body.Check());
  }

  body = {};
  const double stiffest = body.WeightOnWheel_n() / (0.1 * body.wheel_radius_m);
  body.contact_stiffness_n_per_m = 0.999 * stiffest;
  CHECK_THROWS_WITH(body.Check(), Contains("contact_stiffness_n_per_m") && Contains("a tenth"));
  body.contact_stiffness_n_per_m = 1.001 * stiffest;
  CHECK_NOTHROW(body.Check());

  for (const double side : {-1.0, 1.0}) {
    for (const double share : {0.29, 0.31}) {
      body = {};
      body.caster_below_m =
          body.wheel_radius_m - body.caster_radius_m + side * share * std::abs(body.caster_ahead_m);
      INFO("off the ground by " << side * share << " of the caster's distance");
      if (share < 0.3) {
        CHECK_NOTHROW(body.Check());
      } else {
        CHECK_THROWS_WITH(body.Check(), Contains("caster_below_m") && Contains("caster_radius_m"));
      }
    }
  }
}

TEST_CASE("The weight is shared by wheels and caster as the lever says") {
  BodyOptions body;
  body.chassis_mass_kg = 0.2;
  body.wheel_mass_kg = 0.01;
  body.gravity_mps2 = 10.0;
  body.caster_ahead_m = 0.04;
  body.com_ahead_m = 0.0;
  CHECK(body.WeightOnWheel_n() == Approx(1.1));
  body.com_ahead_m = 0.01;  // a quarter of the chassis is the caster's
  CHECK(body.WeightOnWheel_n() == Approx(0.85));
  body.caster_ahead_m = -0.04;
  CHECK(body.WeightOnWheel_n() == Approx(1.1));
  body.com_ahead_m = -0.04;
  CHECK(body.WeightOnWheel_n() == Approx(0.1));
}

TEST_CASE("The mean of both wheels' radii is the one that is told") {
  BodyOptions body;
  body.wheel_radius_m = 0.02;
  body.right_over_left = 1.1;
  CHECK(0.5 * (body.WheelRadius_m(0) + body.WheelRadius_m(1)) == Approx(0.02));
  CHECK(body.WheelRadius_m(1) / body.WheelRadius_m(0) == Approx(1.1));
}

TEST_CASE("A robot stands where its springs carry its weight and its caster touches the plane") {
  BodyOptions body;
  body.chassis_mass_kg = 0.2;
  body.wheel_mass_kg = 0.01;
  body.com_ahead_m = 0.01;
  body.com_above_m = 0.02;
  body.caster_ahead_m = 0.04;
  body.caster_below_m = 0.008;
  body.contact_stiffness_n_per_m = 1e4;
  struct Case {
    Eigen::Vector3d gravity;
    double wheel_n, caster_n;
  };
  // Levers about the wheels' contact: the chassis at a height of 0.036 m and 0.01 m ahead, the
  // wheels at 0.016 m, the caster 0.04 m ahead.
  const Case level{{0.0, 0.0, -10.0}, 0.5 * (2.2 - 0.5), 0.5},
      down{{6.0, 0.0, -8.0}, 0.5 * (1.76 - 1.528), 1.528}, up{{-6.0, 0.0, -8.0}, 0.88, 0.0};
  for (const Case& one : {level, down, up}) {
    const Stance stance = StanceOn(body, one.gravity);
    CHECK(stance.height_m == Approx(0.016 - one.wheel_n / 1e4));
    const double ball_m =
        stance.height_m - 0.008 * std::cos(stance.pitch_rad) - 0.04 * std::sin(stance.pitch_rad);
    CHECK(ball_m == Approx(body.caster_radius_m - one.caster_n / 1e4).margin(1e-9));
  }
  body.caster_ahead_m = -0.04;  // behind: it lifts where the nose goes down
  CHECK(StanceOn(body, {0.0, 0.0, -10.0}).pitch_rad < 0.0);
}

TEST_CASE("What is wrong with a body is said with its numbers") {
  BodyOptions body;
  body.rim_clearance_m = 0.02;
  CHECK_THROWS_WITH(body.Check(),
                    "rim_clearance_m is 0.02, but the rim must lie below the axle, "
                    "wheel_radius_m 0.016");
  body = {};
  body.caster_ahead_m = 0.004;
  CHECK_THROWS_WITH(body.Check(),
                    "caster_ahead_m is 0.004, but the caster must be at least 0.005 m "
                    "from the axle");
  body = {};
  body.caster_below_m = 0.03;
  CHECK_THROWS_WITH(body.Check(),
                    Contains("caster_below_m 0.03 and caster_radius_m 0.00635 put the "
                             "ball -0.0203") &&
                        Contains("within 0.3 of caster_ahead_m"));
}

TEST_CASE("A robot is called tilted from half a degree on, to either side") {
  BodyOptions body;
  body.com_ahead_m = 0.0;
  body.contact_stiffness_n_per_m = 1e7;
  for (const double side : {-1.0, 1.0}) {
    for (const double deg : {0.49, 0.51}) {
      // So far off the floor when level: the lever times the sine of the angle.
      body.caster_below_m = body.wheel_radius_m - body.caster_radius_m -
                            side * std::abs(body.caster_ahead_m) * std::sin(deg * M_PI / 180.0);
      INFO(side << " " << deg);
      CHECK(TiltWarning(body).has_value() == (deg > 0.5));
    }
  }
}

TEST_CASE("A robot whose weight is not between axle and caster is told that it tips") {
  BodyOptions body;
  for (const double caster_m : {-0.04, 0.04}) {
    body.caster_ahead_m = caster_m;
    for (const double share : {0.0, 0.2, 1.0}) {
      body.com_ahead_m = share * caster_m;
      INFO(caster_m << " " << share);
      CHECK_FALSE(TiltWarning(body));
    }
    body.com_ahead_m = -0.01 * caster_m;
    CHECK_THAT(TiltWarning(body).value_or(""), Contains("tips off its caster, onto the edge") &&
                                                   Contains("com_ahead_m") &&
                                                   Contains("caster_ahead_m"));
    body.com_ahead_m = 1.01 * caster_m;
    CHECK_THAT(TiltWarning(body).value_or(""), Contains("tips over its caster"));
  }
  body = {};
  body.caster_ahead_m = 0.0404;  // another side than that of the default weight
  CHECK_THAT(TiltWarning(body).value_or(""),
             Contains("mass is -0.008 m ahead of the axle") && Contains("and its caster 0.0404 m"));
}

TEST_CASE("A robot that leans because it sinks in is told of its contacts, not of its caster") {
  BodyOptions body;
  body.chassis_mass_kg = 10.0;
  body.caster_below_m = body.wheel_radius_m - body.caster_radius_m;  // level but for the sinking
  CHECK_THAT(TiltWarning(body).value_or(""), Contains("contact_stiffness_n_per_m is 25000") &&
                                                 Contains("sink into the floor by") &&
                                                 !Contains("caster_below_m"));
  body.contact_stiffness_n_per_m = 1e6;
  CHECK_FALSE(TiltWarning(body));
  // A ball that hangs a little low or high is not what tilts it.
  body.contact_stiffness_n_per_m = 25000.0;
  for (const double gap_m : {-0.0003, 0.0003}) {
    body.caster_below_m = body.wheel_radius_m - body.caster_radius_m - gap_m;
    CHECK_THAT(TiltWarning(body).value_or(""), Contains("contact_stiffness_n_per_m is 25000"));
  }
}

TEST_CASE("Beyond axle and caster all of the chassis is on one of them") {
  BodyOptions body;
  body.chassis_mass_kg = 0.2;
  body.wheel_mass_kg = 0.01;
  body.gravity_mps2 = 10.0;
  for (const double caster_m : {-0.04, 0.04}) {
    body.caster_ahead_m = caster_m;
    body.com_ahead_m = 0.25 * caster_m;
    CHECK(body.WeightOnCaster_n() == Approx(0.5));
    body.com_ahead_m = 1.5 * caster_m;
    CHECK(body.WeightOnWheel_n() == Approx(0.1));
    CHECK(body.WeightOnCaster_n() == Approx(2.0));
    body.com_ahead_m = -0.5 * caster_m;
    CHECK(body.WeightOnWheel_n() == Approx(1.1));
    CHECK(body.WeightOnCaster_n() == Approx(0.0).margin(1e-12));
  }
}

TEST_CASE("A wheel that sinks too deep is told with its depth") {
  BodyOptions body;
  body.chassis_mass_kg = 0.25;
  body.wheel_mass_kg = 0.125;
  body.gravity_mps2 = 8.0;
  body.com_ahead_m = 0.0;
  body.contact_stiffness_n_per_m = 1000.0;  // 2 N on each wheel
  CHECK_THROWS_WITH(body.Check(),
                    "contact_stiffness_n_per_m is 1000, so that a wheel sinks in by 0.002 m, but "
                    "it must be at most a tenth of its radius");
}

TEST_CASE("Each warning of a tilt has its numbers and the end that is down") {
  BodyOptions body;
  body.chassis_mass_kg = 10.0;
  body.caster_below_m = body.wheel_radius_m - body.caster_radius_m;
  const auto sinking = [](const std::string& end) {
    return "the simulated robot stands tilted by 1.1 deg, nose " + end +
           ": its wheels sink into the floor by 0.0016 m and its caster by 0.0008 m under its "
           "weight of 98.16 N; simulation.body.contact_stiffness_n_per_m is 25000: raise it, or "
           "check the masses";
  };
  // The wheels carry two fifths each and sink deeper than the caster.
  CHECK(TiltWarning(body) == sinking("down"));
  body.caster_ahead_m = 0.0404;
  body.com_ahead_m = 0.008;
  CHECK(TiltWarning(body) == sinking("up"));
  body = {};
  for (const double side : {-1.0, 1.0}) {
    body.caster_ahead_m = side * 0.04;
    body.com_ahead_m = side * 0.05;
    CHECK(TiltWarning(body).value_or("") ==
          std::string("the simulated robot does not stand on its wheels and its caster but tips "
                      "over its caster: its centre of mass is ") +
              (side < 0.0 ? "-" : "") + "0.05 m ahead of the axle (simulation.body.com_ahead_m) " +
              "and its caster " + (side < 0.0 ? "-" : "") +
              "0.04 m (caster_ahead_m, negative: behind); a robot that stands has the first "
              "between 0 and the second");
  }
  body = {};
  body.caster_below_m = 0.0069;  // 2.75 mm too high, 40.4 mm behind
  CHECK(TiltWarning(body).value_or("") ==
        "the simulated robot stands tilted by 3.9 deg, nose up: its caster's ball is 0.0028 m "
        "above the floor when the robot is level; simulation.body.caster_below_m is 0.0069, and "
        "0.00965 (wheel_radius_m - caster_radius_m) would make it level");
}

}  // namespace
}  // namespace rift::simulation
