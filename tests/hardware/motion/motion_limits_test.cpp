// Each limit of pose against wheels on both sides: motions in closed form, and when or whether they
// are stopped.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "motion.hpp"
#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using geometry::Pose2;

constexpr StopReason kNone = StopReason::kFinished;

/// A wheel that rolls at `mps` from 1 s on.
double Rolled_m(double t_s, double mps) { return mps * std::max(0.0, t_s - 1.0); }

constexpr double kFine_s = 0.005;

TEST_CASE("Wheels that roll while the pose stands are stopped by their way and their speed") {
  // 0.012 m and what it rolls in 0.1 s; in max_latency_s as well while the latency is not known;
  // three times as much without encoders.
  struct Case {
    std::optional<double> latency_s;
    bool is_measured;
    double max_latency_s, way_m;
  };
  for (const auto& [latency_s, is_measured, max_latency_s, way_m] :
       {Case{0.0, true, 0.25, 0.032}, Case{{}, true, 0.05, 0.042}, Case{0.0, false, 0.25, 0.096},
        Case{{}, false, 0.25, 0.246}}) {
    for (const double mps : {0.2, -0.2}) {
      for (const auto& [left, right] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {0.0, 1.0}, {1.0, -1.0}}) {
        Motion motion{
            .latency_s = latency_s, .is_measured = is_measured, .times_s = Every(kFine_s)};
        motion.options.max_latency_s = max_latency_s;
        motion.wheels_m = [=, left = left, right = right](double t_s) {
          return std::pair(left * Rolled_m(t_s, mps), right * Rolled_m(t_s, mps));
        };
        const Found found = StopOf(motion);
        INFO(way_m << " " << mps << " " << left << " " << right << ": " << found.text);
        CHECK(found.reason == StopReason::kPoseStands);
        CHECK(found.t_s > 1.0 + way_m / 0.2 - 1e-6);
        CHECK(found.t_s < 1.0 + way_m / 0.2 + 0.007);
      }
    }
  }
}

TEST_CASE("The speed at which the pose was last seen to move counts when the wheels slow down") {
  // 0.3 m/s with the pose until 2 s, then 0.1 m/s without it: 0.012 m + 0.1 s x 0.3 m/s.
  Motion motion{.times_s = Every(kFine_s)};
  motion.options.still_m = 1e-4;
  const auto way_m = [](double t_s) { return t_s < 2.0 ? 0.3 * t_s : 0.6 + 0.1 * (t_s - 2.0); };
  motion.wheels_m = [&](double t_s) { return std::pair(way_m(t_s), way_m(t_s)); };
  motion.pose = [&](double t_s) { return Pose2{way_m(std::min(t_s, 2.0)), 0.0, 0.0}; };
  const Found found = StopOf(motion);
  CHECK(found.reason == StopReason::kPoseStands);
  CHECK(found.t_s == Approx(2.42).margin(0.011));
}

TEST_CASE("The speed of the wheels is that of the last tenth of a second") {
  // 0.03 m in 0.05 s, and then they stand: the way exceeds 0.012 m + 0.1 s x speed once all but
  // 0.018 m of it are older than that.
  Motion motion{.times_s = Every(0.001, 2.0)};
  motion.wheels_m = [](double t_s) {
    return std::pair(0.0, 0.6 * std::clamp(t_s - 1.0, 0.0, 0.05));
  };
  const Found found = StopOf(motion);
  CHECK(found.reason == StopReason::kPoseStands);
  CHECK(found.t_s == Approx(1.12).margin(0.0025));
}

TEST_CASE("Poses of which nothing was told of the wheels are forgotten after four seconds") {
  for (const auto& [since_s, is_forgotten] : {std::pair{5.1, true}, {4.8, false}}) {
    MotionCheck check({}, kTrack_m);
    check.SetLatency(0.0);
    std::optional<Disagreement> found;
    for (int i = 0; i < 350 && !found; ++i) {
      const double t_s = 0.02 * i;  // it is carried for a second
      check.SeePose({t_s, {0.5 * std::min(t_s, 1.0), 0.0, 0.0}, 0.0, 0.0, 0.0});
      if (t_s >= since_s) check.SeeWheels({t_s, 0.0, 0.0}, true);
      found = check.Check();
    }
    CHECK(found.has_value() == !is_forgotten);
  }
}

