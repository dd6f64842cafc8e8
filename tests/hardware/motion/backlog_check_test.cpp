// Pictures that come later and later, each with a fresh stamp.

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "hardware/backlog_check.hpp"
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
  bool is_latency_known = true;  ///< was measured then
  bool fills_up = false;         ///< each period a picture, what is shown repeated with other noise
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
      if (drive.is_latency_known) check.SetLatency(0.0);
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

TEST_CASE("Where no latency was measured, the period is that of the pictures before the start") {
  const Stop held = StopHeld({.rate = 0.5, .is_latency_known = false});
  INFO(held.text);
  CHECK(held.reason == StopReason::kPoseLags);
  CHECK(held.text.find("of pictures did not come, and the limit is 0.25 s") != std::string::npos);
  CHECK(held.age_s < 0.9);
}

/// Motions of one kind, each of `elapsed_s`, of which the pose shows `short_m` less than rolled.
struct Kind {
  double rolled_m = 0.05;
  double short_m = 0.03;
  double elapsed_s = 0.1;
  bool is_measured = true;
  bool is_latency_known = true;
};

BacklogCheck::Motion MotionOf(const Kind& kind, bool is_turn, double sign) {
  BacklogCheck::Motion motion{.elapsed_s = kind.elapsed_s};
  const auto part = is_turn ? &Step::turn_m : &Step::forward_m;
  motion.rolled.*part = sign * kind.rolled_m;
  motion.seen.*part = sign * (kind.rolled_m - kind.short_m);
  return motion;
}

/// Camera pictures each `period_s`, if any: the period that is known then.
BacklogCheck After(const std::optional<double>& period_s, int pictures = 20) {
  BacklogCheck check(EvidenceOptions{});
  for (int i = 0; period_s && i < pictures; ++i) check.SeePicture(*period_s * i);
  check.LearnPeriod();
  return check;
}

struct FoundAt {
  int motions = 0;  ///< 0: never
  std::string text;
};

FoundAt FoundWith(BacklogCheck check, const Kind& kind, bool is_turn, double sign) {
  for (int i = 1; i <= 40; ++i) {
    const auto found =
        check.Check(MotionOf(kind, is_turn, sign), kind.is_measured, kind.is_latency_known);
    if (found) return {i, *found};
  }
  return {};
}

TEST_CASE("Held pictures are found when way and missing pictures are both beyond the latency") {
  // 0.5 m/s: the pose may be 6 mm and 0.25 s x 0.5 m/s behind, 0.131 m; nearly half of the pictures
  // miss.
  for (const bool is_turn : {false, true}) {
    for (const double sign : {1.0, -1.0}) {
      INFO(is_turn << " " << sign);
      const auto motions = [&](const Kind& kind) {
        return FoundWith(After(0.052), kind, is_turn, sign).motions;
      };
      CHECK(motions({}) == 6);                           // 0.18 m, and 0.288 s of pictures
      CHECK(motions({.short_m = 0.02}) == 7);            // 0.14 m
      CHECK(motions({.short_m = 0.0345}) == 6);          // 0.69 of the way
      CHECK(motions({.short_m = 0.0355}) == 0);          // 0.71: the pose stands
      CHECK(motions({.is_latency_known = false}) == 9);  // 0.006 m + 0.5 s x 0.5 m/s = 0.256 m
      CHECK(motions({.is_measured = false}) == 7);       // less 0.2 of the way: 0.14 m
      // At 1 m/s, 0.256 m, and no picture misses: the slip's share alone.
      CHECK(motions({.elapsed_s = 0.05}) == (is_turn ? 0 : 13));
    }
  }
  CHECK(FoundWith(After(0.052), {}, false, -1.0).text ==
        "the pose fell 0.180 m behind the wheels within 0.6 s, in which 0.29 s of pictures did not "
        "come, and the limit is 0.25 s: something between camera and rift holds pictures back");
}

TEST_CASE("On a curve it is the longer one of way and turn that the pose may fall behind in") {
  for (const bool is_turn : {false, true}) {
    for (const double sign : {1.0, -1.0}) {
      BacklogCheck check = After(0.052);
      const auto longer = is_turn ? &Step::turn_m : &Step::forward_m;
      const auto shorter = is_turn ? &Step::forward_m : &Step::turn_m;
      BacklogCheck::Motion motion{.elapsed_s = 0.1};
      motion.rolled.*longer = sign * 0.05;
      motion.seen.*longer = sign * 0.02;
      motion.rolled.*shorter = motion.seen.*shorter = 0.01;
      for (int i = 0; i < 5; ++i) CHECK_FALSE(check.Check(motion, true, true));
      const auto found = check.Check(motion, true, true);
      REQUIRE(found);
      CHECK_THAT(*found, Catch::StartsWith("the pose fell 0.180 m behind the wheels within 0.6 s"));
      // Of the shorter one it may.
      BacklogCheck other = After(0.052);
      motion.seen.*longer = motion.rolled.*longer;
      motion.seen.*shorter = 0.004;
      for (int i = 0; i < 30; ++i) CHECK_FALSE(other.Check(motion, true, true));
    }
  }
}

