#include "rift/gap/comparison.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <stdexcept>

#include "rift/geometry/pose2.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using test::Moved;
using test::RandomPath;
using test::StraightPath;
using trajectory::Trajectory;

TEST_CASE("A path has no gap to itself") {
  std::mt19937_64 generator(1);
  const Trajectory path = RandomPath(generator, 80);
  const Comparison result = Compare(path, path, {});
  CHECK(result.gap_m == 0.0);
  CHECK(result.exact_gap_m == 0.0);
  CHECK(result.shape_gap_m < 1e-12);
  CHECK(result.frechet_m == 0.0);
  CHECK(result.dtw_m == 0.0);
  CHECK(result.length_ratio == 1.0);
  CHECK(result.max_yaw_error_rad == 0.0);
}

TEST_CASE("The exact gap is what ever more samples approach from below") {
  std::mt19937_64 generator(3);
  for (int i = 0; i < 50; ++i) {
    const Trajectory sim = RandomPath(generator, 40), real = RandomPath(generator, 60);
    const Comparison result = Compare(sim, real, {});
    GapOptions many;
    many.samples = 1'000'000;
    CHECK(result.exact_gap_m >= result.gap_m);
    CHECK(Gap(sim, real, many) <= result.exact_gap_m + 1e-14);
    CHECK(Gap(sim, real, many) == Approx(result.exact_gap_m).margin(1e-5));
  }
}

TEST_CASE("A shifted straight path has the shift as its gap and no shape left") {
  const Trajectory sim = StraightPath(0.7, 50);
  const Comparison result = Compare(sim, Moved(sim, {0.03, 0.04, 0.0}), {});
  CHECK(result.gap_m == Approx(0.05));
  CHECK(result.mean_error_m == Approx(0.05));
  CHECK(result.p95_error_m == Approx(0.05));
  CHECK(result.start_offset_m == Approx(0.05));
  CHECK(result.end_error_m == Approx(0.05));
  CHECK(result.start_aligned_gap_m == Approx(0.0).margin(1e-12));
  CHECK(result.shape_gap_m == Approx(0.0).margin(1e-12));
}

TEST_CASE("The best rigid motion undoes any rigid motion and says which") {
  std::mt19937_64 generator(4);
  const Trajectory sim = RandomPath(generator, 80);
  const geometry::Pose2 moved_from_sim{0.2, -0.3, 0.4};
  const Comparison result = Compare(sim, Moved(sim, moved_from_sim), {});
  CHECK(result.shape_gap_m < 1e-9);
  CHECK(result.real_from_sim.x_m == Approx(0.2));
  CHECK(result.real_from_sim.y_m == Approx(-0.3));
  CHECK(result.real_from_sim.yaw_rad == Approx(0.4));
  CHECK(result.mean_yaw_error_rad == Approx(0.4));
  CHECK(result.max_yaw_error_rad == Approx(0.4));
}

TEST_CASE("A constant heading error grows linearly and is largest at the end") {
  const Trajectory sim = StraightPath(1.0, 30);
  const Comparison result = Compare(sim, Moved(sim, {0.0, 0.0, 0.1}), {});
  CHECK(result.gap_m == Approx(2.0 * std::sin(0.05)));
  CHECK(result.gap_u == Approx(1.0));
  CHECK(result.median_error_m == Approx(std::sin(0.05)).epsilon(1e-3));
}

TEST_CASE("Skipping the start hides an error that stands only there") {
  Trajectory real = StraightPath(1.0, 101);
  real.poses[2].y_m = 0.2;
  const Trajectory sim = StraightPath(1.0, 101);
  GapOptions options;
  const double whole_m = Gap(sim, real, options);
  options.skip_start = 0.5;
  CHECK(Gap(sim, real, options) < 0.9 * whole_m);
}

