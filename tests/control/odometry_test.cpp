#include "rift/control/odometry.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::control {
namespace {

TEST_CASE("One turn of both wheels is one circumference ahead") {
  OdometryOptions options;
  options.counts_per_wheel_turn = 360.0;
  Odometry odometry(options, {1.0, 2.0, 0.0});
  odometry.Update({1000, -500});
  const geometry::Pose2 end = odometry.Update({1360, -140});
  CHECK(end.x_m == Approx(1.0 + 2.0 * geometry::kPi * 0.016));
  CHECK(end.y_m == Approx(2.0));
}

TEST_CASE("The first reading moves nothing whatever the counters say") {
  Odometry odometry({});
  CHECK(odometry.Update({123456, -98765}) == geometry::Pose2{});
}

TEST_CASE("Odometry follows a known arc within the resolution of its counts") {
  const OdometryOptions options;
  const DiffDrive drive(options.drive);
  Odometry odometry(options);
  odometry.Update({0, 0});
  const WheelPower power{0.12, 0.2};
  geometry::Pose2 truth, measured;
  for (int step = 1; step <= 300; ++step) {
    truth = drive.Drive(truth, power, 0.01);
    const double turns_at_full_power = 75.4 * 0.01 * step / (2.0 * geometry::kPi);
    const auto counts = [&](double share) {
      return static_cast<std::int64_t>(
          std::floor(share * turns_at_full_power * options.counts_per_wheel_turn));
    };
    measured = odometry.Update({counts(power.left), counts(power.right)});
  }
  const double metres_per_count = 2.0 * geometry::kPi * 0.016 / options.counts_per_wheel_turn;
  CHECK(std::abs(geometry::WrapToPi(measured.yaw_rad - truth.yaw_rad)) <
        2.0 * metres_per_count / 0.083);
  CHECK((measured.Position() - truth.Position()).norm() < 5.0 * metres_per_count);
}

TEST_CASE("An encoder without counts is refused") {
  OdometryOptions options;
  options.counts_per_wheel_turn = 0.0;
  CHECK_THROWS_AS(Odometry(options), std::invalid_argument);
}

}  // namespace
}  // namespace rift::control
