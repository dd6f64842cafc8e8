#include "rift/simulation/mocap.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "rift/statistics/descriptive.hpp"
#include "simulation/quiet_mocap.hpp"

namespace rift::simulation {
namespace {

constexpr double kSpeed = 0.3, kHeading = 0.5;

TruePose Moving(double t_s, double speed_mps = kSpeed) {
  TruePose pose;
  pose.t_s = t_s;
  pose.x_m = speed_mps * t_s * std::cos(kHeading);
  pose.y_m = speed_mps * t_s * std::sin(kHeading);
  pose.yaw_rad = kHeading;
  return pose;
}

/// Every new measurement of a straight drive, looked for every `look_s`.
std::vector<trial::PoseMeasurement> Watch(const MocapOptions& options, double duration_s,
                                          double look_s, double speed_mps = kSpeed) {
  Mocap mocap(options, 3);
  std::vector<trial::PoseMeasurement> seen;
  for (int i = 0; i < std::lround(duration_s / look_s); ++i) {
    mocap.Observe(Moving(i * look_s, speed_mps), Moving((i + 1) * look_s, speed_mps));
    const auto newest = mocap.Newest((i + 1) * look_s);
    if (newest && (seen.empty() || newest->captured_s != seen.back().captured_s)) {
      seen.push_back(*newest);
    }
  }
  return seen;
}

TEST_CASE("A pose arrives after exposure and processing and is stamped with its capture") {
  MocapOptions options = Quiet();
  options.rate_hz = 20.0;
  options.exposure_s = 0.010;
  options.processing_s = 0.070;
  Mocap mocap(options, 1);
  mocap.Observe(Moving(0.0), Moving(1.0));
  std::optional<trial::PoseMeasurement> newest;
  double first_s = 0.0;
  for (; !newest; first_s += 0.0005) newest = mocap.Newest(first_s);
  CHECK(first_s - newest->captured_s == Approx(0.075).margin(0.001));
  CHECK(newest->world_from_robot.x_m ==
        Approx(kSpeed * std::cos(kHeading) * newest->captured_s).margin(1e-9));
  CHECK(newest->world_from_robot.yaw_rad == Approx(kHeading));
}

TEST_CASE("Frames come at the rate of the camera") {
  MocapOptions options = Quiet();
  options.rate_hz = 20.0;
  const auto seen = Watch(options, 10.0, 0.004);
  REQUIRE(seen.size() > 190);
  for (size_t i = 1; i < seen.size(); ++i) {
    CHECK(seen[i].captured_s - seen[i - 1].captured_s == Approx(0.05).margin(1e-9));
  }
}

TEST_CASE("Noise has the size asked for across along and in yaw") {
  MocapOptions options = Quiet();
  options.noise_across_m = 0.0003;
  options.blur_across_s = 0.002;
  options.noise_along_m = 0.001;
  options.noise_yaw_rad = 0.01;
  options.blur_yaw_rad_per_mps = 0.04;
  const auto seen = Watch(options, 2000.0, 0.01);
  double across = 0.0, along = 0.0, yaw = 0.0;
  for (const trial::PoseMeasurement& m : seen) {
    const TruePose truth = Moving(m.captured_s);
    const double dx = m.world_from_robot.x_m - truth.x_m, dy = m.world_from_robot.y_m - truth.y_m;
    across += std::pow(-std::sin(kHeading) * dx + std::cos(kHeading) * dy, 2);
    along += std::pow(std::cos(kHeading) * dx + std::sin(kHeading) * dy, 2);
    yaw += std::pow(m.world_from_robot.yaw_rad - kHeading, 2);
  }
  const double n = static_cast<double>(seen.size());
  CHECK(std::sqrt(across / n) == Approx(std::hypot(0.0003, 0.002 * kSpeed)).epsilon(0.03));
  CHECK(std::sqrt(along / n) == Approx(0.001).epsilon(0.03));
  CHECK(std::sqrt(yaw / n) == Approx(std::hypot(0.01, 0.04 * kSpeed)).epsilon(0.04));
}

TEST_CASE("Time stamp jitter becomes an error along the motion and leaves stamps in order") {
  MocapOptions options = Quiet();
  options.stamp_jitter_s = 0.010;
  const auto seen = Watch(options, 1000.0, 0.01);
  double along = 0.0, last_s = -1.0;
  for (const trial::PoseMeasurement& m : seen) {
    const TruePose truth = Moving(m.captured_s);
    along += std::pow(m.world_from_robot.x_m - truth.x_m, 2) +
             std::pow(m.world_from_robot.y_m - truth.y_m, 2);
    CHECK(m.captured_s > last_s);
    last_s = m.captured_s;
  }
  CHECK(std::sqrt(along / static_cast<double>(seen.size())) ==
        Approx(0.010 * kSpeed).epsilon(0.05));
}

TEST_CASE("What the camera sees does not depend on how often anyone looks") {
  const auto often = Watch(MocapOptions{}, 5.0, 0.004), seldom = Watch(MocapOptions{}, 5.0, 0.02);
  REQUIRE(often.size() == seldom.size());
  for (size_t i = 0; i < often.size(); ++i) {
    CHECK(often[i].captured_s == Approx(seldom[i].captured_s).margin(1e-12));
    CHECK(often[i].world_from_robot.x_m == Approx(seldom[i].world_from_robot.x_m).margin(1e-9));
    CHECK(often[i].world_from_robot.yaw_rad == Approx(seldom[i].world_from_robot.yaw_rad));
  }
}

TEST_CASE("Dropped frames are missing and nothing else") {
  MocapOptions options = Quiet();
  const double all = static_cast<double>(Watch(options, 400.0, 0.01).size());
  options.dropout = 0.3;
  CHECK(static_cast<double>(Watch(options, 400.0, 0.01).size()) / all == Approx(0.7).margin(0.03));
  options.dropout = 1.0;
  CHECK(Watch(options, 5.0, 0.01).empty());
}

TEST_CASE("The pose is that of the tag which sits off the axle and leans with the robot") {
  MocapOptions options = Quiet();
  options.rate_hz = 0.0;
  options.tag_ahead_m = 0.03;
  options.tag_above_m = 0.02;
  Mocap mocap(options, 1);
  TruePose pose;
  pose.x_m = 1.0;
  pose.z_m = 0.016;
  pose.yaw_rad = M_PI / 2.0;
  mocap.Observe(pose, pose);
  CHECK(mocap.Newest(0.0)->world_from_robot.x_m == Approx(1.0));
  CHECK(mocap.Newest(0.0)->world_from_robot.y_m == Approx(0.03));
  CHECK(mocap.Newest(0.0)->z_m == Approx(0.036));
  pose.pitch_rad = 0.2;  // nose down: the tag sinks and its top leans forward
  mocap.Observe(pose, pose);
  CHECK(mocap.Newest(0.0)->world_from_robot.y_m ==
        Approx(0.03 * std::cos(0.2) + 0.02 * std::sin(0.2)));
  CHECK(mocap.Newest(0.0)->z_m == Approx(0.016 - 0.03 * std::sin(0.2) + 0.02 * std::cos(0.2)));
}

TEST_CASE("A camera without a rate shows the present pose") {
  MocapOptions options = Quiet();
  options.rate_hz = 0.0;
  Mocap mocap(options, 1);
  CHECK_FALSE(mocap.Newest(0.0));
  mocap.Observe(Moving(0.0), Moving(0.1));
  CHECK(mocap.Newest(0.1)->captured_s == 0.1);
  CHECK(mocap.Newest(0.1)->world_from_robot == Moving(0.1).Planar());
}

/// Stamps and true times of what a host saw of a robot that drives 1 m a second along x.
struct Seen {
  std::vector<double> stamps_s, captures_s;
};

Seen SeenByHost(const MocapOptions& options, std::uint64_t seed = 3) {
  Mocap mocap(options, seed);
  Seen seen;
  TruePose before;
  std::optional<double> last_s;
  for (int i = 1; i <= 5000; ++i) {
    const TruePose after{.t_s = 0.004 * i, .x_m = 0.004 * i};
    mocap.Observe(before, after);
    before = after;
    const auto newest = mocap.Newest(after.t_s);
    if (!newest || newest->captured_s == last_s) continue;
    last_s = newest->captured_s;
    seen.stamps_s.push_back(newest->captured_s);
    seen.captures_s.push_back(newest->world_from_robot.x_m);
  }
  return seen;
}

/// From the third row on: the first two may wait for a picture.
std::vector<double> Ages_s(const Seen& seen) {
  std::vector<double> ages_s;
  for (size_t i = 2; i < seen.stamps_s.size(); ++i) {
    ages_s.push_back(seen.stamps_s[i] - seen.captures_s[i]);
  }
  return ages_s;
}

TEST_CASE("A host that samples the camera stamps its own time and sees whole frames") {
  MocapOptions options;
  options.rate_hz = 30.0;
  options.host_period_s = 0.055;
  options.noise_across_m = options.blur_across_s = options.noise_along_m = 0.0;
  options.noise_yaw_rad = options.blur_yaw_rad_per_mps = options.frame_jitter_s = 0.0;
  const Seen seen = SeenByHost(options);
  REQUIRE(seen.stamps_s.size() > 300);
  int of_one = 0, of_two = 0;
  std::vector<double> periods_s;
  for (size_t i = 1; i < seen.stamps_s.size(); ++i) {
    const double frames = 30.0 * (seen.captures_s[i] - seen.captures_s[i - 1]);
    CHECK(frames == Approx(std::round(frames)).margin(1e-6));
    of_one += std::lround(frames) == 1;
    of_two += std::lround(frames) == 2;
    periods_s.push_back(seen.stamps_s[i] - seen.stamps_s[i - 1]);
  }
  CHECK(statistics::Median(periods_s) == Approx(0.055).margin(0.001));
  const double all = static_cast<double>(periods_s.size());
  CHECK(of_two / all == Approx(0.055 * 30.0 - 1.0).margin(0.15));
  CHECK(of_one + of_two > 0.95 * all);
  // As old as the way to the driver and two turns of the host make it, and up to a frame less.
  options.host_jitter_s = 0.0;
  const double oldest_s = 0.5 * options.exposure_s + options.processing_s + 2.0 * 0.055;
  for (const double age_s : Ages_s(SeenByHost(options))) {
    CHECK(age_s <= oldest_s + 1e-9);
    CHECK(age_s >= oldest_s - 1.0 / 30.0 - 1e-9);
  }
}

TEST_CASE("The way from row to row follows the host's turn two before, as in the authors' logs") {
  MocapOptions options;
  options.rate_hz = 30.0;
  options.host_period_s = 0.055;
  options.host_jitter_s = 0.004;
  options.noise_across_m = options.blur_across_s = options.noise_along_m = 0.0;
  options.frame_jitter_s = 0.0;
  std::vector<double> ways_s;
  std::array<std::vector<double>, 4> turns_s;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const Seen seen = SeenByHost(options, seed);
    for (size_t i = 4; i < seen.stamps_s.size(); ++i) {
      ways_s.push_back(seen.captures_s[i] - seen.captures_s[i - 1]);
      for (size_t back = 0; back < turns_s.size(); ++back) {
        turns_s[back].push_back(seen.stamps_s[i - back] - seen.stamps_s[i - back - 1]);
      }
    }
  }
  const auto slope = [&](const std::vector<double>& turns) {
    const double turn = statistics::Mean(turns), way = statistics::Mean(ways_s);
    double both = 0.0, own = 0.0;
    for (size_t i = 0; i < turns.size(); ++i) {
      both += (turns[i] - turn) * (ways_s[i] - way);
      own += (turns[i] - turn) * (turns[i] - turn);
    }
    return both / own;
  };
  CHECK(slope(turns_s[2]) == Approx(1.0).margin(0.2));
  for (const size_t other : {0, 1, 3}) CHECK(std::abs(slope(turns_s[other])) < 0.2);
}

TEST_CASE("A host faster than the camera waits for each frame and sees it after its own turn") {
  MocapOptions options;
  options.rate_hz = 30.0;
  options.host_period_s = 0.012;
  options.host_jitter_s = 0.0;
  options.noise_across_m = options.blur_across_s = options.noise_along_m = 0.0;
  options.frame_jitter_s = 0.0;
  const Seen seen = SeenByHost(options);
  REQUIRE(seen.stamps_s.size() > 500);
  const double age_s = 0.5 * options.exposure_s + options.processing_s + 0.012;
  for (size_t i = 2; i < seen.stamps_s.size(); ++i) {
    CHECK(seen.captures_s[i] - seen.captures_s[i - 1] == Approx(1.0 / 30.0).margin(1e-6));
    CHECK(seen.stamps_s[i] - seen.captures_s[i] == Approx(age_s).margin(1e-6));
  }
}

std::vector<double> Periods_s(const MocapOptions& options, std::uint64_t seed) {
  const Seen seen = SeenByHost(options, seed);
  std::vector<double> periods_s;
  for (size_t i = 1; i < seen.stamps_s.size(); ++i) {
    periods_s.push_back(seen.stamps_s[i] - seen.stamps_s[i - 1]);
  }
  return periods_s;
}

MocapOptions HostOf55ms() {
  MocapOptions options;
  options.rate_hz = 30.0;
  options.host_period_s = 0.055;
  options.host_jitter_s = 0.0;
  return options;
}

TEST_CASE("A frame late at the driver leaves the host's turns, and is a frame older at the next") {
  MocapOptions options = HostOf55ms();
  options.noise_across_m = options.blur_across_s = options.noise_along_m = 0.0;
  options.frame_jitter_s = 0.0;
  const std::vector<double> prompt_s = Ages_s(SeenByHost(options));
  options.arrival_jitter_s = 0.004;
  const Seen late = SeenByHost(options);
  for (size_t i = 1; i < late.stamps_s.size(); ++i) {
    CHECK(late.stamps_s[i] - late.stamps_s[i - 1] == Approx(0.055).margin(1e-9));
    const double frames = 30.0 * (late.captures_s[i] - late.captures_s[i - 1]);
    CHECK(frames == Approx(std::round(frames)).margin(1e-6));
  }
  const std::vector<double> late_s = Ages_s(late);
  // Half-normal: 0.8 * 0.004 s are late on average, and of 1/30 s so many frames are late for a
  // turn.
  const double mean_s = std::sqrt(2.0 / M_PI) * options.arrival_jitter_s;
  CHECK(statistics::Mean(late_s) - statistics::Mean(prompt_s) == Approx(mean_s).margin(0.0012));
  const double oldest_s = 0.5 * options.exposure_s + options.processing_s + 2.0 * 0.055;
  const auto older = std::count_if(late_s.begin(), late_s.end(),
                                   [&](double age_s) { return age_s > oldest_s + 1e-6; });
  CHECK(static_cast<double>(older) / static_cast<double>(late_s.size()) ==
        Approx(30.0 * mean_s).margin(0.04));
}

TEST_CASE("A host's period is another in each run and drifts within one") {
  MocapOptions options = HostOf55ms();
  options.host_period_spread_s = 0.0026;
  std::vector<double> medians_s;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::vector<double> periods_s = Periods_s(options, seed);
    const auto [least, most] = std::minmax_element(periods_s.begin(), periods_s.end());
    CHECK(*most - *least < 1e-9);
    medians_s.push_back(statistics::Median(periods_s));
  }
  CHECK(statistics::Mean(medians_s) == Approx(0.055).margin(0.001));
  CHECK(statistics::StandardDeviation(medians_s) == Approx(0.0026).margin(0.0008));

