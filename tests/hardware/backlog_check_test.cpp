// Pictures that come later and later, each with a fresh stamp.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "motion.hpp"
#include "support/mirror.hpp"

namespace rift::hardware {
namespace {

using geometry::Pose2;

constexpr StopReason kNone = StopReason::kFinished;
constexpr double kKnown_s = 1.0;  // when the camera's latency was measured

/// A drive whose pictures are held back from `from_s` on.
struct Backlog {
  double speed_mps = 0.36;
  double turn_rad_s = 0.0;
  double from_s = 2.2;
  double rate = 1.0;        ///< of what the pictures show: 1 s of it takes 1 / rate s
  double dropped = 0.0;     ///< share of the pictures that never come, from then on
  double slip = 0.0;        ///< of the wheels
  double jitter_m = 0.001;  ///< of the poses, to and fro
  double starts_s = 2.0;
  double end_s = 12.0;
  bool is_measured = true;
  bool fills_up = false;  ///< each period a picture, what is shown repeated with other noise
};

struct Stop {
  double t_s = 0.0;
  double age_s = 0.0;  ///< of what was shown then
  StopReason reason = kNone;
  std::string text;
};

double Sign(const test::Side& side) { return side.IsFirst() ? 1.0 : -1.0; }

Stop StopHeld(const Backlog& drive) {
  constexpr double kPeriod_s = 1.0 / 30.0;
  MotionCheck check({}, kTrack_m);
  bool is_known = false;
  double dropped = 0.0;
  int wheel = 0;
  const auto driven_s = [&](double t_s) { return std::max(0.0, t_s - drive.starts_s); };
  const auto pose = [&](double t_s) {
    const double share = 1.0 - drive.slip, yaw_rad = share * drive.turn_rad_s * driven_s(t_s);
    return Pose2{share * drive.speed_mps * driven_s(t_s), 0.0, yaw_rad};
  };
  for (int i = 0; kPeriod_s * i < drive.end_s; ++i) {
    const double taken_s = kPeriod_s * i;
    const bool is_held = taken_s > drive.from_s;
    double came_s =
        is_held && !drive.fills_up ? drive.from_s + (taken_s - drive.from_s) / drive.rate : taken_s;
    const double shown_s =
        is_held && drive.fills_up ? drive.from_s + (taken_s - drive.from_s) * drive.rate : taken_s;
    if (is_held) dropped += drive.dropped;
    if (dropped >= 1.0) {
      dropped -= 1.0;
      continue;
    }
    if (!is_known && came_s > kKnown_s) {
      check.SetLatency(0.0);
      check.Restart();
      is_known = true;
    }
    for (; 0.02 * wheel <= came_s + 0.02; ++wheel) {
      const double t_s = 0.02 * wheel, way_m = drive.speed_mps * driven_s(t_s);
      const double turn_m = 0.5 * kTrack_m * drive.turn_rad_s * driven_s(t_s);
      check.SeeWheels({t_s, way_m - turn_m, way_m + turn_m}, drive.is_measured);
    }
    Pose2 seen = pose(shown_s);
    seen.x_m += (i % 2 == 0 ? 0.5 : -0.5) * drive.jitter_m;
    check.SeePose({came_s, seen, 0.0, 0.0, 0.0});
    if (const auto found = check.Check()) {
      return {came_s, came_s - shown_s, found->reason, found->text};
    }
  }
  return {};
}

TEST_CASE("Pictures that a slow link holds back stop a drive before they are half a second old") {
  test::OnBothSides("forward", "backward", [](const test::Side& side) {
    for (const double rate : {0.9, 0.8, 0.67, 0.5, 0.3}) {
      for (const double speed_mps : {0.08, 0.36, 1.0}) {
        const Stop stop = StopHeld({.speed_mps = Sign(side) * speed_mps, .rate = rate});
        INFO(rate << " " << speed_mps << " " << stop.text);
        CHECK(stop.reason != kNone);
        CHECK(stop.age_s < 0.45);
      }
    }
  });
}

TEST_CASE("Pictures of a robot that turns on the spot are held back no longer") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    for (const double rate : {0.9, 0.67, 0.5}) {
      const Stop stop = StopHeld({.speed_mps = 0.0, .turn_rad_s = Sign(side) * 3.0, .rate = rate});
      INFO(rate << " " << stop.text);
      CHECK(stop.reason == StopReason::kPoseLags);
      CHECK(stop.age_s < 0.45);
    }
  });
}

TEST_CASE("A link that fills up with old pictures is found by the way, later") {
  const Stop stop = StopHeld({.rate = 0.67, .fills_up = true});
  CHECK(stop.reason == StopReason::kPoseLags);
  CHECK(stop.text.find("pictures that come later and later, or wheels that slip") !=
        std::string::npos);
  CHECK(stop.age_s < 0.8);
}

TEST_CASE("Pictures that are left out, and wheels that slip, stop nothing") {
  test::OnBothSides("forward", "backward", [](const test::Side& side) {
    const double speed_mps = Sign(side) * 0.36;
    for (const double dropped : {0.1, 0.33, 0.5}) {
      CHECK(StopHeld({.speed_mps = speed_mps, .dropped = dropped}).reason == kNone);
      CHECK(StopHeld({.speed_mps = speed_mps, .dropped = dropped, .slip = 0.04}).reason == kNone);
    }
    for (const double slip : {-0.15, 0.05, 0.15, 0.2}) {
      CHECK(StopHeld({.speed_mps = speed_mps, .slip = slip}).reason == kNone);
      CHECK(StopHeld({.speed_mps = 0.0, .turn_rad_s = Sign(side) * 3.0, .slip = slip}).reason ==
            kNone);
    }
  });
}

TEST_CASE("Wheels that slip by more than their share for long stop a drive") {
  CHECK(StopHeld({.slip = 0.25}).reason == kNone);  // over four seconds less than the latency
  const Stop stop = StopHeld({.slip = 0.35});
  CHECK(stop.reason == StopReason::kPoseLags);
  CHECK(stop.text.find("wheels that slip") != std::string::npos);
}

TEST_CASE("Where only commands tell of the wheels, held pictures are found by their number") {
  const Stop held = StopHeld({.rate = 0.67, .is_measured = false});
  CHECK(held.reason == StopReason::kPoseLags);
  CHECK(held.text.find("of pictures did not come") != std::string::npos);
  CHECK(held.age_s < 0.9);
  CHECK(StopHeld({.slip = 0.3, .is_measured = false}).reason == kNone);
  CHECK(StopHeld({.dropped = 0.33, .slip = 0.2, .is_measured = false}).reason == kNone);
}

}  // namespace
}  // namespace rift::hardware
