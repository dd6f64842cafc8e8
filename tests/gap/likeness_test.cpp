#include "rift/gap/likeness.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <stdexcept>
#include <vector>

#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;

/// A metre along x that weaves as a sine, at `speed_mps`.
Trajectory Weaving(double amplitude_m, double wavelength_m, double speed_mps, double offset_m,
                   double phase_rad = 0.0) {
  Trajectory path;
  for (int i = 0; i <= 200; ++i) {
    const double x_m = i / 200.0;
    const double y_m =
        offset_m + amplitude_m * std::sin(2.0 * std::numbers::pi * x_m / wavelength_m + phase_rad);
    path.poses.push_back({.t_s = x_m / speed_mps, .x_m = x_m, .y_m = y_m});
  }
  return path;
}

/// Paths that wander from run to run: offset, amplitude and phase are drawn anew.
std::vector<Trajectory> Runs(int count, double scatter_m, std::mt19937_64& generator) {
  std::normal_distribution<double> normal;
  std::vector<Trajectory> runs;
  for (int i = 0; i < count; ++i) {
    runs.push_back(Weaving(0.01 + 0.3 * scatter_m * normal(generator), 0.25, 0.3,
                           scatter_m * normal(generator), normal(generator)));
  }
  return runs;
}

TEST_CASE("A path that weaves as a sine has its speed and its amplitude over root two") {
  const PathTraits traits = TraitsOf(Weaving(0.01, 0.25, 0.3, 0.0), {});
  CHECK(traits.weave_m == Approx(0.01 / std::sqrt(2.0)).epsilon(0.05));
  CHECK(traits.speed_mps == Approx(0.3).epsilon(0.05));
}

TEST_CASE("The weave does not depend on where the path leads") {
  const Trajectory path = Weaving(0.01, 0.25, 0.3, 0.0);
  const Trajectory turned = test::Moved(path, {0.3, -0.2, 1.4});
  CHECK(TraitsOf(turned, {}).weave_m == Approx(TraitsOf(path, {}).weave_m));
}

TEST_CASE("The dominant wavelength is that of the strongest weave") {
  const std::vector<Trajectory> paths{Weaving(0.01, 0.25, 0.3, 0.0, 0.3),
                                      Weaving(0.012, 0.25, 0.3, 0.0, 1.3),
                                      Weaving(0.003, 0.1, 0.3, 0.0, 0.9)};
  CHECK(DominantWavelength_m(paths, {}) == Approx(0.25).epsilon(0.06));
  CHECK(std::isnan(DominantWavelength_m({}, {})));
  // The same weave over half the length, and a weave of another wavelength over twice the length.
  Trajectory half = Weaving(0.01, 0.25, 0.3, 0.0), twice = Weaving(0.01, 0.1, 0.3, 0.0);
  half.poses.resize(half.poses.size() / 2);
  for (auto& pose : twice.poses) pose.x_m *= 2.0;
  CHECK(DominantWavelength_m(std::span(&half, 1), {}) == Approx(0.25).epsilon(0.08));
  CHECK(DominantWavelength_m(std::span(&twice, 1), {}) == Approx(0.2).epsilon(0.06));
}

TEST_CASE("A weave of two micrometres and less is rounding and has no wavelength") {
  const auto wavelength_m = [](double amplitude_m) {
    const Trajectory path = Weaving(amplitude_m, 0.25, 0.3, 0.0);
    return DominantWavelength_m(std::span(&path, 1), {});
  };
  CHECK(std::isnan(wavelength_m(1.9e-6)));
  CHECK(wavelength_m(2.6e-6) == Approx(0.25).epsilon(0.06));  // a line and a grid take a part
}