TEST_CASE("A pose that moves or turns by more than its jitter stands no longer") {
  const auto stopped_s = [](const Pose2& moved) {
    Motion motion{.is_measured = false, .times_s = Every(kFine_s)};
    motion.wheels_m = [](double t_s) { return std::pair(0.0, Rolled_m(t_s, 0.1)); };
    motion.pose = [&](double t_s) { return t_s < 1.6 ? Pose2{} : moved; };
    return StopOf(motion).t_s;
  };
  // 3 x (0.012 + 0.1 x 0.1) m take 0.66 s, and from 1.6 s on again where it moved.
  for (const double sign : {1.0, -1.0}) {
    CHECK(stopped_s({0.0, sign * 0.0059, 0.0}) == Approx(1.66).margin(0.007));
    CHECK(stopped_s({0.0, sign * 0.0061, 0.0}) == Approx(2.26).margin(0.007));
    CHECK(stopped_s({sign * 0.0061, 0.0, 0.0}) == Approx(2.26).margin(0.007));
    CHECK(stopped_s({0.0, 0.0, geometry::RadFromDeg(sign * 3.9)}) == Approx(1.66).margin(0.007));
    CHECK(stopped_s({0.0, 0.0, geometry::RadFromDeg(sign * 4.1)}) == Approx(2.26).margin(0.007));
  }
}

TEST_CASE("A pose that is pushed or turned while the wheels stand is stopped beyond the limits") {
  const auto stopped = [](const Pose2& pushed, bool is_measured) {
    Motion motion{.is_measured = is_measured, .times_s = Every(kFine_s, 2.0)};
    motion.pose = [&](double t_s) { return t_s < 1.0 ? Pose2{} : pushed; };
    const Found found = StopOf(motion);
    if (found.reason != StopReason::kFinished) CHECK(found.reason == StopReason::kWheelsStand);
    return found.reason == StopReason::kWheelsStand;
  };
  for (const double sign : {1.0, -1.0}) {
    for (const auto& [is_measured, m, deg] : {std::tuple{true, 0.03, 15.0}, {false, 0.09, 45.0}}) {
      for (const double beyond : {-1e-4, 1e-4}) {
        CHECK(stopped({sign * (m + beyond), 0.0, 0.0}, is_measured) == (beyond > 0.0));
        CHECK(stopped({0.0, sign * (m + beyond), 0.0}, is_measured) == (beyond > 0.0));
        CHECK(stopped({0.0, 0.0, geometry::RadFromDeg(sign * (deg + 1e3 * beyond))}, is_measured) ==
              (beyond > 0.0));
      }
    }
  }
}

TEST_CASE("Wheels stand from the budgeted latency after their last step on, whichever stepped") {
  const auto stopped = [](double left_m, double right_m, double after_s) {
    Motion motion{.times_s = Every(kFine_s, 2.0)};
    motion.wheels_m = [=](double t_s) {
      return t_s < 0.9975 ? std::pair(0.0, 0.0) : std::pair(left_m, right_m);
    };
    motion.pose = [=](double t_s) { return t_s < 1.0 + after_s ? Pose2{} : Pose2{0.0, 0.04, 0.0}; };
    return StopOf(motion).reason == StopReason::kWheelsStand;
  };
  for (const double sign : {1.0, -1.0}) {
    test::OnBothSides("left", "right", [&](const test::Side& side) {
      const auto stepped = [&](double step_m, double after_s) {
        const auto wheels = side.Of<std::pair<double, double>>(sign * step_m, 0.0);
        return stopped(wheels.first, wheels.second, after_s);
      };
      CHECK_FALSE(stepped(0.0031, 0.242));  // a pose that lags may still follow
      CHECK(stepped(0.0031, 0.262));
      CHECK(stepped(0.0029, 0.242));  // less is no step
    });
  }
}