  options.host_period_spread_s = 0.0;
  options.host_wander_s = 0.0002;
  std::vector<double> steps_s;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<double> periods_s = Periods_s(options, seed);
    for (size_t i = 1; i < periods_s.size(); ++i)
      steps_s.push_back(periods_s[i] - periods_s[i - 1]);
  }
  CHECK(statistics::StandardDeviation(steps_s) == Approx(0.0002).margin(2e-5));
}

TEST_CASE("A late turn of a host is longer, in another share of them in each run") {
  MocapOptions options = HostOf55ms();
  options.host_late_share = 0.1;
  options.host_late_s = 0.011;
  std::vector<double> shares;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const std::vector<double> periods_s = Periods_s(options, seed);
    double late = 0.0;
    for (const double period_s : periods_s) {
      const bool is_late = period_s > 0.060;
      CHECK(period_s == Approx(is_late ? 0.066 : 0.055).margin(1e-9));
      late += is_late;
    }
    shares.push_back(late / static_cast<double>(periods_s.size()));
  }
  CHECK(statistics::Mean(shares) == Approx(0.1).margin(0.025));
  CHECK(statistics::StandardDeviation(shares) == Approx(0.1 / std::sqrt(3.0)).margin(0.02));
}

TEST_CASE("A run draws its own scatter at rest and none while that has no spread") {
  MocapOptions options = Quiet();
  options.noise_across_m = 0.0002;
  options.noise_along_m = 0.0003;
  options.noise_yaw_rad = 0.002;
  options.yaw_tail_dof = 1e6;
  // Across, along and of the yaw, over what is asked for.
  const auto scatter = [&](std::uint64_t seed) {
    Mocap mocap(options, seed);
    std::vector<double> across, along, yaw;
    for (int i = 1; i <= 400; ++i) {
      mocap.Observe({.t_s = 0.1 * (i - 1)}, {.t_s = 0.1 * i});
      const geometry::Pose2 seen = mocap.Newest(0.1 * i + 1.0)->world_from_robot;
      across.push_back(seen.y_m / 0.0002);
      along.push_back(seen.x_m / 0.0003);
      yaw.push_back(seen.yaw_rad / 0.002);
    }
    return std::array{statistics::StandardDeviation(across), statistics::StandardDeviation(along),
                      statistics::StandardDeviation(yaw)};
  };
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    for (const double one : scatter(seed)) CHECK(one == Approx(1.0).epsilon(0.2));
  }
  options.noise_spread = 1.2;
  std::vector<double> logarithms;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const auto [across, along, yaw] = scatter(seed);
    logarithms.push_back(std::log(across));
    CHECK(along / across == Approx(1.0).epsilon(0.3));  // all three by one factor
    CHECK(yaw / across == Approx(1.0).epsilon(0.3));
  }
  CHECK(statistics::Mean(logarithms) == Approx(0.0).margin(0.3));
  CHECK(statistics::StandardDeviation(logarithms) == Approx(1.2).margin(0.2));
}