TEST_CASE("A simulator drawn as the robot is like it and the test does not object") {
  std::mt19937_64 generator(7);
  std::vector<RepeatedSetting> settings;
  for (int i = 0; i < 12; ++i) {
    settings.push_back({Runs(3, 0.02, generator), {Runs(10, 0.02, generator)}});
  }
  const Likeness likeness = MeasureLikeness(settings, {}, {}, generator);
  CHECK(likeness.reals == 36);
  CHECK(likeness.sims == 120);
  CHECK(likeness.spread_m.Ratio() == Approx(1.0).margin(0.2));
  CHECK(likeness.weave_m.Ratio() == Approx(1.0).margin(0.15));
  CHECK(likeness.mean_gap_m == Approx(likeness.spread_m.real).epsilon(0.25));
  CHECK(likeness.mean_path_gap_m < likeness.mean_gap_m);
  CHECK(likeness.energy_p > 0.05);
  CHECK(likeness.inside_expected == Approx(10.0 / 11.0));
  CHECK(likeness.inside_share > 0.7);
}

TEST_CASE("A tame simulator has the smaller gap and is told by spread and test and band") {
  std::mt19937_64 generator(8);
  std::vector<RepeatedSetting> like, tame;
  for (int i = 0; i < 12; ++i) {
    const std::vector<Trajectory> reals = Runs(3, 0.02, generator);
    like.push_back({reals, {Runs(10, 0.02, generator)}});
    tame.push_back({reals, {Runs(10, 0.002, generator)}});
  }
  const Likeness of_like = MeasureLikeness(like, {}, {}, generator);
  const Likeness of_tame = MeasureLikeness(tame, {}, {}, generator);
  CHECK(of_tame.mean_gap_m < of_like.mean_gap_m);
  CHECK(of_tame.spread_m.Ratio() < 0.4);
  CHECK(of_tame.energy_p < 0.01);
  CHECK(of_tame.inside_share < 0.3);
}

TEST_CASE("Runs matched to their real path spread as pairs of repeats do") {
  std::mt19937_64 generator(9);
  // Each real path has an offset of its own, which its runs share: no run repeats another's start.
  RepeatedSetting setting;
  for (const double offset_m : {0.0, 0.05}) {
    setting.reals.push_back(Weaving(0.01, 0.25, 0.3, offset_m));
    setting.sims.push_back(
        {Weaving(0.01, 0.25, 0.3, offset_m), Weaving(0.01, 0.25, 0.3, offset_m)});
  }
  const Likeness likeness = MeasureLikeness({&setting, 1}, {}, {}, generator);
  CHECK(likeness.spread_m.sim == Approx(0.05));
  CHECK(likeness.spread_m.real == Approx(0.05));
  CHECK(likeness.mean_gap_m == Approx(0.0).margin(1e-12));
}

TEST_CASE("The test keeps to its level where both sides are one distribution") {
  std::mt19937_64 generator(10);
  const LikenessOptions options{.points = 16, .shuffles = 99};
  int rejected = 0;
  for (int i = 0; i < 200; ++i) {
    const RepeatedSetting setting{Runs(4, 0.02, generator), {Runs(6, 0.02, generator)}};
    rejected += MeasureLikeness({&setting, 1}, {}, options, generator).energy_p <= 0.05;
  }
  CHECK(rejected <= 20);  // 10 expected; more than 20 of 200 has a chance of 0.001
}

TEST_CASE("A likeness of nothing is not a number and lists that fit no real path are refused") {
  std::mt19937_64 generator(11);
  const Likeness none = MeasureLikeness({}, {}, {}, generator);
  CHECK(std::isnan(none.spread_m.Ratio()));
  CHECK(std::isnan(none.energy_p));
  const RepeatedSetting odd{Runs(3, 0.02, generator),
                            {Runs(1, 0.02, generator), Runs(1, 0.02, generator)}};
  CHECK_THROWS_AS(MeasureLikeness({&odd, 1}, {}, {}, generator), std::invalid_argument);
}

