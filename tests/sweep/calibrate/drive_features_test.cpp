#include "rift/sweep/calibrate/drive_features.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <string_view>

#include "rift/statistics/random.hpp"
#include "rift/sweep/calibrate/distinction.hpp"
#include "support/drive_feature.hpp"
#include "support/inputs/paths.hpp"
#include "support/inputs/trials.hpp"

namespace rift::sweep {
namespace {

using test::Feature;
using trajectory::Trajectory;

/// A way along x, heading along the path, at 20 Hz: half a second at rest, then 0.3 m/s.
Trajectory Drive(const std::function<double(double)>& lateral_m, double wait_s = 0.5) {
  Trajectory log;
  const auto at = [&](double t_s) {
    const double x_m = 0.3 * std::max(0.0, t_s - wait_s);
    return Eigen::Vector2d(x_m, lateral_m(x_m));
  };
  for (double t_s = 0.0; t_s < wait_s + 2.0; t_s += 0.05) {
    const Eigen::Vector2d p = at(t_s);
    const double slope = (lateral_m(p.x() + 1e-4) - lateral_m(p.x() - 1e-4)) / 2e-4;
    log.poses.push_back({.t_s = 3.0 + t_s,
                         .x_m = p.x(),
                         .y_m = p.y(),
                         .yaw_rad = std::atan(slope),
                         .target_x_m = p.x() < 0.3 ? 0.3 : 0.6,
                         .target_y_m = 0.0});
  }
  return log;
}

double Straight(double) { return 0.0; }
double Weaving(double x_m) { return 0.01 * std::sin(2.0 * std::numbers::pi * x_m / 0.15); }

TEST_CASE("Every feature of a drive has a name of its own and a meaning") {
  std::set<std::string_view> names;
  for (const DriveFeature& feature : DriveFeatures()) {
    names.insert(feature.name);
    CHECK_FALSE(feature.meaning.empty());
  }
  CHECK(names.size() == DriveFeatures().size());
  CHECK(FeaturesOf(Drive(Straight), {}).size() == names.size());
}

TEST_CASE("A straight drive at one speed has the features it was made with") {
  const Trajectory log = Drive(Straight);
  CHECK(Feature(log, "interval_median_s") == Approx(0.05));
  CHECK(Feature(log, "interval_sd_s") == Approx(0.0).margin(1e-9));
  CHECK(Feature(log, "interval_near_67ms") == 0.0);
  CHECK(Feature(log, "rows_per_s") == Approx(20.0));
  CHECK(Feature(log, "cruise_mps") == Approx(0.3));
  CHECK(Feature(log, "first_motion_s") == Approx(0.55).margin(0.051));
  CHECK(Feature(log, "length_ratio") == Approx(1.0).margin(0.05));
  CHECK(Feature(log, "speed_after_stop") == Approx(1.0));
  CHECK(Feature(log, "yaw_rate_sd_rad_s") == Approx(0.0).margin(1e-9));
  CHECK(Feature(log, "weave_m") == Approx(0.0).margin(1e-9));
  CHECK(Feature(log, "rest_jitter_m") == 0.0);
  CHECK(Feature(log, "miss_m") < 0.02);
}

TEST_CASE("A weave shows in the yaw rate with its amplitude and its period") {
  const Trajectory log = Drive(Weaving);  // 0.15 m at 0.3 m/s: two periods a second
  CHECK(Feature(log, "reversals_per_s") == Approx(4.0).margin(0.8));
  CHECK(Feature(log, "weave_m") == Approx(0.01 / std::sqrt(2.0)).epsilon(0.1));
  CHECK(Feature(log, "yaw_rate_correlation_200ms") < -0.4);
  CHECK(Feature(log, "yaw_rate_correlation_400ms") > 0.1);
  CHECK(Feature(log, "yaw_residual_rad") > Feature(Drive(Straight), "yaw_residual_rad"));
}

TEST_CASE("A stop at a waypoint and a turn at the start show") {
  Trajectory log = Drive(Straight);
  double waited_s = 0.0;
  bool has_stopped = false;
  for (auto& pose : log.poses) {
    if (pose.x_m > 0.35 && !has_stopped) waited_s = 0.4, has_stopped = true;
    pose.t_s += waited_s;
  }
  CHECK(Feature(log, "speed_after_stop") < 0.2);
  CHECK(Feature(log, "slow_after_stop_s") > 0.3);
  Trajectory turned = Drive(Straight);
  for (auto& pose : turned.poses) pose.yaw_rad += pose.x_m > 0.02 ? 0.2 : 0.0;
  CHECK(Feature(turned, "start_turn_rad") == Approx(0.2));
}

TEST_CASE("Frames of a camera that are stamped evenly show in the way from row to row") {
  Trajectory log = Drive(Straight);
  for (auto& pose : log.poses) {
    const double captured_s = std::floor((pose.t_s - 0.004) * 30.0) / 30.0;
    pose.x_m = 0.3 * std::max(0.0, captured_s - 3.5);
  }
  CHECK(Feature(log, "step_grid") > 0.3);
  CHECK(Feature(Drive(Straight), "step_grid") < 0.1);
  CHECK(Feature(log, "speed_roughness") > 0.3);
  CHECK(Feature(Drive(Straight), "speed_roughness") < 0.2);
}

TEST_CASE("No feature depends on the frame or on the clock") {
  Trajectory log = Drive(Weaving);
  for (size_t i = 0; i < log.poses.size(); ++i)
    log.poses[i].t_s += 0.004 * std::sin(1.7 * static_cast<double>(i));
  Trajectory moved = test::Moved(log, {0.7, -0.3, 2.0});
  const double cosine = std::cos(2.0), sine = std::sin(2.0);
  for (auto& pose : moved.poses) {
    const double x_m = pose.target_x_m, y_m = pose.target_y_m;
    pose.target_x_m = 0.7 + cosine * x_m - sine * y_m;
    pose.target_y_m = -0.3 + sine * x_m + cosine * y_m;
    pose.t_s += 64.0;
  }
  const std::vector<double> before = FeaturesOf(log, {}), after = FeaturesOf(moved, {});
  for (size_t i = 0; i < before.size(); ++i) {
    INFO(DriveFeatures()[i].name << ": " << before[i] << " and " << after[i]);
    const bool is_same =
        std::isnan(before[i]) ? std::isnan(after[i]) : std::abs(after[i] - before[i]) < 1e-6;
    CHECK(is_same);
  }
}

TEST_CASE("A log without yaw or targets or motion has the other features") {
  Trajectory log = Drive(Straight);
  for (auto& pose : log.poses) pose.yaw_rad = pose.target_x_m = pose.target_y_m = NAN;
  CHECK(std::isnan(Feature(log, "yaw_residual_rad")));
  CHECK(std::isnan(Feature(log, "miss_m")));
  CHECK(Feature(log, "cruise_mps") == Approx(0.3));
  log.poses.resize(5);
  CHECK(std::isnan(Feature(log, "interval_median_s")));
  Trajectory brief = Drive(Straight, 0.1);
  brief.poses.resize(8);
  CHECK(Feature(brief, "interval_median_s") == Approx(0.05));
  brief.poses.resize(7);
  CHECK(std::isnan(Feature(brief, "interval_median_s")));
  Trajectory still = Drive([](double) { return 0.0; }, 2.0);
  still.poses.resize(30);
  still.poses.back().x_m = 0.001;
  CHECK(std::isnan(Feature(still, "first_motion_s")));
}

TEST_CASE("Five rows from the first motion on are a drive") {
  const Trajectory whole = Drive(Straight);
  const auto first = static_cast<size_t>(std::lround(Feature(whole, "first_motion_s") / 0.05));
  Trajectory log = whole;
  log.poses.resize(first + 5);
  CHECK(Feature(log, "first_motion_s") == Approx(0.05 * static_cast<double>(first)));
  CHECK(Feature(log, "drive_s") == Approx(0.2));
  log.poses.resize(first + 4);
  CHECK(std::isnan(Feature(log, "first_motion_s")));
}

/// Drives of one setting whose weave is drawn, `speedup` times as fast.
std::vector<Trajectory> Drives(int count, double speedup, statistics::Random& random) {
  std::vector<Trajectory> logs;
  for (int i = 0; i < count; ++i) {
    const double amplitude_m = 0.01 + 0.003 * random.Normal(), phase = random.Uniform();
    Trajectory log = Drive([&](double x_m) {
      return amplitude_m * std::sin(2.0 * std::numbers::pi * (x_m / 0.2 + phase));
    });
    const double scale = speedup * (1.0 + 0.02 * random.Normal());
    for (auto& pose : log.poses) {
      pose.x_m = scale * pose.x_m + 3e-4 * random.Normal();
      pose.y_m += 3e-4 * random.Normal();
      pose.yaw_rad += 0.01 * random.Normal();
    }
    logs.push_back(log);
  }
  return logs;
}

Distinction DistinguishDrives(double speedup) {
  statistics::Random random(11, 1);
  std::vector<RepeatedTrial> trials;
  for (int i = 0; i < 24; ++i) {
    const std::string setting(1, static_cast<char>('a' + i / 2));
    trials.push_back({.setting = setting,
                      .real = Drives(1, 1.0, random).front(),
                      .runs = Drives(4, speedup, random)});
  }
  return Distinguish(trials, {.classifier = {.permutations = 39}}, 1);
}

TEST_CASE("Simulated logs made as the real ones are not told from them") {
  const Distinction same = DistinguishDrives(1.0);
  CHECK(same.all.first == 24);
  CHECK(same.all.second == 96);
  CHECK(same.all.groups == 12);
  INFO("accuracy " << same.all.accuracy);
  CHECK(same.all.accuracy_interval.low <= 0.5);
  CHECK(same.all.accuracy_interval.high >= 0.5);
  CHECK(same.all.p > 0.05);
}

TEST_CASE("A simulator that is too fast is told by its speed") {
  const Distinction fast = DistinguishDrives(1.1);
  CHECK(fast.all.accuracy > 0.9);
  CHECK(fast.all.p == Approx(1.0 / 40.0));
  CHECK(fast.without_timing.features[0].accuracy > 0.9);
  const auto of_speed = std::find_if(
      fast.all.features.begin(), fast.all.features.end(),
      [](const auto& one) { return one.feature == test::PlaceOfFeature("cruise_mps"); });
  CHECK(of_speed->accuracy > 0.9);
  CHECK(of_speed->accuracy_interval.low > 0.8);
  CHECK(of_speed->weight < 0.0);
  const FeatureSummary& cruise = fast.features[test::PlaceOfFeature("cruise_mps")];
  CHECK(cruise.mean.Ratio() == Approx(1.1).margin(0.02));
  for (const statistics::FeatureEvidence& evidence : fast.without_timing.features) {
    CHECK_FALSE(DriveFeatures()[evidence.feature].is_timing);
  }
}

TEST_CASE(
    "Settings that have a log or a run in common are tried together, and trained on neither") {
  // Three surfaces of two logs each, under two simulators of which no log knows.
  const auto distinguish = [](bool names_simulators) {
    statistics::Random random(12, 1);
    std::vector<RepeatedTrial> trials;
    for (const std::string surface : {"a", "b", "c"}) {
      const std::vector<Trajectory> reals = Drives(2, 1.0, random);
      for (const std::string simulator : {"1", "2"}) {
        for (const Trajectory& real : reals) {
          trials.push_back({.setting = names_simulators ? surface + simulator : surface,
                            .real = real,
                            .runs = Drives(1, 1.0, random)});
        }
      }
    }
    return Distinguish(trials, {.classifier = {.permutations = 9}}, 1);
  };
  const Distinction surfaces = distinguish(false), simulators = distinguish(true);
  REQUIRE(surfaces.all.groups == 3);
  CHECK(simulators.all.groups == 3);
  CHECK(simulators.without_timing.groups == 3);
  CHECK(simulators.all.first == 6);  // each of which stands under both simulators
  CHECK(simulators.all.second == 12);
  CHECK(simulators.all.accuracy == surfaces.all.accuracy);
  CHECK(simulators.all.accuracy_interval.low == surfaces.all.accuracy_interval.low);
  CHECK(simulators.all.p == surfaces.all.p);
  CHECK(simulators.without_timing.accuracy == surfaces.without_timing.accuracy);

  // One simulated log beside the logs of two settings.
  statistics::Random random(13, 1);
  const std::vector<Trajectory> reals = Drives(5, 1.0, random), runs = Drives(3, 1.0, random);
  std::vector<RepeatedTrial> trials;
  for (const size_t i : {0, 1, 2, 3, 4}) {
    trials.push_back({.setting = std::to_string(i), .real = reals[i], .runs = {runs[i / 2]}});
  }
  const Distinction shared = Distinguish(trials, {.classifier = {.permutations = 1}}, 1);
  CHECK(shared.all.groups == 3);
  CHECK(shared.all.first == 5);
  CHECK(shared.all.second == 3);
}

TEST_CASE("A path counts once on its side, and differs by its times, by its x or by its y") {
  const Trajectory path = Drive(Weaving);
  const auto changed = [&path](const std::function<void(trajectory::StampedPose&)>& change) {
    Trajectory other = path;
    for (auto& pose : other.poses) change(pose);
    return other;
  };
  std::vector<RepeatedTrial> trials;
  for (const std::string setting : {"a", "b"}) {
    trials.push_back({.setting = setting, .real = path, .runs = {path, path}});
  }
  trials[1].real = changed([](auto& pose) { pose.t_s += 1.0; });
  trials[1].runs = {changed([](auto& pose) { pose.x_m *= 1.1; }),
                    changed([](auto& pose) { pose.y_m = -pose.y_m; }),
                    changed([](auto& pose) { pose.t_s *= 1.1; }),
                    changed([](auto& pose) { pose.y_m = -pose.y_m; })};
  const Distinction found = Distinguish(trials, {.classifier = {.permutations = 1}}, 1);
  CHECK(found.all.first == 2);
  CHECK(found.all.second == 4);  // one of the first trial, three of the second
  CHECK(found.all.groups == 2);
}

TEST_CASE("The authors' Webots logs are told from their robot's in settings not seen") {
  RIFT_SKIP_WITHOUT_TRIALS();
  std::vector<RepeatedTrial> trials;
  for (const test::TrialPair& pair : test::PublishedPairs()) {
    const std::string setting = pair.surface + pair.v_min + pair.v_max;
    const bool is_new = std::none_of(trials.begin(), trials.end(),
                                     [&](const auto& trial) { return trial.setting == setting; });
    trials.push_back({.setting = setting,
                      .real = test::LoadTrajectory(pair.real, trajectory::Format::kTracker)});
    // One run for each setting.
    if (is_new) {
      trials.back().runs = {test::LoadTrajectory(pair.webots, trajectory::Format::kWebots)};
    }
  }
  const Distinction told = Distinguish(trials, {.classifier = {.permutations = 19}}, 1);
  CHECK(told.all.first == 48);
  CHECK(told.all.second == 24);
  CHECK(told.all.accuracy >= 0.95);
  CHECK(told.without_timing.accuracy >= 0.95);
  CHECK(told.all.p == Approx(0.05));
}

TEST_CASE("Features are told with the lengths, times and frames that they are made with") {
  const std::map<std::string_view, std::string_view> meanings{
      {"interval_near_33ms", "share of these within 5 ms of one frame of a 30 fps camera"},
      {"interval_near_67ms", "share within 5 ms of two frames"},
      {"interval_bimodality", "Sarle's coefficient: 0.33 normal, 0.56 even, 1 two values"},
      {"step_grid",
       "mean cosine of the way from row to row in frames of 1/30 s at cruising speed: 1 on a grid, "
       "0 without one"},
      {"start_turn_rad", "turn to the left until 50 mm from the start"},
      {"speed_after_stop", "lowest speed within 0.6 s after a waypoint, over cruise"},
      {"slow_after_stop_s", "time below 0.6 of cruise within 0.8 s after a waypoint"},
      {"yaw_rate_sd_rad_s", "standard deviation of the yaw rate over 50 ms"},
      {"yaw_rate_correlation_100ms", "autocorrelation of the yaw rate 100 ms apart"},
      {"yaw_rate_correlation_200ms", "200 ms apart"},
      {"yaw_rate_correlation_400ms", "400 ms apart"},
      {"yaw_rate_correlation_800ms", "800 ms apart"},
      {"reversals_per_s", "changes of side of a yaw rate above 0.2 rad/s"},
      {"side_m", "mean distance left of that line"},
      {"length_ratio", "length by strides of 20 mm over the distance from start to end"}};
  size_t told = 0;
  for (const DriveFeature& feature : DriveFeatures()) {
    const auto found = meanings.find(feature.name);
    if (found == meanings.end()) continue;
    ++told;
    CHECK(feature.meaning == found->second);
  }
  CHECK(told == meanings.size());
}

}  // namespace
}  // namespace rift::sweep