TEST_CASE("Speed does not matter to the gap but does at equal time") {
  Trajectory real = StraightPath(1.0, 50);
  for (trajectory::StampedPose& pose : real.poses) pose.t_s *= 2.0;
  const Comparison result = Compare(StraightPath(1.0, 50), real, {});
  CHECK(result.gap_m == Approx(0.0).margin(1e-12));
  CHECK(result.equal_time_m == Approx(0.5).epsilon(0.01));
}

TEST_CASE("Aligning and trimming reach the distance at equal time") {
  std::mt19937_64 generator(11);
  const Trajectory sim = RandomPath(generator, 60);
  const Trajectory shifted = Moved(sim, {0.3, -0.4, 0.0});
  GapOptions options;
  CHECK(Compare(sim, shifted, options).equal_time_m == Approx(0.5));
  options.align = Align::kStart;
  CHECK(Compare(sim, shifted, options).equal_time_m == Approx(0.0).margin(1e-12));
  options.align = Align::kSe2;
  const Trajectory moved = Moved(sim, {0.3, -0.4, 1.0});
  CHECK(Compare(sim, moved, options).equal_time_m == Approx(0.0).margin(1e-9));

  Trajectory waiting = StraightPath(1.0, 50);
  waiting.poses.insert(waiting.poses.begin(), {.t_s = -2.0, .yaw_rad = 0.0});
  options = {};
  CHECK(Compare(StraightPath(1.0, 50), waiting, options).equal_time_m == Approx(1.0));
  options.trim_standstill = true;
  CHECK(Compare(StraightPath(1.0, 50), waiting, options).equal_time_m == Approx(0.0).margin(1e-12));
}

/// Where the path was that long after its start, straight from the definition.
Eigen::Vector2d PositionAfter(const Trajectory& path, double since_start_s) {
  const double t_s = path.poses.front().t_s + since_start_s;
  size_t i = 1;
  while (i + 1 < path.poses.size() && path.poses[i].t_s < t_s) ++i;
  const trajectory::StampedPose &from = path.poses[i - 1], &to = path.poses[i];
  const double share = (t_s - from.t_s) / (to.t_s - from.t_s);
  return (1.0 - share) * from.Position() + share * to.Position();
}

void SetRandomTimes(Trajectory& path, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> step_s(0.01, 0.5);
  double t_s = step_s(generator);
  for (trajectory::StampedPose& pose : path.poses) pose.t_s = t_s += step_s(generator);
}

TEST_CASE("The distance at equal time is the largest at any stamp of either path") {
  std::mt19937_64 generator(12);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Trajectory sim = RandomPath(generator, 30), real = RandomPath(generator, 20 + repeat);
    SetRandomTimes(sim, generator);
    SetRandomTimes(real, generator);
    const double end_s = std::min(sim.Duration_s(), real.Duration_s());
    double largest_m = 0.0;
    for (const Trajectory* path : {&sim, &real}) {
      for (const trajectory::StampedPose& pose : path->poses) {
        const double since_start_s = pose.t_s - path->poses.front().t_s;
        if (since_start_s > end_s) break;
        largest_m = std::max(
            largest_m,
            (PositionAfter(sim, since_start_s) - PositionAfter(real, since_start_s)).norm());
      }
    }
    CHECK(Compare(sim, real, {}).equal_time_m == Approx(largest_m));
  }
}

TEST_CASE("Aligning turns the yaw with the path") {
  std::mt19937_64 generator(13);
  const Trajectory sim = RandomPath(generator, 80);
  const Trajectory real = Moved(sim, {0.2, -0.3, 0.4});
  GapOptions options;
  options.align = Align::kSe2;
  CHECK(Compare(sim, real, options).max_yaw_error_rad == Approx(0.0).margin(1e-9));
  options.align = Align::kStart;
  CHECK(Compare(sim, real, options).max_yaw_error_rad == Approx(0.4));
}

