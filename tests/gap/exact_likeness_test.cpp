// Likeness, judgements and definitions, each worked out by hand.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "gap/path_shape.hpp"
#include "rift/gap/comparison.hpp"
#include "rift/gap/goal.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/gap/result.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

using trajectory::Trajectory;

/// A metre along x, so far to its left, in so many seconds.
Trajectory Lane(double left_m, double takes_s = 1.0) {
  Trajectory path = test::Moved(test::StraightPath(1.0, 101), {0.0, left_m, 0.0});
  for (auto& pose : path.poses) pose.t_s *= takes_s;
  return path;
}

LikenessOptions Few() {
  LikenessOptions options;
  options.shuffles = 99;
  options.bootstrap.resamples = 200;
  return options;
}

TEST_CASE("Likeness of parallel lanes is that of their places") {
  std::mt19937_64 generator(3);
  const RepeatedSetting setting{{Lane(0.0), Lane(0.012, 2.0)},
                                {{Lane(0.02, 2.5), Lane(0.04, 4.0)}}};
  const Likeness found = MeasureLikeness({&setting, 1}, {}, Few(), generator);
  CHECK(found.reals == 2);
  CHECK(found.sims == 2);
  CHECK(found.spread_m.real == Approx(0.012));
  CHECK(found.spread_m.sim == Approx(0.02));
  CHECK(found.spread_m.Ratio() == Approx(5.0 / 3.0));
  CHECK(found.mean_gap_m == Approx((0.02 + 0.04 + 0.008 + 0.028) / 4.0));
  CHECK(found.mean_path_gap_m == Approx((0.03 + 0.018) / 2.0));
  CHECK(found.speed_mps.real == Approx((1.0 + 0.5) / 2.0));
  CHECK(found.speed_mps.sim == Approx((0.4 + 0.25) / 2.0));
  CHECK(found.weave_m.real == Approx(0.0).margin(1e-12));
  // Each run is 0.02 from the other, the reals are 0.03 and 0.018 from the mean of both.
  CHECK(found.inside_share == 0.5);
  CHECK(found.inside_expected == Approx(2.0 / 3.0));
  // Twice the mean distance across, less the mean distances on either side, oneself included.
  CHECK(found.energy_m == Approx(2.0 * 0.024 - 0.012 / 2.0 - 0.02 / 2.0));
}

TEST_CASE("Runs that are matched to their real path are held against that one alone") {
  std::mt19937_64 generator(3);
  const RepeatedSetting setting{{Lane(0.0), Lane(0.1)},
                                {{Lane(0.01), Lane(0.03)}, {Lane(0.14), Lane(0.15)}}};
  const Likeness found = MeasureLikeness({&setting, 1}, {}, Few(), generator);
  CHECK(found.mean_gap_m == Approx((0.01 + 0.03 + 0.04 + 0.05) / 4.0));
  CHECK(found.mean_path_gap_m == Approx((0.02 + 0.045) / 2.0));
  CHECK(found.spread_m.real == Approx(0.1));
  CHECK(found.spread_m.sim == Approx((0.13 + 0.12) / 2.0));  // run 1 of each, run 2 of each
  CHECK(found.inside_share == 0.5);  // 0.02 from a mean whose runs are 0.02 apart; 0.045 from 0.01
}

TEST_CASE("Numbers are means over the settings, and one alone has no interval") {
  std::mt19937_64 generator(3);
  const std::vector<RepeatedSetting> settings{
      {{Lane(0.0), Lane(0.01)}, {{Lane(0.02), Lane(0.04)}}},
      {{Lane(0.0), Lane(0.03)}, {{Lane(0.02), Lane(0.08)}}}};
  const Likeness found = MeasureLikeness(settings, {}, Few(), generator);
  CHECK(found.spread_m.real == Approx(0.02));
  CHECK(found.spread_m.sim == Approx(0.04));
  CHECK(found.spread_m.ratio_interval.low == Approx(2.0));  // in each of them
  CHECK(found.spread_m.ratio_interval.high == Approx(2.0));
  const Likeness one = MeasureLikeness({settings.data(), 1}, {}, Few(), generator);
  CHECK(std::isnan(one.spread_m.ratio_interval.low));
}

