#include "rift/odometry/odometry.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"

namespace rift::odometry {
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
  const control::DiffDrive drive(options.drive);
  Odometry odometry(options);
  odometry.Update({0, 0});
  const control::WheelPower power{0.12, 0.2};
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

TEST_CASE("A larger right wheel rolls further on the same counts and turns the robot left") {
  OdometryOptions options;
  options.right_over_left = 1.02;
  CHECK(RightMetresPerCount(options) == Approx(1.02 * LeftMetresPerCount(options)));
  CHECK(0.5 * (RightMetresPerCount(options) + LeftMetresPerCount(options)) ==
        Approx(MetresPerCount(options)));
  Odometry odometry(options);
  odometry.Update({0, 0});
  const double way_m = 1000.0 * MetresPerCount(options);
  CHECK(odometry.Update({1000, 1000}).yaw_rad ==
        Approx(way_m * 2.0 * 0.02 / 2.02 / options.drive.track_m));
}

TEST_CASE("Encoder readings come back from their file as they were") {
  const std::vector<EncoderReading> readings{
      {0.02, {0, 0}}, {0.04, {-3, 12}, 5.25}, {1.0 / 3.0, {100000, -7}}};
  const std::vector<EncoderReading> read = ReadEncoders(EncodersCsv(readings), "encoders.csv");
  REQUIRE(read.size() == readings.size());
  for (size_t i = 0; i < read.size(); ++i) {
    CHECK(read[i].t_s == readings[i].t_s);
    CHECK(read[i].counts == readings[i].counts);
    CHECK(std::isnan(read[i].battery_v) == std::isnan(readings[i].battery_v));
  }
  CHECK(read[1].battery_v == 5.25);
}

TEST_CASE("A last reading that was cut short is left out as that of a log is") {
  const std::string whole = "t_s,left,right,battery_v\n0,1,1,\n1,2,3,4.5\n";
  const auto readings_of = [](const std::string& text) {
    INFO(text);
    const std::vector<EncoderReading> read = ReadEncoders(text, "e.csv");
    CHECK(read[1].counts == control::EncoderCounts{2, 3});
    return read.size();
  };
  for (const char* torn : {"2", "2,", "2,-", "2,3,4", "2,3,4,4."}) {
    CHECK(readings_of(whole + torn) == 2);
  }
  CHECK(readings_of(whole + std::string(30, '\0')) == 2);
  CHECK(readings_of(whole + "2,3,4,") == 3);
  CHECK(readings_of(whole + "2,3,4,5") == 3);
  CHECK_THROWS_WITH(ReadEncoders(whole + "2,3\n", "e.csv"), Catch::Contains("e.csv:4"));
}

TEST_CASE("A file that is no encoder log is refused with its place") {
  const auto refused = [](const char* text, const char* words) {
    CHECK_THROWS_WITH(ReadEncoders(text, "e.csv"), Catch::Contains(words));
  };
  refused("t_s,left\n0,1\n1,2\n", "e.csv: has no column 'right'");
  refused("t_s,left,right\n0,1,1\n", "has 1 reading(s)");
  refused("t_s,left,right\n0,1,1\n0,2,2\n", "e.csv:3: t_s is 0");
  refused("t_s,left,right\n0,1,1\n1,,2\n", "e.csv:3: t_s, left and right must be there");
  refused("t_s,left,right\n0,1,1\n1,1e30,2\n", "e.csv:3: a count beyond");
}

TEST_CASE("An encoder log of more rows or columns than the limit is refused before it is read") {
  std::string rows = "t_s,left,right\n";
  for (int i = 0; i < 2'000'000; ++i) rows += "0,0,0\n";
  CHECK_THROWS_WITH(ReadEncoders(rows, "e.csv"),
                    Catch::StartsWith("e.csv: 2000002 rows: at most 2000000 are taken"));
  const std::string columns = "t_s,left,right" + std::string(9'998, ',') + "\n0,0,0\n1,1,1\n";
  CHECK_THROWS_WITH(ReadEncoders(columns, "e.csv"),
                    Catch::StartsWith("e.csv:1: 10001 columns: at most 10000 are taken"));
}

TEST_CASE("Counts between two readings lie between them and there are none outside") {
  const std::vector<EncoderReading> readings{{1.0, {10, -10}}, {3.0, {20, -30}}};
  CHECK(*CountsAt(readings, 1.0) == std::pair(10.0, -10.0));
  CHECK(*CountsAt(readings, 1.5) == std::pair(12.5, -15.0));
  CHECK(*CountsAt(readings, 3.0) == std::pair(20.0, -30.0));
  CHECK_FALSE(CountsAt(readings, 0.99));
  CHECK_FALSE(CountsAt(readings, 3.01));
}

TEST_CASE("What is wrong with an encoder log is one line with its numbers") {
  const auto message = [](const std::string& text) -> std::string {
    try {
      ReadEncoders(text, "e.csv");
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  CHECK(message("t_s,left\n0,1\n1,2\n") ==
        "e.csv: has no column 'right': the columns of encoders.csv are t_s, left, right and "
        "battery_v");
  CHECK(message("t_s,left,right\n0,1,1\n") == "e.csv: has 1 reading(s), and two are needed");
  CHECK(message("t_s,left,right\n") == "e.csv: has 0 reading(s), and two are needed");
  CHECK(message("t_s,left,right\n0,1,1\n1,2,2\n0.5,3,3\n") ==
        "e.csv:4: t_s is 0.5, and the row before has 1: times must rise");
  CHECK(message("t_s,left,right\n0,1,1\n1,2,2\n2,3,\n") ==
        "e.csv:4: t_s, left and right must be there");
  CHECK(message("t_s,left,right\n,1,1\n1,2,2\n") == "e.csv:2: t_s, left and right must be there");
  CHECK(message("t_s,left,right\n0,1,-1e16\n1,2,2\n") == "e.csv:2: a count beyond 9e+15");
  CHECK(message("t_s,left,right\n0,9e15,-9e15\n1,2,2\n") == "accepted");
}

TEST_CASE("A count that was logged with a fraction is the nearest whole one, on both sides of 0") {
  const auto read = ReadEncoders("t_s,left,right\n0,2.4,-2.4\n1,2.6,-2.6\n", "e.csv");
  CHECK(read[0].counts == control::EncoderCounts{2, -2});
  CHECK(read[1].counts == control::EncoderCounts{3, -3});
}

TEST_CASE("Counts between readings are of the two readings around that moment, of each wheel") {
  const std::vector<EncoderReading> readings{
      {1.0, {10, -10}}, {3.0, {20, -30}}, {3.5, {120, 70}}, {7.5, {200, 30}}};
  CHECK(*CountsAt(readings, 2.0) == std::pair(15.0, -20.0));
  CHECK(*CountsAt(readings, 3.125) == std::pair(45.0, -5.0));
  CHECK(*CountsAt(readings, 3.5) == std::pair(120.0, 70.0));
  CHECK(*CountsAt(readings, 6.5) == std::pair(180.0, 40.0));
  CHECK(*CountsAt(readings, 7.5) == std::pair(200.0, 30.0));
  CHECK_FALSE(CountsAt({}, 1.0));
}

TEST_CASE("A robot turns by the difference of its wheels over the track, in steps of any size") {
  OdometryOptions options;
  options.counts_per_wheel_turn = 2.0 * geometry::kPi * 20.0;  // a millimetre a count
  options.drive.wheel_radius_m = 0.02;
  options.drive.track_m = 0.2;
  CHECK(YawPerCount_rad(options) == Approx(0.005));
  for (const int steps : {1, 7, 200}) {
    INFO(steps);
    Odometry odometry(options, {0.5, -1.0, 0.3});
    odometry.Update({1000, 2000});
    geometry::Pose2 end;
    for (int i = 1; i <= steps; ++i) {
      end = odometry.Update({1000 + 100 * i / steps, 2000 + 300 * i / steps});
    }
    // An arc of a radian about a point 0.2 m to the left.
    CHECK(end.yaw_rad == Approx(1.3));
    const double margin_m = steps == 1 ? 1e-9 : 1e-3;
    CHECK(end.x_m == Approx(0.5 + 0.2 * (std::sin(1.3) - std::sin(0.3))).margin(margin_m));
    CHECK(end.y_m == Approx(-1.0 + 0.2 * (std::cos(0.3) - std::cos(1.3))).margin(margin_m));
  }
}

}  // namespace
}  // namespace rift::odometry