TEST_CASE("Yaw errors are told where both yaws are known") {
  Trajectory real = StraightPath(1.0, 101);
  for (trajectory::StampedPose& pose : real.poses) pose.yaw_rad = pose.x_m < 0.3 ? 0.1 : 0.3;
  real.poses[20].yaw_rad = trajectory::StampedPose::kNotLogged;
  const Trajectory sim = StraightPath(1.0, 101);
  const Comparison result = Compare(sim, real, {});
  CHECK(result.max_yaw_error_rad == Approx(0.3));
  CHECK(result.mean_yaw_error_rad == Approx(0.3 * 0.1 + 0.7 * 0.3).margin(0.005));
  const ErrorProfile profile = ProfileAlong(sim, real, {});
  for (size_t i = 0; i < profile.u.size(); ++i) {
    const bool is_told = !std::isnan(profile.yaw_error_rad[i]);
    if (std::abs(profile.u[i] - 0.2) > 0.0101) CHECK(is_told);
    if (std::abs(profile.u[i] - 0.2) < 0.0099) CHECK_FALSE(is_told);
  }
  for (trajectory::StampedPose& pose : real.poses) {
    pose.yaw_rad = trajectory::StampedPose::kNotLogged;
  }
  CHECK(std::isnan(Compare(sim, real, {}).max_yaw_error_rad));
}

TEST_CASE("Times along a path are those of equal shares of its length, behind a stop its end") {
  // 1 m at 0.5 m/s from 3 s on, a stop of 4 s, and 1 m at 0.25 m/s.
  Trajectory path = StraightPath(2.0, 201);
  for (trajectory::StampedPose& pose : path.poses) {
    pose.t_s = pose.x_m < 0.995 ? 3.0 + 2.0 * pose.x_m : 9.0 + 4.0 * (pose.x_m - 1.0);
  }
  trajectory::StampedPose stopped = path.poses[100];
  stopped.t_s = 5.0;
  path.poses.insert(path.poses.begin() + 100, stopped);
  GapOptions options;
  options.samples = 9;
  const std::vector<double> expected_s{0.0, 0.5, 1.0, 1.5, 6.0, 7.0, 8.0, 9.0, 10.0};
  const std::vector<double> times_s = TimesAlong_s(path, options);
  REQUIRE(times_s.size() == expected_s.size());
  for (size_t i = 0; i < times_s.size(); ++i) CHECK(times_s[i] == Approx(expected_s[i]));
  for (trajectory::StampedPose& pose : path.poses) pose.z_m = 0.5 * pose.x_m;
  options.dimension = Dimension::kXyz;
  CHECK(TimesAlong_s(path, options)[6] == Approx(8.0));
  for (trajectory::StampedPose& pose : path.poses) pose.x_m = pose.y_m = pose.z_m = 0.0;
  CHECK_THROWS_AS(TimesAlong_s(path, options), std::invalid_argument);
}

TEST_CASE("The best rigid motion is the best one over as many points as were asked for") {
  std::mt19937_64 generator(14);
  const Trajectory sim = RandomPath(generator, 80), real = RandomPath(generator, 80);
  GapOptions options;
  options.samples = 20'001;
  const geometry::Pose2 best = Compare(sim, real, options).real_from_sim;
  // The mean square over those points has its least value there.
  const auto mean_square = [&](const geometry::Pose2& motion) {
    const double rms_m = Compare(Moved(sim, motion), real, options).rms_error_m;
    return rms_m * rms_m;
  };
  constexpr double kStep = 1e-5;
  for (double geometry::Pose2::*field :
       {&geometry::Pose2::x_m, &geometry::Pose2::y_m, &geometry::Pose2::yaw_rad}) {
    geometry::Pose2 more = best, less = best;
    more.*field += kStep;
    less.*field -= kStep;
    CHECK(std::abs(mean_square(more) - mean_square(less)) / (2.0 * kStep) < 1e-8);
  }
}

TEST_CASE("Hausdorff sees a spike between the resampled points") {
  Trajectory real = StraightPath(1.0, 101);
  real.poses[50].y_m = 0.0123;
  const Comparison result = Compare(StraightPath(1.0, 101), real, {});
  CHECK(result.hausdorff_m == Approx(0.0123));
}

