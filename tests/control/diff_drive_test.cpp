#include "rift/control/diff_drive.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <random>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

TEST_CASE("Full power on both wheels drives straight at wheel radius times wheel speed") {
  const DiffDrive drive;
  const geometry::Pose2 end = drive.Drive({0.0, 0.0, geometry::kPi / 2.0}, {1.0, 1.0}, 2.0);
  CHECK(end.x_m == Approx(0.0).margin(1e-12));
  CHECK(end.y_m == Approx(2.0 * 0.016 * 75.4));
  CHECK(end.yaw_rad == Approx(geometry::kPi / 2.0));
}

TEST_CASE("Opposite powers turn in place and a stronger right wheel turns left") {
  const DiffDrive drive;
  const geometry::Pose2 end = drive.Drive({0.3, -0.2, 0.0}, {-0.02, 0.02}, 0.5);
  CHECK(end.x_m == Approx(0.3));
  CHECK(end.y_m == Approx(-0.2));
  CHECK(end.yaw_rad == Approx(2.0 * 0.02 * 1.2064 / 0.083 * 0.5));
}

TEST_CASE("A wheel that stands still is the centre of the turn") {
  const DiffDrive drive;
  const double turn_s = 2.0 * geometry::kPi * 0.083 / 1.2064;
  const geometry::Pose2 half = drive.Drive({}, {0.0, 1.0}, 0.5 * turn_s);
  CHECK(half.x_m == Approx(0.0).margin(1e-12));
  CHECK(half.y_m == Approx(0.083));
  const geometry::Pose2 whole = drive.Drive({}, {0.0, 1.0}, turn_s);
  CHECK(whole.Position().norm() < 1e-12);
  CHECK(std::abs(whole.yaw_rad) < 1e-12);
}

TEST_CASE("Wheel speeds and body twist are each other's inverse") {
  const DiffDrive drive;
  std::mt19937_64 generator(3);
  std::uniform_real_distribution<double> value(-5.0, 5.0);
  for (int i = 0; i < 100; ++i) {
    const Twist twist{value(generator), value(generator)};
    const Twist again = drive.BodyTwist(drive.WheelsFor(twist));
    CHECK(again.forward_mps == Approx(twist.forward_mps));
    CHECK(again.yaw_rate_rad_s == Approx(twist.yaw_rate_rad_s));
  }
}

TEST_CASE("An arc is the limit of many short straight moves") {
  const double length_m = 0.4, turn_rad = 2.5;
  const int pieces = 20'000;
  geometry::Pose2 sum;
  for (int i = 0; i < pieces; ++i) {
    sum = sum * geometry::Pose2{0.0, 0.0, 0.5 * turn_rad / pieces} *
          geometry::Pose2{length_m / pieces, 0.0, 0.5 * turn_rad / pieces};
  }
  const geometry::Pose2 arc = ArcMotion(length_m, turn_rad);
  CHECK(arc.x_m == Approx(sum.x_m).margin(1e-8));
  CHECK(arc.y_m == Approx(sum.y_m).margin(1e-8));
  CHECK(arc.yaw_rad == Approx(sum.yaw_rad));
}

TEST_CASE("An arc has no step where its series takes over") {
  const geometry::Pose2 below = ArcMotion(1.0, 0.99999e-4), above = ArcMotion(1.0, 1.00001e-4);
  CHECK(std::abs(below.x_m - above.x_m) < 1e-12);
  CHECK(below.y_m == Approx(above.y_m).epsilon(1e-4));
  CHECK(ArcMotion(1.0, 1.00001e-4).y_m == Approx(0.5e-4).epsilon(1e-4));
}

TEST_CASE("A robot without a track or with a wheel of no size is refused by name") {
  DiffDriveOptions options;
  options.track_m = 0.0;
  CHECK_THROWS_WITH(DiffDrive(options), Catch::Contains("track_m is 0"));
  options = {};
  options.wheel_radius_m = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(DiffDrive(options), std::invalid_argument);
}

}  // namespace
}  // namespace rift::control