/// A lane that begins and ends with a robot that stands and jitters by 2 mm.
Trajectory WithStandstill(const Trajectory& lane) {
  Trajectory path;
  const auto stand = [&](const trajectory::StampedPose& pose) {
    for (int i = 0; i < 400; ++i) {
      trajectory::StampedPose at = pose;
      at.y_m += i % 2 == 0 ? 0.002 : -0.002;
      path.poses.push_back(at);
    }
  };
  stand(lane.poses.front());
  path.poses.insert(path.poses.end(), lane.poses.begin(), lane.poses.end());
  stand(lane.poses.back());
  for (size_t i = 0; i < path.poses.size(); ++i) path.poses[i].t_s = 0.01 * static_cast<double>(i);
  return path;
}

TEST_CASE("With the standstill trimmed, likeness is that of the paths that were driven") {
  const auto weaving = [](double left_m) {
    Trajectory path = Lane(left_m);
    for (auto& pose : path.poses) pose.y_m += 0.01 * std::sin(8.0 * std::numbers::pi * pose.x_m);
    return path;
  };
  const auto likeness = [&](bool stands, bool trims) {
    RepeatedSetting setting{{weaving(0.0), weaving(0.012)}, {{weaving(0.02), weaving(0.04)}}};
    for (auto* paths : {&setting.reals, &setting.sims.front()}) {
      for (Trajectory& path : *paths) path = stands ? WithStandstill(path) : path;
    }
    std::mt19937_64 generator(3);
    return MeasureLikeness({&setting, 1}, {.trim_standstill = trims}, Few(), generator);
  };
  const Likeness driven = likeness(false, false), trimmed = likeness(true, true);
  CHECK(trimmed.weave_m.sim == Approx(driven.weave_m.sim).epsilon(0.03));
  CHECK(trimmed.weave_m.real == Approx(driven.weave_m.real).epsilon(0.03));
  CHECK(trimmed.wavelength_m.real == Approx(0.25).epsilon(0.08));
  CHECK(trimmed.energy_m == Approx(driven.energy_m).epsilon(0.03));
  CHECK(trimmed.mean_path_gap_m == Approx(driven.mean_path_gap_m).epsilon(0.03));
  CHECK(trimmed.inside_share == driven.inside_share);
  // Jitter of 2 x 400 x 4 mm is three times as long as the lane, and weaves less.
  CHECK(likeness(true, false).weave_m.real < 0.7 * driven.weave_m.real);
}

TEST_CASE("A setting needs one list of runs, or one for each real path") {
  std::mt19937_64 generator(3);
  const RepeatedSetting odd{{Lane(0.0), Lane(0.1), Lane(0.2)}, {{Lane(0.0)}, {Lane(0.0)}}};
  CHECK_THROWS_WITH(MeasureLikeness({&odd, 1}, {}, Few(), generator),
                    "a setting has 3 real paths and 2 lists of runs, and must have one list, or "
                    "one for each real path");
}

TEST_CASE("A speed is over the stride, of the rows that move, and their median") {
  Trajectory path;
  double x_m = 0.0, t_s = 0.0;
  const auto drive = [&](int rows, double mps) {
    for (int i = 0; i < rows; ++i, t_s += 0.1, x_m += 0.1 * mps) {
      path.poses.push_back({.t_s = t_s, .x_m = x_m});
    }
  };
  drive(90, 0.05);  // counts as standing
  drive(30, 0.3);
  drive(20, 0.5);
  LikenessOptions options;
  CHECK(TraitsOf(path, options).speed_mps == Approx(0.3));
  options.moving_mps = 0.4;
  CHECK(TraitsOf(path, options).speed_mps == Approx(0.5));
  options.moving_mps = 0.0;
  CHECK(TraitsOf(path, options).speed_mps == Approx(0.05));
}

TEST_CASE("The mean path has the mean of the points at each share of the way") {
  const std::vector<Trajectory> paths{Lane(0.0), Lane(0.06), Lane(0.03)};
  const Trajectory mean = MeanPath(paths, {.points = 9});
  REQUIRE(mean.poses.size() == 9);
  CHECK(mean.poses[4].x_m == Approx(0.5));
  CHECK(mean.poses[8].x_m == Approx(1.0));
  CHECK(mean.poses[0].y_m == Approx(0.03));
  CHECK(mean.poses[3].t_s == 3.0);
}

