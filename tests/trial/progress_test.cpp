#include "trial/progress.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <utility>

#include "rift/control/navigator.hpp"

namespace rift::trial {
namespace {

using trajectory::StampedPose;

const std::vector<control::Waypoint> kTask{
    {"start", 0.0, 0.0}, {"corner", 0.4, 0.0}, {"middle", 0.4, 0.3}, {"end", 0.0, 0.3}};

/// `count` poses, a tenth of a second apart, driven to the waypoint of that index.
template <class PoseAt>
TrialResult RunOf(int count, std::size_t target, const PoseAt& pose_at) {
  TrialResult result;
  for (int i = 0; i < count; ++i) {
    StampedPose pose = pose_at(0.1 * i);
    pose.t_s = 0.1 * i;
    if (std::isnan(pose.yaw_rad)) pose.yaw_rad = 0.0;
    pose.target_x_m = kTask[target].x_m;
    pose.target_y_m = kTask[target].y_m;
    result.trajectory.poses.push_back(pose);
  }
  return result;
}

TEST_CASE("The way of a run is measured by strides of a fifth of a second, to its very end") {
  // Noise of 1 mm from pose to pose hardly lengthens it.
  const TrialResult run = RunOf(42, 1, [](double t_s) {
    return StampedPose{.x_m = 0.1 * t_s, .y_m = std::lround(10.0 * t_s) % 2 == 0 ? 0.0 : 0.001};
  });
  CHECK(Way_m(run.trajectory) == Approx(0.41).margin(0.0002));
  CHECK(Length_m(kTask) == Approx(1.1));
}

TEST_CASE("A way to and fro is seen where each way takes a stride") {
  TrialResult run;
  for (int i = 0; i <= 32; ++i) {  // a quarter of a second out, and as much back
    run.trajectory.poses.push_back({.t_s = 0.125 * i, .x_m = 0.01 * (2 - std::abs(i % 4 - 2))});
  }
  CHECK(Way_m(run.trajectory) == Approx(16 * 0.02));
}

TEST_CASE("What is left of a task is the way to the target and from there on") {
  // Half of the second leg is left, then the third.
  const TrialResult run =
      RunOf(31, 2, [](double t_s) { return StampedPose{.x_m = 0.4, .y_m = 0.05 * t_s}; });
  const Progress progress = ProgressOf(run, kTask);
  CHECK(progress.took_s == Approx(3.0));
  CHECK(progress.left_m == Approx(0.15 + 0.4));
  CHECK(progress.last_s == Approx(1.0));
  CHECK(progress.nearing_mps == Approx(0.05));
  CHECK(progress.IsNearing());
  CHECK(progress.moved_m == Approx(0.9 * 0.05).margin(0.002));
  CHECK_FALSE(progress.IsStanding());
}

TEST_CASE("A run nears its end by the slower of its whole and of its last third") {
  const TrialResult braked = RunOf(31, 1, [](double t_s) {
    return StampedPose{.x_m = 0.1 * std::min(t_s, 2.0) + 0.004 * std::max(0.0, t_s - 2.0)};
  });
  CHECK(ProgressOf(braked, kTask).nearing_mps == Approx(0.004));
  CHECK_FALSE(ProgressOf(braked, kTask).IsNearing());
  const TrialResult late =
      RunOf(31, 1, [](double t_s) { return StampedPose{.x_m = 0.03 * std::max(0.0, t_s - 2.0)}; });
  CHECK(ProgressOf(late, kTask).nearing_mps == Approx(0.01));
  CHECK(ProgressOf(late, kTask).IsNearing());
  for (const auto& [speed_mps, is_nearing] : {std::pair(0.0055, true), {0.0045, false}}) {
    const TrialResult even =
        RunOf(31, 1, [v = speed_mps](double t_s) { return StampedPose{.x_m = v * t_s}; });
    CHECK(ProgressOf(even, kTask).IsNearing() == is_nearing);
  }
}

TEST_CASE("A robot stands that neither moves by two centimetres nor turns by a fifth of a radian") {
  const auto is_standing = [](double x_m, double y_m, double yaw_rad) {
    // All of it in the last third, back and forth so that nine tenths of it are seen.
    return ProgressOf(RunOf(61, 1,
                            [&](double t_s) {
                              const double side = std::lround(10.0 * t_s) % 2 == 0 ? 0.0 : 1.0;
                              return StampedPose{.x_m = side * x_m,
                                                 .y_m = side * y_m,
                                                 .yaw_rad = 3.1 + side * yaw_rad};
                            }),
                      kTask)
        .IsStanding();
  };
  CHECK(is_standing(0.019, 0.0, 0.0));
  CHECK_FALSE(is_standing(0.021, 0.0, 0.0));
  CHECK(is_standing(0.0, -0.019, 0.0));
  CHECK_FALSE(is_standing(0.0, -0.021, 0.0));
  CHECK_FALSE(is_standing(0.015, 0.015, 0.0));
  CHECK(is_standing(0.0, 0.0, 0.19));  // across the wrap at pi
  CHECK_FALSE(is_standing(0.0, 0.0, 0.21));
}

TEST_CASE("In less than half a second a robot that stands moves by as much less") {
  // Runs whose last third is so long, at a speed that makes 2 cm in half a second.
  const auto is_standing = [](double last_s, double speed_mps) {
    TrialResult run = RunOf(301, 1, [](double) { return StampedPose{}; });
    for (size_t i = 0; i < run.trajectory.poses.size(); ++i) {
      run.trajectory.poses[i].t_s = 3.0 * last_s * static_cast<double>(i) / 300.0;
      run.trajectory.poses[i].x_m = speed_mps * run.trajectory.poses[i].t_s;
    }
    return ProgressOf(run, kTask).IsStanding();
  };
  CHECK(is_standing(0.1, 0.04));
  CHECK_FALSE(is_standing(0.1, 0.05));  // nine tenths of the way are seen
  CHECK(is_standing(0.45, 0.04));
  CHECK_FALSE(is_standing(0.45, 0.05));
  CHECK(is_standing(1.0, 0.02));
  CHECK_FALSE(is_standing(1.0, 0.025));
}

TEST_CASE("A run is the same whatever its clock begins with, and may have two poses") {
  TrialResult run = RunOf(31, 1, [](double t_s) { return StampedPose{.x_m = 0.1 * t_s}; });
  for (StampedPose& pose : run.trajectory.poses) pose.t_s += 50.0;
  const Progress progress = ProgressOf(run, kTask);
  CHECK(progress.took_s == Approx(3.0));
  CHECK(progress.last_s == Approx(1.0));
  CHECK(progress.nearing_mps == Approx(0.1));

  run.trajectory.poses = {run.trajectory.poses.front(), run.trajectory.poses.back()};
  const Progress of_two = ProgressOf(run, kTask);
  CHECK(of_two.last_s == Approx(3.0));
  CHECK(of_two.nearing_mps == Approx(0.1));
}

TEST_CASE("A run of two poses at one time has no speed") {
  TrialResult run = RunOf(2, 1, [](double) { return StampedPose{}; });
  run.trajectory.poses[1].t_s = 0.0;
  CHECK(ProgressOf(run, kTask).nearing_mps == 0.0);
}

}  // namespace
}  // namespace rift::trial
