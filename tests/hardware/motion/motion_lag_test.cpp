// How far behind the wheels a pose is, beside motions whose errors are known in closed form.

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "motion.hpp"

namespace rift::hardware {
namespace {

using geometry::Pose2;

constexpr StopReason kNone = StopReason::kFinished;
constexpr double kPeriod_s = 0.02;  // of pictures and of readings
constexpr double kLate_s = 0.5;
constexpr double kRate_rad_s = 2.0 * std::numbers::pi;

/// Nothing but the lag is looked for, and pictures do not tell of themselves that they are late.
EvidenceOptions LagAlone() {
  EvidenceOptions options;
  options.blind_m = options.pushed_m = options.agree_m = 10.0;
  options.pushed_deg = 360.0;
  options.slip_share = 1.0;
  return options;
}

/// To and fro in place from `from_s` on, once a second, the poses half a second late. `noise_rad`:
/// of the poses, to and fro from picture to picture.
Found Turning(double amplitude_rad, double from_s, double end_s, double noise_rad = 0.0) {
  Motion motion{.options = LagAlone(), .late_s = kLate_s, .times_s = Every(kPeriod_s, end_s)};
  const auto yaw_rad = [=](double t_s) {
    return amplitude_rad * std::sin(kRate_rad_s * std::max(0.0, t_s - from_s));
  };
  motion.wheels_m = [=](double t_s) {
    const double rolled_m = 0.5 * kTrack_m * yaw_rad(t_s);
    return std::pair(-rolled_m, rolled_m);
  };
  motion.pose = [=](double t_s) {
    const bool is_odd = std::lround((t_s + kLate_s) / kPeriod_s) % 2 != 0;
    return Pose2{0.0, 0.0, yaw_rad(t_s) + (is_odd ? noise_rad : -noise_rad)};
  };
  return StopOf(motion);
}

/// Root mean square, at a wheel, of the difference between what wheels and late pose turn from one
/// picture to the seventh after it, which is the last within 0.15 s.
double LateError_m(double amplitude_rad) {
  const double turns = 2.0 * amplitude_rad * std::sin(0.5 * kRate_rad_s * 7 * kPeriod_s);
  return 0.5 * kTrack_m * 2.0 * turns * std::sin(0.5 * kRate_rad_s * kLate_s) / std::sqrt(2.0);
}

TEST_CASE("Turns that poses and wheels disagree in by less than four millimetres tell no lag") {
  const double four_mm_rad = 0.004 / LateError_m(1.0);
  for (const double sign : {1.0, -1.0}) {
    CHECK(Turning(sign * 0.96 * four_mm_rad, 0.0, 6.0).reason == kNone);
    const Found found = Turning(sign * 1.04 * four_mm_rad, 0.0, 6.0);
    CHECK(found.reason == StopReason::kPoseLags);
    CHECK(found.text == "the pose lags the wheels by 0.50 s, and the limit is 0.25 s");
  }
}

TEST_CASE("A lag is that of the last two seconds, found twice a fifth of a second apart") {
  // At rest for five seconds. Of two seconds 0.59 must show an error of 1.3 times four millimetres,
  // and in the first half second, in which the pose rests, it is smaller.
  const Found found = Turning(1.3 * 0.004 / LateError_m(1.0), 5.0, 12.0);
  CHECK(found.reason == StopReason::kPoseLags);
  CHECK(found.t_s + kLate_s > 6.6);
  CHECK(found.t_s + kLate_s < 7.02);
}

TEST_CASE("A lag is told only where it leaves less than a quarter of the squared error") {
  constexpr double kAmplitude_rad = 0.3;
  // To and fro by n makes 2 n of the seven pictures' difference: its square is a quarter of all
  // where it is a third of what the lag explains.
  const double third_rad = LateError_m(kAmplitude_rad) / std::sqrt(3.0) / (0.5 * kTrack_m) / 2.0;
  CHECK(Turning(kAmplitude_rad, 0.0, 6.0, 1.06 * third_rad).reason == kNone);
  CHECK(Turning(kAmplitude_rad, 0.0, 6.0, 0.94 * third_rad).reason == StopReason::kPoseLags);
}

TEST_CASE("A lag is looked for up to 1.2 s") {
  const auto text = [](double late_s, double max_latency_s) {
    Motion motion{.options = LagAlone(), .late_s = late_s, .times_s = Every(kPeriod_s, 8.0)};
    motion.options.max_latency_s = max_latency_s;
    const auto yaw_rad = [](double t_s) { return 0.5 * std::sin(2.5 * std::max(0.0, t_s)); };
    motion.wheels_m = [=](double t_s) {
      const double rolled_m = 0.5 * kTrack_m * yaw_rad(t_s);
      return std::pair(-rolled_m, rolled_m);
    };
    motion.pose = [=](double t_s) { return Pose2{0.0, 0.0, yaw_rad(t_s)}; };
    return StopOf(motion).text;
  };
  CHECK(text(0.9, 0.8) == "the pose lags the wheels by 0.90 s, and the limit is 0.80 s");
  CHECK(text(1.3, 1.1) == "the pose lags the wheels by 1.20 s, and the limit is 1.10 s");
}

TEST_CASE("A pose that drives behind the wheels, faster and slower, lags them as well") {
  for (const double sign : {1.0, -1.0}) {
    const auto found = [&](double late_s) {
      Motion motion{.options = LagAlone(), .late_s = late_s, .times_s = Every(kPeriod_s, 6.0)};
      motion.options.max_latency_s = 0.3;
      const auto way_m = [=](double t_s) {
        const double since_s = std::max(0.0, t_s);
        return sign * (0.3 * since_s + 0.06 * (1.0 - std::cos(4.0 * since_s)));
      };
      motion.wheels_m = [=](double t_s) { return std::pair(way_m(t_s), way_m(t_s)); };
      motion.pose = [=](double t_s) { return Pose2{0.0, way_m(t_s), 0.5 * std::numbers::pi}; };
      return StopOf(motion);
    };
    CHECK(found(0.28).reason == kNone);
    CHECK(found(0.4).text == "the pose lags the wheels by 0.40 s, and the limit is 0.30 s");
  }
}

}  // namespace
}  // namespace rift::hardware