TEST_CASE("A picture that is repeated while the wheels roll is stopped after both of its limits") {
  const auto stopped = [](double mps, bool is_measured, double late_s) {
    Motion motion{.latency_s = late_s,
                  .is_measured = is_measured,
                  .late_s = late_s,
                  .times_s = Every(kFine_s)};
    motion.wheels_m = [=](double t_s) { return std::pair(Rolled_m(t_s, mps), 0.0); };
    motion.repeats_since_s = [](double t_s) {
      return t_s < 1.0 ? std::optional<double>() : std::optional(1.0);
    };
    const Found found = StopOf(motion);
    INFO(found.text);
    CHECK(found.reason == StopReason::kPictureRepeats);
    return found.t_s;
  };
  for (const double late_s : {0.0, 0.2}) {
    for (const double sign : {1.0, -1.0}) {
      CHECK(stopped(sign * 0.2, true, late_s) == Approx(1.1).margin(0.006));      // 0.1 s
      CHECK(stopped(sign * 0.04, true, late_s) == Approx(1.128).margin(0.006));   // 5 mm
      CHECK(stopped(sign * 0.04, false, late_s) == Approx(1.378).margin(0.006));  // 15 mm
    }
  }
}

TEST_CASE("Pose and wheels may part by a distance and a share of the way, to every side") {
  const auto found = [](double x_m, double y_m) {
    Motion motion{.times_s = Every(0.03)};
    motion.wheels_m = [](double t_s) { return std::pair(0.1 * t_s, 0.1 * t_s); };
    motion.pose = [=](double t_s) {
      return t_s < 1.0 ? Pose2{0.1 * t_s, 0.0, 0.0} : Pose2{0.1 * t_s + x_m, y_m, 0.0};
    };
    return StopOf(motion);
  };
  // 13 periods of 0.03 s are within 0.4 s: 0.05 m + 0.4 x 0.039 m.
  for (const auto& [x, y] : {std::pair{1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
    CHECK(found(0.0654 * x, 0.0654 * y).reason == kNone);
    const Found stopped = found(0.0658 * x, 0.0658 * y);
    CHECK(stopped.reason == StopReason::kPoseDisagrees);
    CHECK(stopped.text ==
          "pose and wheels part by 0.066 m within 0.4 s, in which the wheels rolled 0.039 m");
  }
}

TEST_CASE("On a circle to either side, forward and backward, the pose follows the wheels exactly") {
  for (const double v_mps : {0.1, -0.1}) {
    for (const double w_rad_s : {2.5, -2.5}) {
      Motion motion{.times_s = Every(0.04)};
      motion.options.agree_m = 1e-3;
      motion.options.agree_share = 0.0;
      motion.wheels_m = [=](double t_s) {
        return std::pair((v_mps - 0.5 * kTrack_m * w_rad_s) * t_s,
                         (v_mps + 0.5 * kTrack_m * w_rad_s) * t_s);
      };
      motion.pose = [=](double t_s) {
        const double yaw_rad = w_rad_s * t_s, radius_m = v_mps / w_rad_s;
        return Pose2{radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)),
                     geometry::WrapToPi(yaw_rad)};
      };
      const Found found = StopOf(motion);
      INFO(found.text);
      CHECK(found.reason == kNone);
    }
  }
}

