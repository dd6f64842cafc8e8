#include <catch2/catch.hpp>
#include <cmath>

#include "rift/control/navigator.hpp"
#include "rift/control/pose_filter.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift::control {
namespace {

LatencyOptions Delay(double delay_s) {
  LatencyOptions latency;
  latency.delay_s = delay_s;
  return latency;
}

TEST_CASE("Without a delay the predicted pose is the measured one") {
  PosePredictor predictor(Delay(0.0));
  predictor.NoteSent(0.0, {1.0, 1.0});
  const geometry::Pose2 pose{0.1, 0.2, 0.3};
  CHECK(predictor.Predict(pose, 0.5, 0.7) == pose);
}

TEST_CASE("The prediction drives through exactly what was sent within the delay") {
  const DiffDrive drive;
  PosePredictor predictor(Delay(0.3));
  predictor.NoteSent(0.0, {0.2, 0.2});
  predictor.NoteSent(0.8, {0.1, 0.3});
  const geometry::Pose2 pose{0.1, 0.2, 0.3};
  const geometry::Pose2 expected = drive.Drive(drive.Drive(pose, {0.2, 0.2}, 0.1), {0.1, 0.3}, 0.2);
  const geometry::Pose2 predicted = predictor.Predict(pose, 1.0, 1.0);
  CHECK((predicted.Position() - expected.Position()).norm() < 1e-12);
  CHECK(predicted.yaw_rad == Approx(expected.yaw_rad));
}

TEST_CASE("A pose held since its arrival is driven on for that time too") {
  const DiffDrive drive;
  PosePredictor predictor(Delay(0.3));
  predictor.NoteSent(0.0, {0.2, 0.2});
  const geometry::Pose2 predicted = predictor.Predict({}, 1.0, 1.05);
  CHECK(predicted.x_m == Approx(drive.Drive({}, {0.2, 0.2}, 0.35).x_m));
}

// Weave of a robot with 0.3 s between command and effect. Without the derivative, which against
// the least steering holds any heading error below 0.0085 x 0.58 rad/s / 0.045 = 0.11 rad.
double HeadingErrorRms_rad(double compensated_s) {
  const DiffDrive drive;
  NavigatorOptions options;
  options.heading.d = 0.0;
  options.latency.delay_s = compensated_s;
  Navigator navigator(options, {{"a", 0.0, 0.0, 0.0, false}, {"b", 1.5, 0.0, {}, true}});
  const int delay_steps = 15;
  std::vector<WheelPower> sent;
  geometry::Pose2 pose{0.0, 0.0, 0.2};
  double sum = 0.0;
  int steps = 0;
  for (int step = 0; step < 400 && !navigator.finished(); ++step) {
    const double now_s = 0.02 * step;
    sent.push_back(navigator.Step({now_s, 0.02, now_s, pose}).power);
    navigator.NoteSent(now_s, sent.back());
    if (step >= delay_steps) pose = drive.Drive(pose, sent[step - delay_steps], 0.02);
    if (step < 60) continue;
    const double error_rad = std::atan2(-pose.y_m, 1.5 - pose.x_m) - pose.yaw_rad;
    sum += error_rad * error_rad;
    ++steps;
  }
  REQUIRE(steps > 20);
  return std::sqrt(sum / steps);
}

TEST_CASE("Making up for a delay of 0.3 s takes most of the weave away") {
  CHECK(HeadingErrorRms_rad(0.3) < 0.3 * HeadingErrorRms_rad(0.0));
}

}  // namespace
}  // namespace rift::control
