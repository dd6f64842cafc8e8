#include "rift/odometry/calibration.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

#include "rift/control/program.hpp"

namespace rift::odometry {
namespace {

struct Planted {
  double wheel_radius_m = 0.0162;
  double right_over_left = 1.008;
  double track_m = 0.0851;
};

struct CameraNoise {
  double place_m = 0.001;
  double yaw_rad = 0.015;
};

OdometryOptions With(const Planted& planted) {
  OdometryOptions options;
  options.drive.wheel_radius_m = planted.wheel_radius_m;
  options.right_over_left = planted.right_over_left;
  options.drive.track_m = planted.track_m;
  return options;
}

/// A square driven by a robot with the planted wheels, whose program knows nothing of them: what
/// the wheels roll is that of the ideal robot, with a little unsteadiness of each.
RunLog DriveSquare(const Planted& planted, double turn_deg, const CameraNoise& noise,
                   std::mt19937_64& generator) {
  control::ProgramOptions square{.power = 0.25, .laps = 4};
  square.segments = {{.straight_m = 0.8}, {.turn_deg = turn_deg}};
  const control::Program program(square, {}, {});
  const OdometryOptions truth = With(planted);
  std::normal_distribution<double> normal;
  const double left_pull = 1.0 + 0.01 * normal(generator);
  geometry::Pose2 at{0.2, -0.1, 0.4};
  double left = 0.0, right = 0.0;
  RunLog run{.name = "square"};
  constexpr double kStep_s = 0.02, kRest_s = 1.0;
  for (int i = 0; i * kStep_s < program.Duration_s() + 2.0 * kRest_s; ++i) {
    const double t_s = i * kStep_s;
    run.encoders.push_back({t_s,
                            {static_cast<std::int64_t>(std::floor(left)),
                             static_cast<std::int64_t>(std::floor(right))}});
    if (i % 3 == 0) {
      run.camera.poses.push_back({.t_s = t_s,
                                  .x_m = at.x_m + noise.place_m * normal(generator),
                                  .y_m = at.y_m + noise.place_m * normal(generator),
                                  .yaw_rad = at.yaw_rad + noise.yaw_rad * normal(generator)});
    }
    const control::WheelPower power = program.MeanPower(t_s - kRest_s, t_s - kRest_s + kStep_s);
    const double counts_per_power = 75.4 / (2.0 * geometry::kPi) * 358.3 * kStep_s;
    const double left_by = left_pull * power.left * counts_per_power;
    const double right_by = power.right * counts_per_power;
    left += left_by;
    right += right_by;
    const double left_m = left_by * LeftMetresPerCount(truth);
    const double right_m = right_by * RightMetresPerCount(truth);
    at = at * control::ArcMotion(0.5 * (left_m + right_m), (right_m - left_m) / planted.track_m);
  }
  return run;
}

std::vector<RunLog> Squares(const Planted& planted, int each, std::uint64_t seed,
                            const CameraNoise& noise = {}) {
  std::mt19937_64 generator(seed);
  std::vector<RunLog> runs;
  for (int i = 0; i < each; ++i) {
    runs.push_back(DriveSquare(planted, 90.0, noise, generator));
    runs.push_back(DriveSquare(planted, -90.0, noise, generator));
  }
  return runs;
}

bool Holds(const Estimate& estimate, double planted) {
  return estimate.interval.low <= planted && planted <= estimate.interval.high;
}

/// How far estimates are off, in half widths of their intervals: 0.5 where these are honest.
struct Scatter {
  double squares = 0.0;
  int inside = 0;

