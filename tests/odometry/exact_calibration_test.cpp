// A calibration beside what an implementation of its own in NumPy, oracle/make.py, gives for the
// same runs.
#include <catch2/catch.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "rift/odometry/calibration.hpp"

namespace rift::odometry {
namespace {

/// Counts of both wheels, as real numbers.
std::pair<double, double> CountsOf(double t_s, double phase) {
  return {150.0 * t_s + 40.0 * std::sin(0.9 * t_s + phase),
          163.0 * t_s + 55.0 * std::cos(0.7 * t_s + phase)};
}

/// A robot on a winding way whose tag sits aside and turned, seen with waves instead of noise, and
/// now and then at the place of another tag or turned the wrong way.
RunLog Winding(double phase) {
  constexpr double kTrack_m = 0.0862;
  constexpr geometry::Pose2 kTag{0.011, -0.004, 0.05};
  const double metres = 2.0 * geometry::kPi * 0.0165 / 358.3;
  const double left_m = 2.0 / (1.0 + 1.012) * metres, right_m = 1.012 * left_m;
  RunLog run{.name = "winding"};
  for (int k = 0; k < 501; ++k) {
    const auto [left, right] = CountsOf(0.06 * k, phase);
    run.encoders.push_back({0.06 * k,
                            {static_cast<std::int64_t>(std::floor(left)),
                             static_cast<std::int64_t>(std::floor(right))}});
  }
  geometry::Pose2 at{0.3, -0.2, 0.4 + phase};
  double since_s = 0.0;
  std::pair<double, double> last = CountsOf(0.0, phase);
  for (int j = 0; j < 421; ++j) {
    const double t_s = 0.03 + 0.07 * j;
    for (int i = 1; i <= 20; ++i) {
      const auto now = CountsOf(since_s + (t_s - since_s) * i / 20.0, phase);
      const double a_m = left_m * (now.first - last.first);
      const double b_m = right_m * (now.second - last.second);
      at = at * control::ArcMotion(0.5 * (a_m + b_m), (b_m - a_m) / kTrack_m);
      last = now;
    }
    since_s = t_s;
    const geometry::Pose2 tag = at * kTag;
    run.camera.poses.push_back(
        {.t_s = t_s,
         .x_m = tag.x_m + 0.0012 * std::sin(2.4 * j) + (j % 23 == 11 ? 0.05 : 0.0),
         .y_m = tag.y_m + 0.0009 * std::cos(1.9 * j),
         .yaw_rad = tag.yaw_rad + 0.012 * std::sin(2.7 * j) + (j % 31 == 7 ? 0.4 : 0.0)});
  }
  return run;
}

void CheckEstimate(const Estimate& found, double value, double low, double high) {
  CHECK(found.value == Approx(value).epsilon(2e-7));
  CHECK(found.interval.low == Approx(low).epsilon(2e-7));
  CHECK(found.interval.high == Approx(high).epsilon(2e-7));
}

TEST_CASE("Wheels, track and tag of runs with outliers are those of robust least squares") {
  const std::vector<RunLog> runs{Winding(0.0), Winding(1.3), Winding(2.9)};
  const OdometryCalibration found =
      CalibrateOdometry(runs, {}, {.window_s = 2.0, .confidence = 0.9});
  CHECK(found.windows == 45);
  CheckEstimate(found.wheel_radius_m, 0.016506064659846716, 0.01649115500724529,
                0.016520987792264477);
  CheckEstimate(found.right_over_left, 1.0116839474759614, 1.0097370237072822, 1.0136346252044062);
  CheckEstimate(found.track_m, 0.08589570917550422, 0.08514962061634372, 0.08664833502906583);
  CheckEstimate(found.tag_ahead_m, 0.011485692023140386, 0.011153514931735258,
                0.011817869114545514);
  CHECK(found.noise_m == Approx(0.001059826097873218).epsilon(1e-5));
  CHECK(found.noise_yaw_rad == Approx(0.012456996553672562).epsilon(1e-5));
}

}  // namespace
}  // namespace rift::odometry