TEST_CASE("Residuals lie across the line that fits best, whichever way it leads") {
  const Shape shape{{0.0, 0.0}, {1.0, 1.02}, {2.0, 1.98}, {3.0, 3.0}};
  const std::vector<double> residuals_m = LateralResiduals_m(shape);
  double sum_m = 0.0, squares_m2 = 0.0;
  for (const double one : residuals_m) sum_m += one, squares_m2 += one * one;
  CHECK(sum_m == Approx(0.0).margin(1e-9));
  CHECK(squares_m2 == Approx(2.0 * 0.02 * 0.02 / 2.0).epsilon(0.1));
  CHECK(residuals_m[1] * residuals_m[2] < 0.0);
  CHECK(Distance_m(shape, {{0.0, 1.0}, {1.0, 1.02}, {2.0, 1.98}, {3.0, 3.0}}) == Approx(0.25));
}

TEST_CASE("The energy of groups that are far apart beats every shuffle that mixes them") {
  std::mt19937_64 generator(3);
  const auto shape = [](double y_m) { return Shape{{0.0, y_m}, {1.0, y_m}}; };
  ShuffleGroup group;
  for (int i = 0; i < 6; ++i) {
    group.reals.push_back(shape(0.001 * i));
    group.sims.push_back(shape(1.0 + 0.001 * i));
  }
  const EnergyTest apart = TestEnergy({group}, 199, generator);
  CHECK(apart.energy_m == Approx(2.0).margin(0.01));
  CHECK(apart.p <= 3.0 / 200.0);  // 1 in 924 shuffles gives as much, or its mirror image
  CHECK(apart.p >= 1.0 / 200.0);
  // Groups of their own are shuffled within themselves: with one path each nothing can change.
  std::vector<ShuffleGroup> pairs;
  for (int i = 0; i < 6; ++i) pairs.push_back({{shape(i)}, {}});
  for (auto& pair : pairs) pair.sims.push_back(pair.reals[0]);
  CHECK(TestEnergy(pairs, 99, generator).p == 1.0);
  CHECK(std::isnan(TestEnergy({{{shape(0)}, {shape(1), shape(2)}}}, 99, generator).p));
  CHECK(std::isnan(TestEnergy({{{shape(0), shape(1)}, {shape(2)}}}, 99, generator).p));
}