TEST_CASE("Frechet lies between Hausdorff and the exact gap, however long the logs are") {
  for (const int rows : {101, 256, 257, 500}) {
    INFO(rows << " rows");
    Trajectory sim = StraightPath(20.0, rows), real = sim;
    real.poses[rows / 3].y_m = 0.12;
    const Comparison result = Compare(sim, real, {});
    CHECK(result.hausdorff_m == Approx(0.12));
    CHECK(result.frechet_m == Approx(0.12).margin(2e-3));
  }
  std::mt19937_64 generator(16);
  for (int i = 0; i < 50; ++i) {
    const Comparison result =
        Compare(RandomPath(generator, 3 + 9 * i), RandomPath(generator, 300 - 5 * i), {});
    CHECK(result.frechet_m >= result.hausdorff_m);
    CHECK(result.frechet_m <= result.exact_gap_m + 1e-12);
  }
}

TEST_CASE("Frechet of two paths at another pace is how far they are apart") {
  // The same line, with vertices in other places: nothing of it is pace.
  Trajectory coarse = StraightPath(1.0, 3), fine = StraightPath(1.0, 211);
  for (auto& pose : fine.poses) pose.y_m = 0.04;
  CHECK(Compare(coarse, fine, {}).frechet_m == Approx(0.04));
  coarse.poses[1].y_m = 0.3;  // a bend at its middle
  CHECK(Compare(StraightPath(1.0, 3), coarse, {}).frechet_m == Approx(0.3).margin(0.005));
}

TEST_CASE("Hausdorff of long logs is close to that of all their vertices") {
  const Trajectory sim = StraightPath(1.0, 2000);
  const Comparison result = Compare(sim, Moved(sim, {0.0, 0.05, 0.0}), {});
  CHECK(result.hausdorff_m == Approx(0.05));
}

TEST_CASE("Jitter of a standing robot is counted and can be trimmed") {
  std::mt19937_64 generator(5);
  std::normal_distribution<double> jitter_m(0.0, 0.0005);
  Trajectory real = StraightPath(1.0, 50), noisy;
  for (int i = 0; i < 100; ++i) {
    noisy.poses.push_back({.t_s = -10.0 + 0.05 * i,
                           .x_m = jitter_m(generator),
                           .y_m = jitter_m(generator),
                           .yaw_rad = 0.0});
  }
  noisy.poses.insert(noisy.poses.end(), real.poses.begin(), real.poses.end());
  GapOptions options;
  const Comparison counted = Compare(real, noisy, options);
  CHECK(counted.real_standstill_share > 0.05);
  CHECK(counted.sim_standstill_share == Approx(0.0).margin(1e-9));
  options.trim_standstill = true;
  const Comparison trimmed = Compare(real, noisy, options);
  CHECK(trimmed.gap_m < 0.2 * counted.gap_m);
}

TEST_CASE("All of the arc length of a robot that never leaves its place is standstill") {
  Trajectory stands;
  for (int i = 0; i < 60; ++i) {
    stands.poses.push_back({.t_s = 0.05 * i, .x_m = i % 2 == 0 ? 0.003 : -0.003, .y_m = 0.0});
  }
  GapOptions options;
  for (const bool trims : {false, true}) {
    options.trim_standstill = trims;
    const Comparison result = Compare(StraightPath(1.0, 50), stands, options);
    CHECK(result.real_standstill_share == 1.0);
    CHECK(result.sim_standstill_share == Approx(0.0).margin(1e-9));
    CHECK(Compare(stands, StraightPath(1.0, 50), options).sim_standstill_share == 1.0);
  }
  options.standstill_radius_m = 0.005;  // from its first pose it goes 6 mm to the other side
  CHECK(Compare(stands, stands, options).real_standstill_share == 0.0);
}

