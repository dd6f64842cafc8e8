#include "rift/gap/likeness.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

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

}  // namespace
}  // namespace rift::gap