TEST_CASE("No stamp lies after its pose arrived, or before the stamp of the picture before it") {
  MocapOptions options = Quiet();
  options.stamp_jitter_s = 0.1;  // more than the 0.075 s to the pose
  Mocap mocap(options, 4);
  double last_s = -1.0, least_s = 1.0;
  int poses = 0;
  for (int i = 1; i <= 2000; ++i) {
    mocap.Observe(Moving(0.004 * (i - 1)), Moving(0.004 * i));
    const auto newest = mocap.Newest(0.004 * i);
    if (!newest || newest->captured_s == last_s) continue;
    CHECK(newest->captured_s <= 0.004 * i);
    CHECK(newest->captured_s > last_s);
    if (poses > 0) least_s = std::min(least_s, newest->captured_s - last_s);
    last_s = newest->captured_s;
    ++poses;
  }
  CHECK(poses > 140);
  CHECK(least_s == Approx(1e-6).epsilon(1e-6));  // a stamp that would not be later is a tick later
}

TEST_CASE("A host's period is 5 ms at least, and each of its turns half of its period") {
  MocapOptions options = Quiet();
  options.rate_hz = 1000.0;
  const auto shortest_s = [&](std::uint64_t seed) {
    Mocap mocap(options, seed);
    double last_s = 0.0, least_s = 1.0;
    for (int i = 1; i <= 1000; ++i) {
      mocap.Observe({.t_s = 0.0005 * (i - 1)}, {.t_s = 0.0005 * i});
      const auto newest = mocap.Newest(0.0005 * i);
      if (!newest || newest->captured_s == last_s) continue;
      if (last_s > 0.0) least_s = std::min(least_s, newest->captured_s - last_s);
      last_s = newest->captured_s;
    }
    return least_s;
  };
  options.host_period_s = 0.006;
  options.host_period_spread_s = 0.01;  // a run in two would be faster
  options.host_jitter_s = 0.0;
  int at_least = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CHECK(shortest_s(seed) > 0.005 - 1e-9);
    at_least += shortest_s(seed) < 0.005 + 1e-9;
  }
  CHECK(at_least > 3);
  options.host_period_s = 0.02;
  options.host_period_spread_s = 0.0;
  options.host_jitter_s = 0.05;
  CHECK(shortest_s(1) == Approx(0.01).margin(1e-9));
}

}  // namespace
}  // namespace rift::simulation