TEST_CASE("The length of a way holds what was driven near its ends, and no jitter there") {
  Trajectory path = StraightPath(1.0, 201);
  const double length_m = path.ArcLength_m();
  CHECK(MovingLength_m(path, {}) == Approx(length_m));
  Trajectory waits;
  for (int i = 0; i < 400; ++i) {
    waits.poses.push_back({.t_s = 0.05 * i - 20.0,
                           .x_m = path.poses[0].x_m,
                           .y_m = path.poses[0].y_m + (i % 2 == 0 ? 0.0 : 0.001)});
  }
  waits.poses.insert(waits.poses.end(), path.poses.begin(), path.poses.end());
  CHECK(waits.ArcLength_m() > 1.39);
  CHECK(MovingLength_m(waits, {}) == Approx(length_m).epsilon(1e-3));
  waits.poses.resize(400);
  CHECK(MovingLength_m(waits, {}) == 0.0);
}

TEST_CASE("Hausdorff and Frechet tell a detour back and forth apart") {
  // Forward, back and forward again along one line: every point is on the other path, but no
  // walk along both stays close.
  Trajectory there_and_back;
  for (const double x_m : {0.0, 0.8, 0.2, 1.0}) {
    there_and_back.poses.push_back(
        {.t_s = static_cast<double>(there_and_back.poses.size()), .x_m = x_m});
  }
  const Comparison result = Compare(StraightPath(1.0, 50), there_and_back, {});
  CHECK(result.hausdorff_m == Approx(0.0).margin(0.005));
  CHECK(result.frechet_m == Approx(0.3).margin(0.01));
}

TEST_CASE("Measures that do not know the order of the paths are symmetric") {
  std::mt19937_64 generator(6);
  const Trajectory a = RandomPath(generator, 50), b = RandomPath(generator, 70);
  const Comparison ab = Compare(a, b, {}), ba = Compare(b, a, {});
  CHECK(ab.gap_m == Approx(ba.gap_m));
  CHECK(ab.hausdorff_m == Approx(ba.hausdorff_m));
  CHECK(ab.frechet_m == Approx(ba.frechet_m));
  CHECK(ab.equal_time_m == Approx(ba.equal_time_m));
  CHECK(ab.length_ratio == Approx(1.0 / ba.length_ratio));
  CHECK(ab.hausdorff_m <= ab.frechet_m);
}

TEST_CASE("Repeated points do not disturb the arc length") {
  Trajectory sim = StraightPath(1.0, 20);
  sim.poses.insert(sim.poses.begin() + 7, sim.poses[7]);
  sim.poses.insert(sim.poses.begin(), sim.poses[0]);
  sim.poses.push_back(sim.poses.back());
  CHECK(Gap(sim, StraightPath(1.0, 33), {}) == Approx(0.0).margin(1e-12));
  CHECK(Gap(StraightPath(1.0, 33), sim, {}) == Approx(0.0).margin(1e-12));
}

TEST_CASE("A path without a finite length is refused") {
  Trajectory huge = StraightPath(1.0, 5);
  huge.poses[1].x_m = 1e308;
  huge.poses[2].x_m = -1e308;
  CHECK_THROWS_AS(Gap(huge, StraightPath(1.0, 5), {}), std::invalid_argument);
  CHECK_THROWS_AS(Compare(StraightPath(1.0, 5), huge, {}), std::invalid_argument);
  huge.poses[1].x_m = kNotComputed;
  CHECK_THROWS_AS(Gap(huge, StraightPath(1.0, 5), {}), std::invalid_argument);
}

TEST_CASE("A path that never moves is refused") {
  Trajectory still;
  still.poses = {{.t_s = 0.0}, {.t_s = 1.0}};
  CHECK_THROWS_AS(Compare(still, StraightPath(1.0, 5), {}), std::invalid_argument);
  still.poses.pop_back();
  CHECK_THROWS_AS(Compare(StraightPath(1.0, 5), still, {}), std::invalid_argument);
}

}  // namespace
}  // namespace rift::gap