TEST_CASE("Without missing pictures only the forward way beyond the slip's share is too much") {
  for (const double sign : {1.0, -1.0}) {
    const auto found = [&](const Kind& kind, bool is_turn = false) {
      return FoundWith(After({}), kind, is_turn, sign);
    };
    // 0.03 m less 0.2 x 0.05 m each.
    CHECK(found({}).motions == 7);
    CHECK(found({}).text ==
          "the pose fell 0.210 m behind the wheels within 0.7 s, in which they rolled 0.350 m: "
          "pictures that come later and later, or wheels that slip");
    CHECK(found({.short_m = 0.0334}).motions == 6);
    CHECK(found({.short_m = 0.01}).motions == 0);
    CHECK(found({.is_latency_known = false}).motions == 13);
    CHECK(found({.is_measured = false}).motions == 0);
    CHECK(found({}, true).motions == 0);
  }
}

TEST_CASE("Motions count for four seconds, and those to the other side not at all") {
  // Half a second each, of which eight are kept: 0.128 m and 0.132 m.
  CHECK(FoundWith(After(0.052), {.rolled_m = 0.25, .short_m = 0.016, .elapsed_s = 0.5}, false, 1.0)
            .motions == 0);
  CHECK(FoundWith(After(0.052), {.rolled_m = 0.25, .short_m = 0.0165, .elapsed_s = 0.5}, false, 1.0)
            .motions == 8);
  BacklogCheck check = After(0.052);
  for (int i = 0; i < 5; ++i) CHECK_FALSE(check.Check(MotionOf({}, false, 1.0), true, true));
  for (int i = 0; i < 5; ++i) CHECK_FALSE(check.Check(MotionOf({}, false, -1.0), true, true));
  CHECK(check.Check(MotionOf({}, false, -1.0), true, true));
  check.Restart();
  CHECK(check.KnowsPeriod());
  for (int i = 0; i < 5; ++i) CHECK_FALSE(check.Check(MotionOf({}, false, -1.0), true, true));
  CHECK(check.Check(MotionOf({}, false, -1.0), true, true));
}

TEST_CASE("A rest adds to the time that passed and not to that in which the wheels rolled") {
  BacklogCheck check = After(0.052);
  for (int i = 0; i < 4; ++i) CHECK_FALSE(check.Check(MotionOf({}, false, 1.0), true, true));
  // 0.12 m: 0.131 m are allowed at the speed of the four.
  for (int i = 0; i < 4; ++i) {
    const Kind rest{.rolled_m = 0.0004, .short_m = 0.0004};
    CHECK_FALSE(check.Check(MotionOf(rest, false, 1.0), true, true));
  }
  const auto found = check.Check(MotionOf({}, false, 1.0), true, true);
  REQUIRE(found);
  CHECK(*found ==
        "the pose fell 0.152 m behind the wheels within 0.9 s, in which 0.43 s of pictures did not "
        "come, and the limit is 0.25 s: something between camera and rift holds pictures back");
}

TEST_CASE("A camera's period is the mean of ten spacings or more of the last four seconds") {
  CHECK_FALSE(After(0.05, 10).KnowsPeriod());
  CHECK(After(0.05, 11).KnowsPeriod());
  CHECK_FALSE(After(0.41, 40).KnowsPeriod());
  CHECK(After(0.39, 40).KnowsPeriod());
  // 20 pictures each 0.04 s, but for one spacing: the mean with it is 0.044 s, else 0.04 s.
  const auto missing_s = [](double longest_s) {
    BacklogCheck check(EvidenceOptions{});
    double t_s = 0.0;
    for (int i = 0; i < 20; ++i) check.SeePicture(t_s += i == 7 ? longest_s : 0.04);
    check.LearnPeriod();
    const std::string text = FoundWith(check, {}, false, 1.0).text;
    const std::string before = "in which ";
    const size_t at = text.find(before);
    REQUIRE(at != std::string::npos);
    return std::stod(text.substr(at + before.size()));
  };
  // Of five motions, 0.5 s.
  CHECK(missing_s(0.125) == Approx(0.30));
  CHECK(missing_s(0.118) == Approx(0.28));
}

}  // namespace
}  // namespace rift::hardware