TEST_CASE("A shuffle that gives the measured groups again counts in whatever order it drew them") {
  std::mt19937_64 generator(3);
  const auto at = [](const std::vector<double>& places_m) {
    std::vector<Shape> shapes;
    for (const double y_m : places_m) shapes.push_back({{0.0, y_m}, {1.0, 1.1 * y_m}});
    return shapes;
  };
  // Of the 20 ways to call three of six real two part them, of the 35 of three of seven one does.
  const ShuffleGroup even{at({0.013, 0.027, 0.031}), at({1.017, 1.029, 1.043})};
  CHECK(TestEnergy({even}, 20'000, generator).p == Approx(2.0 / 20.0).margin(0.01));
  const ShuffleGroup odd{at({0.013, 0.027, 0.031}), at({1.017, 1.029, 1.043, 1.071})};
  CHECK(TestEnergy({odd}, 20'000, generator).p == Approx(1.0 / 35.0).margin(0.005));
}

TEST_CASE("A result has the mean of its gaps, the floor of its reals and the verdict of both") {
  GapResult result;
  result.options.threshold_m = 0.05;
  result.judged_by.share = 0.2;
  for (const double gap_m : {0.04, 0.06, 0.08}) {
    result.trials.push_back({"x.csv", {.gap_m = gap_m}});
    result.reals.push_back(Lane(gap_m));
  }
  Judge(result);
  CHECK(result.mean_gap_m == Approx(0.06));
  CHECK(result.noise_floor_m == Approx((0.02 + 0.04 + 0.02) / 3.0));
  CHECK(result.verdict.above == 2);
  CHECK(result.verdict.repeats == 3);
  result.options.threshold_m = 0.06;  // a gap at it does not fail
  Judge(result);
  CHECK(result.verdict.above == 1);
}

TEST_CASE("A real log that was copied is one repeat, whatever its clock says") {
  GapResult result;
  for (const double gap_m : {0.08, 0.02, 0.08, 0.08}) {
    result.trials.push_back({"x.csv", {.gap_m = gap_m}});
    result.reals.push_back(Lane(gap_m));
  }
  for (auto& pose : result.reals[2].poses) pose.t_s += 3.0;
  CHECK(CopiesAmong(result.reals) ==
        std::vector<std::optional<size_t>>{std::nullopt, std::nullopt, 0, 0});
  Judge(result);
  CHECK(result.verdict.repeats == 2);
  CHECK(result.verdict.above == 1);
  CHECK(result.noise_floor_m == Approx(0.06));
  CHECK(result.mean_gap_m == Approx(0.065));                    // of all that stand in the table
  for (auto& pose : result.reals[2].poses) pose.x_m += 0.9e-5;  // written anew with fewer digits
  for (auto& pose : result.reals[3].poses) pose.y_m -= 0.9e-5;
  Judge(result);
  CHECK(result.verdict.repeats == 2);
  result.reals[2].poses.back().x_m += 0.2e-5;
  Judge(result);
  CHECK(result.verdict.repeats == 3);
  result.reals[2].poses.back().z_m = 0.001;
  result.reals[3].poses.pop_back();
  Judge(result);
  CHECK(result.verdict.repeats == 4);
}

TEST_CASE("What may fail is falsified, or undecided with a failure") {
  CHECK(JudgeCounts(3, 3, {}).MayFail());
  CHECK(JudgeCounts(1, 1, {}).MayFail());
  CHECK_FALSE(JudgeCounts(0, 0, {}).MayFail());
  CHECK_FALSE(JudgeCounts(0, 3, {}).MayFail());
  CHECK_FALSE(JudgeCounts(0, 100, {}).MayFail());
  std::vector<RepeatVerdict> none;
  JudgeTogether(none, 5, {});
  CHECK(none.empty());
}

TEST_CASE("Passed settings are judged together as falsified ones are") {
  const auto judged = [](int passing, int settings) {
    std::vector<RepeatVerdict> verdicts(static_cast<size_t>(passing), JudgeCounts(0, 40, {}));
    JudgeTogether(verdicts, settings, {});
    CHECK(verdicts[0].settings == settings);
    return verdicts[0].verdict;
  };
  REQUIRE(JudgeCounts(0, 40, {}).verdict == Verdict::kPassed);
  CHECK(judged(1, 1) == Verdict::kPassed);
  CHECK(judged(1, 500) == Verdict::kNotSeenToFail);
  CHECK(judged(400, 500) == Verdict::kPassed);
}

TEST_CASE("The definition in force names every option that differs from the paper's") {
  const std::string plain = "largest distance at equal normalised arc length u over 2000 samples";
  CHECK(DefinitionText({}) == plain);
  CHECK(DefinitionText({.samples = 100, .skip_start = 0.125}) ==
        "largest distance at equal normalised arc length u over 100 samples, the first 12.5 % left "
        "out");
  CHECK(DefinitionText({.dimension = Dimension::kXyz, .align = Align::kSe3}) ==
        "largest distance in x, y and z at equal normalised arc length u over 2000 samples, best "
        "rigid motion removed");
  CHECK(DefinitionText({.align = Align::kStart}) == plain + ", first points laid together");
  CHECK(DefinitionText({.align = Align::kSe2, .trim_standstill = true}, 0.03) ==
        plain +
            ", best rigid motion removed, standstill trimmed, real path 0.03 m ahead of the tag");
  CHECK(DefinitionText({}, -0.02) == plain + ", real path -0.02 m ahead of the tag");
}

TEST_CASE("A run that stops short goes on in the direction of its last centimetres") {
  // Along the diagonal to (0.6, 0.6); a robot that stood still and jittered at its end.
  const auto diagonal = [](double length_m) {
    return test::Moved(test::StraightPath(length_m, 101), {0.0, 0.0, std::atan2(1.0, 1.0)});
  };
  const Goal goal{{0.6, 0.6}, 0.06};
  const Trajectory whole = diagonal(0.6 * std::sqrt(2.0));
  Trajectory shorter = diagonal(0.6 * std::sqrt(2.0) - 0.05);
  CHECK(Gap(shorter, whole, {}) == Approx(0.05));
  CHECK(WayGap_m(shorter, whole, goal, {}) == Approx(0.0).margin(1e-9));
  const Goal narrow{{0.6, 0.6}, 0.049};
  CHECK(WayGap_m(shorter, whole, narrow, {}) == Approx(0.05));
  shorter.poses.push_back(shorter.poses.back());
  shorter.poses.back().x_m += 0.002;  // a jump to the right is no direction
  CHECK(WayGap_m(shorter, whole, goal, {}) < 0.004);
}

}  // namespace
}  // namespace rift::gap
