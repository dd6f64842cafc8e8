// Each number that the overhead camera measures, and when.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "simulation/quiet_mocap.hpp"

namespace rift::simulation {
namespace {

TEST_CASE("Every number has a scatter of its own that tells nothing of the others") {
  MocapOptions options;
  options.rate_hz = 50.0;
  options.frame_jitter_s = 0.0;
  options.stamp_jitter_s = 0.002;
  options.noise_across_m = 0.001;
  options.noise_along_m = 0.002;
  options.noise_yaw_rad = 0.01;
  options.noise_z_m = 0.003;
  options.noise_tilt_rad = 0.05;
  options.yaw_tail_dof = 1e6;
  Mocap mocap(options, 5);
  const TruePose at{
      .x_m = 0.5, .y_m = 0.25, .z_m = 0.02, .roll_rad = 0.1, .pitch_rad = -0.2, .yaw_rad = 0.0};
  constexpr int kFrames = 4000;
  std::vector<std::array<double, 7>> off;
  double first_s = 0.0;
  for (int i = 1; i <= kFrames; ++i) {
    TruePose before = at, after = at;
    before.t_s = 0.02 * (i - 1);
    after.t_s = 0.02 * i;
    mocap.Observe(before, after);
    const auto seen = mocap.Newest(after.t_s + 1.0);
    if (!seen) continue;
    if (off.empty()) first_s = seen->captured_s;
    const double grid_s = first_s + 0.02 * static_cast<double>(off.size());
    off.push_back({seen->world_from_robot.x_m - 0.5, seen->world_from_robot.y_m - 0.25,
                   seen->world_from_robot.yaw_rad, seen->z_m - 0.02, seen->roll_rad - 0.1,
                   seen->pitch_rad + 0.2, seen->captured_s - grid_s});
  }
  REQUIRE(off.size() > kFrames - 5);
  const std::array<double, 7> sigma{0.002, 0.001, 0.01, 0.003, 0.05, 0.05, 0.002};
  const double n = static_cast<double>(off.size());
  std::array<double, 7> mean{};
  for (const auto& one : off) {
    for (std::size_t k = 0; k < 7; ++k) mean[k] += one[k] / n;
  }
  for (std::size_t i = 0; i < 7; ++i) {
    if (i < 6) CHECK(std::abs(mean[i]) < 4.0 * sigma[i] / std::sqrt(n));
    for (std::size_t k = 0; k <= i; ++k) {
      double product = 0.0;
      for (const auto& one : off) product += (one[i] - mean[i]) * (one[k] - mean[k]) / n;
      INFO(i << " " << k);
      CHECK(product / (sigma[i] * sigma[k]) == Approx(i == k ? 1.0 : 0.0).margin(0.08));
    }
  }
}

TEST_CASE("Between two poses a frame sees the way in a straight line, turns the short way round") {
  MocapOptions options = Quiet();
  options.rate_hz = 20.0;
  Mocap mocap(options, 3);
  const TruePose before{.t_s = 1.0,
                        .x_m = 1.0,
                        .y_m = 2.0,
                        .z_m = 3.0,
                        .roll_rad = 0.1,
                        .pitch_rad = 0.2,
                        .yaw_rad = 3.0};
  const TruePose after{.t_s = 2.0,
                       .x_m = 2.0,
                       .y_m = 0.0,
                       .z_m = 7.0,
                       .roll_rad = -0.1,
                       .pitch_rad = 0.6,
                       .yaw_rad = -3.0};
  TruePose start = before;
  start.t_s = 0.0;
  mocap.Observe(start, before);
  mocap.Observe(before, after);
  int frames = 0;
  double last_s = 0.0;
  for (double now_s = 1.2; now_s < 2.2; now_s += 0.01) {
    const auto seen = mocap.Newest(now_s);
    REQUIRE(seen);
    if (seen->captured_s <= std::max(1.0, last_s)) continue;
    last_s = seen->captured_s;
    ++frames;
    const double share = seen->captured_s - 1.0;
    CHECK(seen->world_from_robot.x_m == Approx(1.0 + share));
    CHECK(seen->world_from_robot.y_m == Approx(2.0 - 2.0 * share));
    CHECK(seen->z_m == Approx(3.0 + 4.0 * share));
    CHECK(seen->roll_rad == Approx(0.1 - 0.2 * share).margin(1e-12));
    CHECK(seen->pitch_rad == Approx(0.2 + 0.4 * share));
    const double turned = 3.0 + share * (2.0 * M_PI - 6.0);
    CHECK(seen->world_from_robot.yaw_rad == Approx(turned > M_PI ? turned - 2.0 * M_PI : turned));
  }
  CHECK(frames > 15);
}

TEST_CASE("Frames scatter about their ticks, by half of one at most") {
  MocapOptions options = Quiet();
  options.rate_hz = 20.0;
  const auto captures_of = [&](double jitter_s) {
    options.frame_jitter_s = jitter_s;
    Mocap mocap(options, 3);
    std::vector<double> captures_s;
    for (int i = 1; i <= 40'000; ++i) {
      mocap.Observe({.t_s = 0.005 * (i - 1)}, {.t_s = 0.005 * i});
      const auto seen = mocap.Newest(0.005 * i);
      if (seen && (captures_s.empty() || seen->captured_s != captures_s.back())) {
        captures_s.push_back(seen->captured_s);
      }
    }
    return captures_s;
  };
  const std::vector<double> even = captures_of(0.0), some = captures_of(0.003),
                            much = captures_of(0.1);
  CHECK((even.front() >= 0.0 && even.front() < 0.05));
  REQUIRE(some.size() > 3900);
  const auto off_s = [&](double capture_s) {
    return std::remainder(capture_s - even.front(), 0.05);
  };
  double squares = 0.0, most_s = 0.0;
  for (const double capture_s : even) CHECK(std::abs(off_s(capture_s)) < 1e-9);
  for (const double capture_s : some) squares += std::pow(off_s(capture_s), 2);
  CHECK(std::sqrt(squares / static_cast<double>(some.size())) == Approx(0.003).epsilon(0.05));
  for (const double capture_s : much) most_s = std::max(most_s, std::abs(off_s(capture_s)));
  CHECK(most_s == Approx(0.49 * 0.05).epsilon(1e-6));
}

TEST_CASE("A tag that sits off the axle leans sideways with the robot") {
  MocapOptions options = Quiet();
  options.rate_hz = 0.0;
  options.tag_ahead_m = 0.03;
  options.tag_above_m = 0.02;
  Mocap mocap(options, 1);
  const TruePose pose{.x_m = 1.0, .y_m = 2.0, .z_m = 0.016, .roll_rad = 0.3, .yaw_rad = M_PI};
  mocap.Observe(pose, pose);
  const auto seen = mocap.Newest(0.0);
  REQUIRE(seen);
  // Its left side up, it leans to its right: from behind, that is to +y where it looks to -x.
  CHECK(seen->world_from_robot.x_m == Approx(1.0 - 0.03));
  CHECK(seen->world_from_robot.y_m == Approx(2.0 + 0.02 * std::sin(0.3)));
  CHECK(seen->z_m == Approx(0.016 + 0.02 * std::cos(0.3)));
  CHECK((seen->roll_rad == 0.3 && seen->pitch_rad == 0.0));
}

TEST_CASE("Where a host is in its first turn tells nothing of where the camera is in its frame") {
  MocapOptions options = Quiet();
  options.rate_hz = 20.0;
  options.exposure_s = options.processing_s = 0.0;
  options.host_period_s = 0.05;
  options.host_period_spread_s = options.host_jitter_s = options.host_wander_s = 0.0;
  options.host_late_share = 0.0;
  double waited_s = 0.0;
  constexpr int kRuns = 300;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    Mocap mocap(options, seed);
    mocap.Observe({.t_s = 0.0}, {.t_s = 0.2, .x_m = 0.2});  // 1 m/s: x is the time
    const auto first = mocap.Newest(0.101);
    REQUIRE(first);
    const double age_s = first->captured_s - first->world_from_robot.x_m;
    CHECK(age_s > 0.05 - 1e-9);
    CHECK(age_s < 0.1);
    waited_s += age_s - 0.05;
  }
  // A frame waits for a turn that ends after it: of two even shares the mean of max(0, a - b) is
  // 1/6.
  CHECK(waited_s / kRuns == Approx(0.05 / 6.0).margin(0.0025));
}

TEST_CASE("A robot stands below a centimetre a second: only then its scatter is the run's") {
  MocapOptions options = Quiet();
  options.rate_hz = 50.0;
  options.noise_across_m = 0.001;
  options.noise_spread = 3.0;
  const auto scatter_m = [&](double speed_mps) {
    Mocap mocap(options, 2);
    double squares = 0.0;
    for (int i = 1; i <= 400; ++i) {
      const double before_s = 0.02 * (i - 1), after_s = 0.02 * i;
      mocap.Observe({.t_s = before_s, .x_m = speed_mps * before_s},
                    {.t_s = after_s, .x_m = speed_mps * after_s});
      if (i > 5) squares += std::pow(mocap.Newest(after_s)->world_from_robot.y_m, 2) / 395.0;
    }
    return std::sqrt(squares);
  };
  CHECK(scatter_m(0.011) == Approx(0.001).epsilon(0.2));
  CHECK(std::abs(std::log(scatter_m(0.009) / 0.001)) > 0.5);
  CHECK(scatter_m(0.009) == Approx(scatter_m(0.0)));
}

/// Times between the poses of a host, whose camera is much faster than it is.
std::vector<double> HostTurns_s(const MocapOptions& options, std::uint64_t seed, int steps) {
  Mocap mocap(options, seed);
  std::vector<double> turns_s;
  double last_s = 0.0;
  for (int i = 1; i <= steps; ++i) {
    mocap.Observe({.t_s = 0.004 * (i - 1)}, {.t_s = 0.004 * i});
    const auto newest = mocap.Newest(0.004 * i);
    if (!newest || newest->captured_s == last_s) continue;
    if (last_s > 0.0) turns_s.push_back(newest->captured_s - last_s);
    last_s = newest->captured_s;
  }
  return turns_s;
}

MocapOptions HostOf50ms() {
  MocapOptions options = Quiet();
  options.rate_hz = 100.0;
  options.host_period_s = 0.05;
  options.host_period_spread_s = options.host_jitter_s = options.host_wander_s = 0.0;
  return options;
}

TEST_CASE("Whether a turn of a host is late tells nothing of its jitter") {
  MocapOptions options = HostOf50ms();
  options.host_jitter_s = 0.001;
  options.host_late_share = 0.2;
  options.host_late_s = 0.02;
  double late_s = 0.0, other_s = 0.0, squares = 0.0;
  int late = 0, others = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const double turn_s : HostTurns_s(options, seed, 2500)) {
      const bool is_late = turn_s > 0.06;
      (is_late ? late_s : other_s) += turn_s;
      ++(is_late ? late : others);
      squares += std::pow(turn_s - (is_late ? 0.07 : 0.05), 2);
    }
  }
  REQUIRE(late > 300);
  CHECK(late_s / late == Approx(0.07).margin(0.0002));
  CHECK(other_s / others == Approx(0.05).margin(0.0001));
  CHECK(std::sqrt(squares / (late + others)) == Approx(0.001).epsilon(0.1));
}