TEST_CASE("Between two readings each wheel rolls evenly, and before the first it stood") {
  // 0.2 s apart, in which either wheel rolls by 16 and 24 mm; poses each 0.03 s.
  test::OnBothSides("left", "right", [](const test::Side& side) {
    EvidenceOptions options;
    options.agree_m = 1e-3;
    options.agree_share = 0.0;
    MotionCheck check(options, kTrack_m);
    check.SetLatency(0.0);
    const double w_rad_s = (side.IsFirst() ? -0.04 : 0.04) / kTrack_m;
    const auto pose = [&](double since_s) {
      const double yaw_rad = w_rad_s * since_s, radius_m = 0.1 / w_rad_s;
      return Pose2{radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)), yaw_rad};
    };
    int readings = 0;
    for (int i = 0; i < 100; ++i) {
      const double t_s = 0.03 * i - 0.3;
      check.SeePose({t_s, pose(std::max(0.0, t_s)), 0.0, 0.0, 0.0});
      while (0.2 * readings <= t_s) {
        const auto [left, right] = side.Of<std::pair<double, double>>(0.024, 0.016);
        check.SeeWheels({0.2 * readings, left * readings, right * readings}, true);
        ++readings;
      }
      const auto found = check.Check();
      INFO(t_s << ": " << (found ? found->text : ""));
      CHECK_FALSE(found);
    }
  });
}

TEST_CASE("A robot told to drive on one picture is stopped once both have lasted too long") {
  const auto found = [](double told_s, double repeats_s, double pose_s) {
    EvidenceOptions options;
    options.repeats_s = 0.375;
    options.max_latency_s = 0.125;
    MotionCheck check(options, kTrack_m);
    check.SeeCommand(true, told_s - 5.0);
    check.SeeCommand(false, told_s - 4.0);
    check.SeeCommand(true, told_s);
    check.SeeCommand(true, told_s + 0.25);  // it is told so all the time
    check.SeePose({pose_s, {}, 0.0, 0.0, 0.0}, repeats_s);
    return check.Check();
  };
  // 0.375 s + 0.125 s from the later of the two.
  for (const auto& [told_s, repeats_s] : {std::pair{10.0, 9.0}, {8.5, 10.0}}) {
    CHECK_FALSE(found(told_s, repeats_s, 10.5));
    const auto stopped = found(told_s, repeats_s, 10.5625);
    REQUIRE(stopped);
    CHECK(stopped->reason == StopReason::kPictureRepeats);
    CHECK_THAT(stopped->text, Catch::StartsWith("the camera has shown the same picture for 0.562"));
  }
  // Of a picture that is new, or a robot that is told to stand, nothing is held against it.
  MotionCheck check({}, kTrack_m);
  check.SeeCommand(true, 1.0);
  check.SeePose({2.0, {}, 0.0, 0.0, 0.0}, 1.0);
  check.SeePose({2.1, {}, 0.0, 0.0, 0.0});
  CHECK_FALSE(check.Check());
  check.SeeCommand(false, 2.2);
  check.SeePose({9.0, {}, 0.0, 0.0, 0.0}, 2.1);
  CHECK_FALSE(check.Check());
}

TEST_CASE("A pose that turns to and fro behind the wheels is stopped beyond the budgeted latency") {
  for (const double sign : {1.0, -1.0}) {
    const auto found = [&](double late_s, double known_s) {
      const auto yaw_rad = [=](double t_s) {
        return sign * 0.5 * std::sin(3.0 * std::max(0.0, t_s));
      };
      Motion motion{.latency_s = known_s, .times_s = Every(0.02, 4.0)};
      motion.options.blind_m = 0.05;
      motion.wheels_m = [=](double t_s) {
        const double rolled_m = 0.5 * kTrack_m * yaw_rad(t_s);
        return std::pair(-rolled_m, rolled_m);
      };
      motion.pose = [=](double t_s) { return Pose2{0.0, 0.0, yaw_rad(t_s - late_s)}; };
      return StopOf(motion);
    };
    CHECK(found(0.24, 0.0).reason == kNone);
    const Found stopped = found(0.28, 0.0);
    CHECK(stopped.reason == StopReason::kPoseLags);
    CHECK(stopped.text == "the pose lags the wheels by 0.28 s, and the limit is 0.25 s");
    CHECK(found(0.26, 0.0).text == "the pose lags the wheels by 0.26 s, and the limit is 0.25 s");
    CHECK(found(0.4, 0.16).reason == kNone);
    CHECK(found(0.44, 0.16).reason == StopReason::kPoseLags);
  }
}

