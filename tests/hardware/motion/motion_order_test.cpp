// Pictures that come out of order while the wheels roll, by as much as is too much and by less.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <optional>
#include <set>

#include "motion.hpp"

namespace rift::hardware {
namespace {

using geometry::Pose2;

constexpr StopReason kNone = StopReason::kFinished;

/// Straight on, but for pictures that show the robot so much further back than the one before.
Found WithSteps(double mps, const std::vector<double>& times_s, const std::set<int>& steps,
                double against_m) {
  Motion motion{.times_s = times_s};
  motion.wheels_m = [=](double t_s) { return std::pair(mps * t_s, mps * t_s); };
  motion.pose = [=](double t_s) {
    const auto at = std::lower_bound(times_s.begin(), times_s.end(), t_s - 1e-9);
    const auto i = static_cast<int>(at - times_s.begin());
    if (steps.count(i) == 0) return Pose2{mps * t_s, 0.0, 0.0};
    return Pose2{mps * times_s[i - 1] - std::copysign(against_m, mps), 0.0, 0.0};
  };
  return StopOf(motion);
}

TEST_CASE(
    "One picture from far back, or some from near back, are out of order, and fewer are not") {
  const std::vector<double> times_s = Every(0.04);
  for (const double sign : {1.0, -1.0}) {
    const auto reason = [&](double mps, const std::set<int>& steps, double against_m) {
      return WithSteps(sign * mps, times_s, steps, against_m).reason;
    };
    // 0.125 m/s is 5 mm a picture: one may be 15 + 5 mm back.
    CHECK(reason(0.125, {30}, 0.0199) == kNone);
    CHECK(reason(0.125, {30}, 0.0201) == StopReason::kPoseDisorder);
    CHECK(reason(0.25, {30}, 0.0249) == kNone);
    CHECK(reason(0.25, {30}, 0.0251) == StopReason::kPoseDisorder);
    // As far back as it went counts twice; three within 0.7 s are too many.
    CHECK(reason(0.125, {30, 47}, 0.0051) == StopReason::kPoseDisorder);
    CHECK(reason(0.125, {30, 48}, 0.0051) == kNone);
    CHECK(reason(0.125, {30, 40}, 0.0049) == kNone);
    CHECK(reason(0.125, {30, 38, 47}, 0.0049) == StopReason::kPoseDisorder);
    CHECK(reason(0.125, {30, 38, 48}, 0.0049) == kNone);
    // Of wheels that roll less, 3.75 mm counts twice.
    CHECK(reason(0.05, {30, 40}, 0.0037) == kNone);
    CHECK(reason(0.05, {30, 40}, 0.0038) == StopReason::kPoseDisorder);
    // Less than half of what the wheels rolled, or than 2.5 mm, is jitter.
    CHECK(reason(0.125, {30, 34, 38, 42}, 0.0024) == kNone);
    CHECK(reason(0.125, {30, 34, 38}, 0.0026) == StopReason::kPoseDisorder);
    CHECK(reason(0.25, {30, 34, 38, 42}, 0.0049) == kNone);
    CHECK(reason(0.25, {30, 34, 38}, 0.0051) == StopReason::kPoseDisorder);
    // Wheels that roll half a millimetre between pictures hardly roll.
    CHECK(reason(0.012, {30}, 0.0156) == kNone);
    CHECK(reason(0.015, {30}, 0.0157) == StopReason::kPoseDisorder);
    CHECK(reason(0.015, {30}, 0.0155) == kNone);
  }
  CHECK(WithSteps(0.125, times_s, {30}, 0.0234).text ==
        "the pose ran 0.023 m against the wheels from one picture to the next: the camera's "
        "pictures come out of order");
  CHECK(WithSteps(-0.125, times_s, {30, 38, 47}, 0.0049).text ==
        "the pose ran against the wheels again and again within 0.7 s: the camera's pictures come "
        "out of order");
}

TEST_CASE("Of pictures that come together one may be 5 mm back while the robot drives") {
  for (const double sign : {1.0, -1.0}) {
    const auto reason = [&](double mps, double together_s, double against_m) {
      std::vector<double> times_s = Every(0.04);
      times_s.insert(times_s.begin() + 31, times_s[30] + together_s);
      return WithSteps(sign * mps, times_s, {31}, against_m).reason;
    };
    CHECK(reason(0.125, 0.001, 0.0049) == kNone);
    CHECK(reason(0.125, 0.001, 0.0051) == StopReason::kPoseDisorder);
    CHECK(reason(0.125, 0.0099, 0.0051) == StopReason::kPoseDisorder);
    CHECK(reason(0.125, 0.0101, 0.0051) == kNone);  // not together
    // Below 0.05 m/s over the last tenth of a second it hardly drives.
    CHECK(reason(0.049, 0.001, 0.0051) == kNone);
    CHECK(reason(0.051, 0.001, 0.0051) == StopReason::kPoseDisorder);
  }
}

TEST_CASE("After a restart nothing is held against what was seen before it") {
  // Straight on at 0.125 m/s, carried aside and its counters reset at 2 s, after two pictures from
  // near back and before one.
  for (const bool restarts : {true, false}) {
    MotionCheck check({}, kTrack_m);
    check.SetLatency(0.0);
    std::optional<Disagreement> found;
    for (int i = 0; i < 100 && !found; ++i) {
      const double t_s = 0.04 * i, way_m = 0.125 * t_s;
      if (i == 50 && restarts) check.Restart();
      const bool is_carried = i >= 50;
      const double rolled_m = is_carried ? way_m - 0.25 : way_m;
      const double back_m = i == 44 || i == 47 || i == 53 ? 0.005 + 0.0049 : 0.0;
      check.SeeWheels({t_s, rolled_m, rolled_m}, true);
      check.SeePose({t_s, {way_m - back_m, is_carried ? 1.0 : 0.0, 0.0}, 0.0, 0.0, 0.0});
      found = check.Check();
    }
    INFO((found ? found->text : ""));
    CHECK(found.has_value() == !restarts);
  }
}

}  // namespace
}  // namespace rift::hardware