TEST_CASE("The period that a run draws tells nothing of its share of late turns") {
  MocapOptions options = HostOf50ms();
  options.host_period_spread_s = 0.003;
  options.host_late_share = 0.1;
  options.host_late_s = 0.05;
  constexpr int kRuns = 150;
  std::array<std::vector<double>, 2> drawn;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const std::vector<double> turns_s = HostTurns_s(options, seed, 2000);
    double late = 0.0, least_s = 1.0;
    for (const double turn_s : turns_s) {
      late += turn_s > 0.08;
      least_s = std::min(least_s, turn_s);
    }
    drawn[0].push_back(least_s);
    drawn[1].push_back(late / static_cast<double>(turns_s.size()));
  }
  std::array<double, 2> mean{};
  for (std::size_t k = 0; k < 2; ++k) {
    for (const double one : drawn[k]) mean[k] += one / kRuns;
  }
  double both = 0.0, first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < kRuns; ++i) {
    const double a = drawn[0][i] - mean[0], b = drawn[1][i] - mean[1];
    both += a * b, first += a * a, second += b * b;
  }
  CHECK(std::abs(both / std::sqrt(first * second)) < 0.25);
}

TEST_CASE("A camera without a rate has new noise at each look, and the stamp of that moment") {
  MocapOptions options = Quiet();
  options.rate_hz = 0.0;
  options.stamp_jitter_s = 0.01;
  options.noise_along_m = 0.002;
  Mocap mocap(options, 3);
  double squares = 0.0, last_m = 0.0;
  int same = 0;
  for (int i = 1; i <= 400; ++i) {
    mocap.Observe({.t_s = 0.1 * (i - 1)}, {.t_s = 0.1 * i});
    const auto seen = mocap.Newest(0.1 * i);
    REQUIRE(seen);
    CHECK(seen->captured_s == 0.1 * i);
    const double along_m = seen->world_from_robot.x_m;
    squares += along_m * along_m / 400.0;
    same += along_m == last_m;
    last_m = along_m;
  }
  CHECK(same == 0);
  CHECK(std::sqrt(squares) == Approx(0.002).epsilon(0.15));
}

}  // namespace
}  // namespace rift::simulation
