// Poses against wheels, without a clock, a line or noise: what each contradiction is called.

#include "hardware/motion_check.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

constexpr double kTrack_m = 0.09;

/// What happens to the poses and the wheels of a robot that weaves slowly.
struct Weave {
  double late_s = 0.0;        ///< of the poses
  double pose_stands_s = 99;  ///< from here on
  double wheels_stand_s = 99;
  std::vector<int> together{};  ///< pictures that come in one piece, by age in periods; one a piece
  bool is_first = true;         ///< weaves to this side first
};

/// Why it is stopped within eight seconds; none.
std::optional<StopReason> Stopped(const Weave& weave, double known_latency_s = 0.0) {
  MotionCheck check({}, kTrack_m);
  check.SetLatency(known_latency_s);
  std::vector<geometry::Pose2> poses;
  std::vector<WheelTravel> wheels;
  geometry::Pose2 pose;
  WheelTravel travel;
  constexpr double kStep_s = 0.001;
  for (int i = 0; i < 8000; ++i) {
    const double t_s = kStep_s * i;
    poses.push_back(pose);
    wheels.push_back(travel);
    const double v_mps = 0.08 + 0.05 * std::sin(1.7 * t_s);
    const double w_rad_s = (weave.is_first ? 1.0 : -1.0) * 1.6 * std::sin(3.1 * t_s);
    pose.x_m += kStep_s * v_mps * std::cos(pose.yaw_rad);
    pose.y_m += kStep_s * v_mps * std::sin(pose.yaw_rad);
    pose.yaw_rad += kStep_s * w_rad_s;
    travel.t_s = t_s + kStep_s;
    travel.left_m += kStep_s * (v_mps - 0.5 * kTrack_m * w_rad_s);
    travel.right_m += kStep_s * (v_mps + 0.5 * kTrack_m * w_rad_s);
    if (i % 20 == 0) {
      const int from = std::min(i, static_cast<int>(weave.wheels_stand_s / kStep_s));
      check.SeeWheels({t_s, wheels[from].left_m, wheels[from].right_m}, true);
    }
    const int pieces = static_cast<int>(weave.together.size());
    if (pieces > 0 && i % (33 * pieces) == 0 && t_s > 1.0) {
      for (int k = 0; k < pieces; ++k) {
        const int seen = i - 33 * weave.together[k];
        check.SeePose({t_s + 5e-4 * k, poses[seen], 0.0, 0.0, 0.0});
      }
    } else if (pieces == 0 && i % 33 == 0 && t_s > 1.0) {
      const double seen_s = std::min(t_s - weave.late_s, weave.pose_stands_s);
      check.SeePose({t_s, poses[static_cast<size_t>(seen_s / kStep_s)], 0.0, 0.0, 0.0});
    }
    if (const std::optional<Disagreement> found = check.Check()) return found->reason;
  }
  return std::nullopt;
}

TEST_CASE("Poses that agree with the wheels, or are late as known, stop nothing") {
  test::OnBothSides("left first", "right first", [](const test::Side& side) {
    CHECK_FALSE(Stopped({.is_first = side.IsFirst()}));
    CHECK_FALSE(Stopped({.late_s = 0.2, .is_first = side.IsFirst()}, 0.2));
  });
}

TEST_CASE("Poses that lag the wheels, stand or go on alone are told apart") {
  test::OnBothSides("left first", "right first", [](const test::Side& side) {
    CHECK(Stopped({.late_s = 0.4, .is_first = side.IsFirst()}) == StopReason::kPoseLags);
    CHECK(Stopped({.pose_stands_s = 3.0, .is_first = side.IsFirst()}) == StopReason::kPoseStands);
    CHECK(Stopped({.wheels_stand_s = 3.0, .is_first = side.IsFirst()}) == StopReason::kWheelsStand);
  });
}