TEST_CASE("The same generator gives the same likeness") {
  std::mt19937_64 paths(12), one(1), two(1);
  const RepeatedSetting setting{Runs(3, 0.02, paths), {Runs(5, 0.02, paths)}};
  CHECK(MeasureLikeness({&setting, 1}, {}, {}, one).energy_p ==
        MeasureLikeness({&setting, 1}, {}, {}, two).energy_p);
}

/// A zigzag about x of nine points, all edges alike, so that its points at even shares are those.
Trajectory Zigzag(double half_m) {
  Trajectory path;
  for (int i = 0; i < 9; ++i) {
    path.poses.push_back({.t_s = 1.0 * i, .x_m = 1.0 * i, .y_m = i % 2 == 0 ? half_m : -half_m});
  }
  return path;
}

TEST_CASE("The weave of a zigzag is the root of the mean of its squares about its line") {
  // Five points above and four below: the line is a ninth of the half above its middle.
  const LikenessOptions options{.points = 9, .speed_stride = 1};
  const PathTraits traits = TraitsOf(Zigzag(0.25), options);
  CHECK(traits.weave_m == Approx(0.25 * std::sqrt(80.0 / 81.0)).epsilon(1e-9));
  CHECK(traits.speed_mps == Approx(std::hypot(1.0, 0.5)));
}

TEST_CASE("A path of one row more than the stride has a speed, above the limit alone") {
  const auto speed_mps = [](int rows, int stride, double moving_mps) {
    Trajectory path;
    for (int i = 0; i < rows; ++i) path.poses.push_back({.t_s = 0.5 * i, .x_m = 0.25 * i});
    return TraitsOf(path, {.speed_stride = stride, .moving_mps = moving_mps}).speed_mps;
  };
  CHECK(speed_mps(4, 3, 0.1) == 0.5);
  CHECK(std::isnan(speed_mps(3, 3, 0.1)));
  CHECK(speed_mps(2, 1, 0.1) == 0.5);
  CHECK(std::isnan(speed_mps(4, 3, 0.5)));  // as fast as the limit is standing
  CHECK(speed_mps(4, 3, std::nextafter(0.5, 0.0)) == 0.5);
}

TEST_CASE("A wavelength is one of sixty from the shortest to the length of the longest path") {
  const std::vector<Trajectory> paths{Weaving(0.001, 0.25, 0.3, 0.0),
                                      Weaving(0.01, 0.25, 0.3, 0.0)};
  for (const double shortest_m : {0.06, 0.2, 0.03}) {
    const LikenessOptions options{.wavelength_min_m = shortest_m};
    const double found_m = DominantWavelength_m(paths, options);
    const double longest_m = std::max(paths[0].ArcLength_m(), paths[1].ArcLength_m());
    CHECK(found_m == Approx(0.25).epsilon(0.06));
    const double place = 59.0 * std::log(found_m / shortest_m) / std::log(longest_m / shortest_m);
    INFO(shortest_m << " " << place);
    CHECK(place == Approx(std::round(place)).margin(1e-6));
  }
  // A shorter weave than is looked for is not found.
  CHECK(DominantWavelength_m(paths, {.wavelength_min_m = 0.4}) > 0.39);
}

TEST_CASE("No wavelength is looked for in a path that is no longer than the shortest of them") {
  Trajectory path;
  for (int i = 0; i <= 8; ++i) {
    path.poses.push_back({.t_s = 1.0 * i, .x_m = 0.0, .y_m = 0.125 * i});
    path.poses.back().x_m = i % 2 == 0 ? 0.0 : 0.25;
  }
  const std::span<const Trajectory> one(&path, 1);
  const double length_m = path.ArcLength_m();
  CHECK(std::isnan(DominantWavelength_m(one, {.wavelength_min_m = length_m})));
  CHECK(DominantWavelength_m(one, {.wavelength_min_m = 0.5 * length_m}) >= 0.5 * length_m);
}

/// A metre along x, so far to its left.
Trajectory Aside(double left_m) {
  return test::Moved(test::StraightPath(1.0, 101), {0.0, left_m, 0.0});
}