TEST_CASE("What wheels and pose contradict each other in is told with its numbers") {
  // 0.32 m/s of the left wheel alone from 1 s on: 0.012 m + 0.1 s x 0.32 m/s.
  Motion rolls{.times_s = Every(kFine_s)};
  rolls.wheels_m = [](double t_s) { return std::pair(Rolled_m(t_s, 0.32), 0.0); };
  CHECK(StopOf(rolls).text ==
        "the wheels turned by 0.045 m and the pose stands: an old picture, wheels that slip, or a "
        "robot that is held");

  Motion pushed{.times_s = Every(kFine_s)};
  pushed.pose = [](double t_s) {
    return t_s < 1.0 ? Pose2{} : Pose2{0.03, -0.04, geometry::RadFromDeg(-12.0)};
  };
  CHECK(StopOf(pushed).text ==
        "the pose moved by 0.050 m and 12 deg and the wheels stand: another tag, or a robot that "
        "is pushed or carried");

  // 5 mm at 0.04 m/s take longer than the 0.1 s.
  Motion repeats{.times_s = Every(0.02)};
  repeats.wheels_m = [](double t_s) { return std::pair(0.0, -Rolled_m(t_s, 0.04)); };
  repeats.repeats_since_s = [](double t_s) {
    return t_s < 0.99 ? std::optional<double>() : std::optional(1.0);
  };
  CHECK(StopOf(repeats).text ==
        "the camera has shown the same picture for 0.140 s, in which the wheels rolled 0.006 m");
}

TEST_CASE("A drive on one picture is forgotten when what was seen is") {
  MotionCheck check({}, kTrack_m);
  check.SeeCommand(true, 1.0);
  check.SeePose({2.0, {}, 0.0, 0.0, 0.0}, 1.0);
  check.Restart();
  CHECK_FALSE(check.Check());
  check.SeePose({2.1, {}, 0.0, 0.0, 0.0}, 1.0);
  const auto found = check.Check();
  REQUIRE(found);
  CHECK(
      found->text ==
      "the camera has shown the same picture for 1.100 s, in which the robot was told to drive: a "
      "frozen camera, or a robot that does not move");
}

TEST_CASE("A lag that was found once before a restart counts for nothing after it") {
  // To and fro in place, by turns of 0.12 s with a rest behind each, seen 0.06 s late where 0.04 s
  // are budgeted; looked for every 0.2 s.
  const auto yaw_rad = [](double t_s) {
    const double turns = std::max(0.0, (t_s - 0.02) / 0.2), done = std::floor(turns);
    const double share = std::min(1.0, (turns - done) * 0.2 / 0.12);
    const double turned = share * share * (3.0 - 2.0 * share);
    return 0.5 * (static_cast<int>(done) % 2 == 0 ? turned : 1.0 - turned);
  };
  const auto stop_s = [&](std::optional<double> restart_s) {
    EvidenceOptions options;
    options.max_latency_s = 0.04;
    options.blind_m = options.agree_m = options.pushed_m = 10.0;
    options.pushed_deg = 360.0;
    MotionCheck check(options, kTrack_m);
    check.SetLatency(0.0);
    for (int i = 0; i < 200; ++i) {
      const double t_s = 0.01 * i, rolled_m = 0.5 * kTrack_m * yaw_rad(t_s);
      if (restart_s && std::abs(t_s - *restart_s) < 0.005) check.Restart();
      check.SeeWheels({t_s, -rolled_m, rolled_m}, true);
      check.SeePose({t_s, Pose2{0.0, 0.0, yaw_rad(t_s - 0.06)}, 0.0, 0.0, 0.0});
      if (const auto found = check.Check()) {
        CHECK(found->reason == StopReason::kPoseLags);
        return t_s;
      }
    }
    return 99.0;
  };
  const double without_s = stop_s({});
  CHECK(without_s < 1.0);
  // At rest after the first look: the one at which it would have been stopped is the next.
  const double with_s = stop_s(without_s - 0.19);
  CHECK(with_s > without_s + 0.15);
  CHECK(with_s < 2.0);
}

}  // namespace
}  // namespace rift::hardware
