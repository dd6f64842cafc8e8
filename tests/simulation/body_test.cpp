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

}  // namespace
}  // namespace rift::simulation