TEST_CASE("Pictures that come together stop a drive when they are out of order, and only then") {
  test::OnBothSides("left first", "right first", [](const test::Side& side) {
    for (const std::vector<int>& in_order : {std::vector<int>{1, 0}, {3, 2, 1, 0}}) {
      CHECK_FALSE(Stopped({.together = in_order, .is_first = side.IsFirst()}));
    }
    for (const std::vector<int>& mixed : {std::vector<int>{0, 1}, {1, 3, 0, 2}, {0, 2, 1}}) {
      CHECK(Stopped({.together = mixed, .is_first = side.IsFirst()}) == StopReason::kPoseDisorder);
    }
  });
}

TEST_CASE("A reading of the wheels that comes after a newer one is passed over") {
  MotionCheck check({}, kTrack_m);
  check.SetLatency(0.0);
  for (int i = 0; i < 100; ++i) {
    const double t_s = 0.02 * i;
    check.SeeWheels({t_s, 0.0, 0.0}, true);
    check.SeeWheels({t_s - 0.03, 5.0, 5.0}, true);
    check.SeeWheels({t_s, 5.0, 5.0}, true);
    check.SeePose({t_s - 0.01, {}, 0.0, 0.0, 0.0});
    CHECK_FALSE(check.Check());
  }
}

TEST_CASE("Wheels that are counted are not held against those that were taken to obey before") {
  for (const bool is_measured : {false, true}) {
    MotionCheck check({}, kTrack_m);
    check.SetLatency(0.0);
    for (int i = 0; i < 200; ++i) {
      const double t_s = 0.02 * i, way_m = 0.1 * t_s;
      const bool is_other = i >= 100;
      const double rolled_m = is_other ? way_m + 7.0 : way_m;
      check.SeeWheels({t_s, rolled_m, rolled_m}, is_other ? is_measured : !is_measured);
      check.SeePose({t_s, {way_m, 0.0, 0.0}, 0.0, 0.0, 0.0});
      const auto found = check.Check();
      INFO(t_s << ": " << (found ? found->text : ""));
      CHECK_FALSE(found);
    }
  }
}

/// Why a robot on a stand is stopped, whose wheels turn under a camera that sees it stand; none.
std::optional<StopReason> StoppedOnAStand(const EvidenceOptions& options) {
  constexpr double kStep_s = 0.02, kWheels_mps = 0.3, kTurns_s = 20.0;
  MotionCheck check(options, kTrack_m);
  for (int i = 0; i * kStep_s < kTurns_s; ++i) {
    const double t_s = kStep_s * i, rolled_m = std::max(0.0, kWheels_mps * (t_s - 1.0));
    check.SeeWheels({t_s, rolled_m, rolled_m}, true);
    if (i % 2 == 0) check.SeePose({t_s, {2e-4 * (i % 4), 0.0, 0.0}, 0.0, 0.0, 0.0});
    if (const std::optional<Disagreement> found = check.Check()) return found->reason;
  }
  return std::nullopt;
}

// docs/recipes.md, "Before the first drive": wheels up.
TEST_CASE("A robot on a stand turns its wheels with the evidence of docs, and with no less") {
  const EvidenceOptions of_docs{
      .blind_m = 10.0, .repeats_s = 3600.0, .agree_m = 10.0, .max_latency_s = 2.0};
  CHECK_FALSE(StoppedOnAStand(of_docs));
  EvidenceOptions less = of_docs;
  less.blind_m = EvidenceOptions{}.blind_m;
  CHECK(StoppedOnAStand(less) == StopReason::kPoseStands);
  less = of_docs;
  less.agree_m = EvidenceOptions{}.agree_m;
  CHECK(StoppedOnAStand(less) == StopReason::kPoseDisagrees);
  less = of_docs;
  less.max_latency_s = EvidenceOptions{}.max_latency_s;
  CHECK(StoppedOnAStand(less) == StopReason::kPoseLags);
}

}  // namespace
}  // namespace rift::hardware