LikenessOptions Quick() {
  LikenessOptions options{.shuffles = 19};
  options.bootstrap.resamples = 100;
  return options;
}

TEST_CASE("A real path as far from the mean run as the furthest run from the others is inside") {
  std::mt19937_64 generator(3);
  const auto inside = [&](double real_m) {
    const RepeatedSetting setting{{Aside(real_m)}, {{Aside(0.0), Aside(0.5)}}};
    return MeasureLikeness({&setting, 1}, {}, Quick(), generator).inside_share;
  };
  // The runs are half a metre apart, their mean stands at 0.25 m.
  CHECK(inside(0.75) == 1.0);
  CHECK(inside(-0.25) == 1.0);
  CHECK(inside(0.76) == 0.0);
  CHECK(inside(-0.26) == 0.0);
}

TEST_CASE("One run has no band, and repeats of unequal numbers spread as far as both go") {
  std::mt19937_64 generator(3);
  const RepeatedSetting single{{Aside(0.0), Aside(0.1)}, {{Aside(0.03)}}};
  Likeness found = MeasureLikeness({&single, 1}, {}, Quick(), generator);
  CHECK(std::isnan(found.inside_share));
  CHECK(std::isnan(found.inside_expected));
  CHECK(std::isnan(found.spread_m.sim));
  CHECK(found.mean_gap_m == Approx((0.03 + 0.07) / 2.0));
  CHECK(found.mean_path_gap_m == Approx(found.mean_gap_m));
  // Matched: the second real path has one run, the third none.
  const RepeatedSetting uneven{{Aside(0.0), Aside(0.2), Aside(0.5)},
                               {{Aside(0.01), Aside(0.04)}, {Aside(0.25)}, {}}};
  found = MeasureLikeness({&uneven, 1}, {}, Quick(), generator);
  CHECK(found.sims == 3);
  CHECK(found.spread_m.sim == Approx(0.24));
  CHECK(found.mean_gap_m == Approx((0.01 + 0.04 + 0.05) / 3.0));
  CHECK(found.mean_path_gap_m == Approx((0.025 + 0.05) / 2.0));
  CHECK(found.inside_share == 1.0);  // of the first alone: 0.025 m from the mean, 0.03 m apart
  CHECK(found.inside_expected == Approx(2.0 / 3.0));
}

TEST_CASE("The gap of a mean run is that of what each path drove, and none without a run") {
  CHECK(std::isnan(MeanPathGap_m(Aside(0.0), {}, {}, {})));
  const std::vector<Trajectory> runs{Aside(0.1), Aside(0.3), Aside(0.2)};
  CHECK(MeanPathGap_m(Aside(0.05), runs, {}, {}) == Approx(0.15));
  // A stand with jitter of 6 mm, which trimming takes off the runs and off the real path.
  const auto waiting = [](double left_m) {
    Trajectory path = Aside(left_m);
    const trajectory::StampedPose start = path.poses.front();
    for (int i = 0; i < 300; ++i) {
      trajectory::StampedPose pose = start;
      pose.t_s = -1.0 - 0.1 * i;
      if (i % 2 == 0) pose.y_m += 0.006;
      path.poses.insert(path.poses.begin(), pose);
    }
    return path;
  };
  const std::vector<Trajectory> waited{waiting(0.1), waiting(0.3), waiting(0.2)};
  GapOptions trimmed;
  trimmed.trim_standstill = true;
  CHECK(MeanPathGap_m(Aside(0.05), waited, trimmed, {}) == Approx(0.15).epsilon(0.03));
  CHECK(MeanPathGap_m(waiting(0.05), runs, trimmed, {}) == Approx(0.15).epsilon(0.03));
  CHECK(MeanPathGap_m(waiting(0.05), runs, {}, {}) > 0.5);
}

}  // namespace
}  // namespace rift::gap