  void Add(const Estimate& estimate, double planted) {
    const double half = 0.5 * (estimate.interval.high - estimate.interval.low);
    squares += std::pow((estimate.value - planted) / half, 2);
    inside += Holds(estimate, planted);
  }
};

TEST_CASE("Planted wheels and track lie inside the 95 % intervals of calibrations as promised") {
  constexpr int kRepeats = 60;
  std::mt19937_64 generator(11);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  Scatter radius, ratio, track;
  for (int i = 0; i < kRepeats; ++i) {
    const Planted planted{0.016 * (1.0 + 0.03 * share(generator)), 1.0 + 0.02 * share(generator),
                          0.083 * (1.0 + 0.04 * share(generator))};
    const OdometryCalibration found =
        CalibrateOdometry(Squares(planted, 2, 100 + static_cast<std::uint64_t>(i)), {});
    radius.Add(found.wheel_radius_m, planted.wheel_radius_m);
    ratio.Add(found.right_over_left, planted.right_over_left);
    track.Add(found.track_m, planted.track_m);
    CHECK(found.track_m.is_told);
    CHECK(found.noise_m == Approx(0.001).epsilon(0.2));
  }
  for (const Scatter& scatter : {radius, ratio, track}) {
    CHECK(scatter.inside >= 53);  // 18 of 20 is 54 of 60
    const double rms = std::sqrt(scatter.squares / kRepeats);
    CHECK(rms > 0.3);
    CHECK(rms < 0.7);
  }
}

TEST_CASE("A calibration takes most of the drift away") {
  const Planted planted;
  const std::vector<RunLog> runs = Squares(planted, 2, 5);
  const OdometryCalibration found = CalibrateOdometry(runs, {});
  const std::optional<Umbmark> before = UmbmarkOf(runs, {});
  const std::optional<Umbmark> after = UmbmarkOf(runs, found.Applied({}));
  REQUIRE((before && after));
  CHECK(before->ccw_runs == 2);
  CHECK(before->cw_runs == 2);
  CHECK(before->largest_m > 0.05);
  Eigen::Vector2d ccw_m = Eigen::Vector2d::Zero();
  for (const RunLog* run : {&runs[0], &runs[2]}) {
    const auto path = OdometryPath(run->encoders, {}, OdometryStart(*run));
    const Eigen::Vector2d error_m =
        path.poses.back().Position() - run->camera.poses.back().Position();
    const geometry::Pose2 start_from_world =
        geometry::Inverse(geometry::Pose2{0.0, 0.0, OdometryStart(*run).yaw_rad});
    ccw_m += 0.5 * (start_from_world * error_m);
  }
  CHECK((before->ccw_m - ccw_m).norm() < 1e-9);
  CHECK((before->cw_m - ccw_m).norm() > 0.01);
  CHECK(after->largest_m < 0.2 * before->largest_m);
}

TEST_CASE("Poses of another tag hardly move a calibration") {
  const Planted planted;
  std::vector<RunLog> runs = Squares(planted, 2, 6);
  for (RunLog& run : runs) {
    for (size_t i = 7; i < run.camera.poses.size(); i += 40) run.camera.poses[i].x_m += 0.3;
  }
  const OdometryCalibration found = CalibrateOdometry(runs, {});
  CHECK(found.wheel_radius_m.value == Approx(planted.wheel_radius_m).epsilon(0.005));
  CHECK(found.track_m.value == Approx(planted.track_m).epsilon(0.01));
}

TEST_CASE("Runs without turns tell no track and say so") {
  control::ProgramOptions line{.power = 0.25};
  std::vector<RunLog> runs;
  std::mt19937_64 generator(4);
  for (int i = 0; i < 4; ++i) {
    RunLog run = DriveSquare({.right_over_left = 1.0}, 90.0, {}, generator);
    // The first side alone.
    const double end_s = 1.0 + 0.8 / (0.25 * 75.4 * 0.016) - 0.1;
    std::erase_if(run.camera.poses, [&](const auto& pose) { return pose.t_s > end_s; });
    std::erase_if(run.encoders, [&](const auto& reading) { return reading.t_s > end_s; });
    runs.push_back(std::move(run));
  }
  const OdometryCalibration found = CalibrateOdometry(runs, {}, {.window_s = 0.8});
  CHECK_FALSE(found.track_m.is_told);
  CHECK(found.wheel_radius_m.is_told);
  CHECK(found.Applied({}).drive.track_m == OdometryOptions{}.drive.track_m);
}

TEST_CASE("Too few windows are refused with what to do") {
  std::mt19937_64 generator(4);
  const std::vector<RunLog> runs{DriveSquare({}, 90.0, {}, generator)};
  CHECK_THROWS_WITH(CalibrateOdometry(runs, {}, {.window_s = 1000.0}),
                    Catch::Contains("smaller window_s"));
}

TEST_CASE("Without noise the planted wheels, track and tag are found, in intervals about them") {
  const Planted planted;
  std::vector<RunLog> runs = Squares(planted, 2, 5, {0.0, 0.0});
  for (RunLog& run : runs) {
    for (trajectory::StampedPose& pose : run.camera.poses) {
      pose.x_m += 0.02 * std::cos(pose.yaw_rad);  // the tag sits 2 cm ahead of the axle
      pose.y_m += 0.02 * std::sin(pose.yaw_rad);
    }
  }
  const OdometryCalibration found = CalibrateOdometry(runs, {});
  CHECK(found.wheel_radius_m.value == Approx(planted.wheel_radius_m).epsilon(5e-4));
  CHECK(found.right_over_left.value == Approx(planted.right_over_left).epsilon(5e-4));
  CHECK(found.track_m.value == Approx(planted.track_m).epsilon(2e-3));
  CHECK(found.tag_ahead_m.value == Approx(0.02).margin(5e-4));
  CHECK(found.runs == 4);
  CHECK(found.noise_m < 5e-4);
  CHECK(found.noise_yaw_rad < 5e-3);
  // An interval is as wide as Student's t for its confidence, of a logarithm but for the tag.
  const OdometryCalibration half = CalibrateOdometry(runs, {}, {.confidence = 0.5});
  const double degrees = static_cast<double>(found.windows - 6);
  const double wider =
      statistics::StudentQuantile(degrees, 0.975) / statistics::StudentQuantile(degrees, 0.75);
  for (const auto& [all, some] : {std::pair{found.wheel_radius_m, half.wheel_radius_m},
                                  {found.right_over_left, half.right_over_left},
                                  {found.track_m, half.track_m}}) {
    CHECK(all.is_told);
    CHECK(all.interval.low * all.interval.high == Approx(all.value * all.value));
    CHECK(std::log(all.interval.high / all.value) ==
          Approx(wider * std::log(some.interval.high / some.value)));
  }
  const Estimate &tag = found.tag_ahead_m, &tag_half = half.tag_ahead_m;
  CHECK(tag.is_told);
  CHECK(0.5 * (tag.interval.low + tag.interval.high) == Approx(tag.value));
  CHECK(tag.interval.high - tag.value == Approx(wider * (tag_half.interval.high - tag_half.value)));
}

TEST_CASE("The noise of a calibration is the camera's, and poses far off hardly count") {
  std::vector<RunLog> runs = Squares({}, 2, 8, {0.002, 0.03});
  const OdometryCalibration found = CalibrateOdometry(runs, {});
  CHECK(found.noise_m == Approx(0.002).epsilon(0.15));
  CHECK(found.noise_yaw_rad == Approx(0.03).epsilon(0.15));
  for (RunLog& run : runs) {
    for (std::size_t i = 7; i < run.camera.poses.size(); i += 40) run.camera.poses[i].x_m += 0.3;
  }
  const OdometryCalibration off = CalibrateOdometry(runs, {});
  CHECK(off.wheel_radius_m.value == Approx(found.wheel_radius_m.value).epsilon(2e-3));
  CHECK(off.track_m.value == Approx(found.track_m.value).epsilon(5e-3));
  CHECK(off.noise_m == Approx(0.002).epsilon(0.2));
}

/// Both wheels turn by these counts in each eighth of a second, of which there are so many.
RunLog Straight(int eighths, int left, int right, int every = 1) {
  RunLog run{.name = "straight"};
  for (int i = 0; i < eighths; ++i) {
    const double t_s = 0.125 * i;
    const int turns = i / every;
    run.encoders.push_back({t_s, {left * turns, right * turns}});
    run.camera.poses.push_back({.t_s = t_s, .x_m = 1e-3 * turns, .y_m = 0.0, .yaw_rad = 0.0});
  }
  return run;
}

TEST_CASE("A window is as long as is asked, of four sightings or more, in which a wheel turned") {
  const auto windows = [](const RunLog& run, double window_s) {
    std::vector<RunLog> runs{run};
    try {
      return static_cast<int>(CalibrateOdometry(runs, {}, {.window_s = window_s}).windows);
    } catch (const std::invalid_argument& error) {
      const std::string text = error.what();
      CHECK_THAT(text, Catch::Contains(" window(s) of ") && Catch::Contains("and 8 are needed"));
      return -std::stoi(text);
    }
  };
  CHECK(windows(Straight(128, 5, 5), 2.0) == 8);
  CHECK(windows(Straight(112, 5, 5), 2.0) == -7);
  CHECK(windows(Straight(128 + 3, 5, 5), 2.0) == 8);
  CHECK(windows(Straight(128 + 4, 5, 5), 2.0) == 9);
  CHECK(windows(Straight(128, 5, 5), 0.5) == 32);
  CHECK(windows(Straight(128, 9, 9), 0.375) == 0);
  // Fifteen steps of a window: 20 counts of both wheels are standing still, more are not.
  CHECK(windows(Straight(128, 0, 4, 3), 2.0) == 0);
  CHECK(windows(Straight(128, 1, 1), 2.0) == 8);
  CHECK(windows(Straight(128, -1, 1), 2.0) == 8);
  RunLog no_yaw = Straight(128, 5, 5);
  for (std::size_t i = 0; i < 16; ++i) no_yaw.camera.poses[i].yaw_rad = NAN;
  CHECK(windows(no_yaw, 2.0) == -7);
  RunLog late = Straight(128, 5, 5);
  late.encoders.erase(late.encoders.begin(), late.encoders.begin() + 16);
  CHECK(windows(late, 2.0) == -7);
}

TEST_CASE("Wheels that explain every pose leave a micrometre and a microradian of noise, no less") {
  // A millimetre for each five counts, in windows that begin and end in the midst of rolling.
  const std::vector<RunLog> runs{Straight(128, 5, 5)};
  const OdometryCalibration found = CalibrateOdometry(runs, {}, {.window_s = 2.0});
  CHECK(found.noise_m == 1e-6);
  CHECK(found.noise_yaw_rad == 1e-6);
  CHECK(found.wheel_radius_m.value == Approx(2e-4 * 358.3 / (2.0 * geometry::kPi)));
  CHECK(found.right_over_left.value == Approx(1.0).epsilon(1e-6));
}

TEST_CASE("A value is told to a standard error of five per cent, a tag to half a centimetre") {
  // More and more noise: the error is the half width of the interval over Student's t.
  const auto sigma = [](const Estimate& estimate, double t) {
    return std::log(estimate.interval.high / estimate.value) / t;
  };
  int told = 0, not_told = 0, tag_told = 0, tag_not_told = 0;
  for (const double noise : {22.0, 24.0, 30.0, 48.0, 51.0, 60.0}) {
    const OdometryCalibration found =
        CalibrateOdometry(Squares({}, 1, 3, {0.0015 * noise, 0.02 * noise}), {});
    const double t = statistics::StudentQuantile(static_cast<double>(found.windows - 6), 0.975);
    for (const Estimate& estimate : {found.wheel_radius_m, found.right_over_left, found.track_m}) {
      CHECK(estimate.is_told == (sigma(estimate, t) < 0.05));
      told += sigma(estimate, t) > 0.045 && sigma(estimate, t) < 0.05;
      not_told += sigma(estimate, t) > 0.05 && sigma(estimate, t) < 0.1;
    }
    const double tag_m = (found.tag_ahead_m.interval.high - found.tag_ahead_m.value) / t;
    CHECK(found.tag_ahead_m.is_told == (tag_m < 0.005));
    tag_told += tag_m > 0.0045 && tag_m < 0.005;
    tag_not_told += tag_m > 0.005 && tag_m < 0.01;
    UNSCOPED_INFO(noise << " " << sigma(found.wheel_radius_m, t) << " "
                        << sigma(found.right_over_left, t) << " " << sigma(found.track_m, t) << " "
                        << tag_m);
  }
  CHECK(told > 0);
  CHECK(not_told > 0);
  CHECK(tag_told > 0);
  CHECK(tag_not_told > 0);
}

TEST_CASE(
    "A tag that sits aside and is turned hides neither wheels, track nor how far ahead it is") {
  const Planted planted{0.0157, 0.985, 0.0803};
  for (const double side : {1.0, -1.0}) {
    INFO(side);
    std::vector<RunLog> runs = Squares(planted, 2, 7, {0.0002, 0.002});
    for (RunLog& run : runs) {
      for (trajectory::StampedPose& pose : run.camera.poses) {
        const geometry::Pose2 tag =
            pose.Planar() * geometry::Pose2{-0.015, side * 0.012, side * 0.2};
        pose.x_m = tag.x_m;
        pose.y_m = tag.y_m;
        pose.yaw_rad = tag.yaw_rad;
      }
    }
    const OdometryCalibration found = CalibrateOdometry(runs, {});
    CHECK(found.wheel_radius_m.value == Approx(0.0157).epsilon(1e-3));
    CHECK(found.right_over_left.value == Approx(0.985).epsilon(1e-3));
    CHECK(found.track_m.value == Approx(0.0803).epsilon(3e-3));
    CHECK(found.tag_ahead_m.value == Approx(-0.015).margin(1e-3));
    CHECK(found.noise_m < 1e-3);
    CHECK(found.noise_yaw_rad < 5e-3);
  }
}

TEST_CASE("What straight runs do not tell stays near where the calibration starts") {
  OdometryOptions start;
  start.drive.track_m = 0.1;
  std::vector<RunLog> runs;
  for (int i = 0; i < 2; ++i) {
    RunLog run{.name = "line"};
    for (int k = 0; k <= 300; ++k) {
      const double t_s = 0.1 * k;
      run.encoders.push_back({t_s, {20 * k, 20 * k}});
      // A millimetre and a hundredth of a radian to either side in turns.
      const double off = k % 2 == i ? 1.0 : -1.0;
      run.camera.poses.push_back({.t_s = t_s,
                                  .x_m = 20e-3 * 0.3 * k / 10.0 + 1e-3 * off,
                                  .y_m = 1e-3 * (k % 3 - 1),
                                  .yaw_rad = 0.01 * off});
    }
    runs.push_back(std::move(run));
  }
  const OdometryCalibration found = CalibrateOdometry(runs, start);
  CHECK(found.wheel_radius_m.value ==
        Approx(3e-5 * start.counts_per_wheel_turn / (2.0 * geometry::kPi)).epsilon(5e-3));
  CHECK(found.right_over_left.value == Approx(1.0).margin(0.02));
  CHECK(found.track_m.value == Approx(0.1).epsilon(0.3));
  CHECK(std::abs(found.tag_ahead_m.value) < 0.02);
}

TEST_CASE("Too few windows are told with their number, their length and what to do") {
  std::mt19937_64 generator(4);
  const std::vector<RunLog> runs{DriveSquare({}, 90.0, {}, generator)};
  CHECK_THROWS_WITH(CalibrateOdometry(runs, {}, {.window_s = 1000.0}),
                    "1 window(s) of 1000 s in which the wheels turned under the camera, and 8 are "
                    "needed: give longer runs, or a smaller window_s");
}

}  // namespace
}  // namespace rift::odometry
