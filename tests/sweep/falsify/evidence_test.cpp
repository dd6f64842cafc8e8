#include "rift/sweep/falsify/evidence.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/control/navigator.hpp"
#include "rift/trial/trial.hpp"
#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

using trajectory::Trajectory;

/// Straight along x, one metre and `rows` rows at 1 m/s, moved.
Trajectory Lane(double x_m, double y_m, int rows = 41) {
  return test::Moved(test::StraightPath(1.0, rows), {x_m, y_m, 0.0});
}

TEST_CASE("Errors along a path are reference minus candidate at each eighth but the start") {
  Trajectory candidate = Lane(0.0, 0.0);
  Trajectory reference = candidate;
  for (auto& pose : reference.poses) {
    pose.x_m = 0.1 + 1.2 * pose.x_m;
    pose.y_m = -0.3;
  }
  const auto errors_m = ErrorsAlong(candidate, reference, {});
  REQUIRE(errors_m.size() == 8);
  for (size_t k = 0; k < 8; ++k) {
    const double u = static_cast<double>(k + 1) / 8.0;
    CHECK(errors_m[k].x() == Approx(0.1 + 0.2 * u));
    CHECK(errors_m[k].y() == Approx(-0.3));
  }
  // What the gap leaves out at the start is no part of where the errors stand.
  CHECK(ErrorsAlong(candidate, reference, {.skip_start = 0.5}) == errors_m);
}

TEST_CASE("An even path has its ends and its middle, in metres, whatever the samples of the gap") {
  const Trajectory path = Lane(0.5, 0.2, 23);
  for (const auto& options :
       {gap::GapOptions{}, gap::GapOptions{.samples = 7}, gap::GapOptions{.skip_start = 0.5},
        gap::GapOptions{.align = gap::Align::kStart}}) {
    const std::vector<Eigen::Vector2f> points = EvenPath(path, options);
    REQUIRE(points.size() == 65);
    CHECK(points[0].x() == Approx(0.5F));
    CHECK(points[16].x() == Approx(0.75F));
    CHECK(points[64].x() == Approx(1.5F));
    CHECK(points[32].y() == Approx(0.2F));
    const std::vector<float> times_s = EvenTimes_s(path, options);
    REQUIRE(times_s.size() == 65);
    CHECK(times_s[0] == 0.0F);
    CHECK(times_s[32] == Approx(0.5F));
    CHECK(times_s[64] == Approx(1.0F));
  }
}

TEST_CASE("A candidate is drawn as it was held against its reference") {
  const Trajectory candidate = Lane(0.5, 0.2), reference = Lane(0.0, -0.1);
  CHECK(EvenPath(candidate, reference, {})[0].y() == Approx(0.2F));
  const auto aligned = EvenPath(candidate, reference, {.align = gap::Align::kStart});
  CHECK(aligned[0].x() == Approx(0.0F).margin(1e-6));
  CHECK(aligned[64].y() == Approx(-0.1F));
}

TEST_CASE("A path that does not move has no even points and no times") {
  Trajectory still = Lane(0.0, 0.0);
  for (auto& pose : still.poses) pose.x_m = 0.3;
  CHECK(EvenPath(still, {}).empty());
  CHECK(EvenTimes_s(still, {}).empty());
}

TEST_CASE("Every coordinate of every pose is part of a fingerprint, and -0 is 0") {
  Trajectory path = Lane(0.0, 0.0);
  for (auto& pose : path.poses) pose.z_m = pose.roll_rad = pose.pitch_rad = 0.0;
  const std::uint64_t print = Fingerprint(path);
  for (double trajectory::StampedPose::*member :
       {&trajectory::StampedPose::x_m, &trajectory::StampedPose::y_m, &trajectory::StampedPose::z_m,
        &trajectory::StampedPose::roll_rad, &trajectory::StampedPose::pitch_rad,
        &trajectory::StampedPose::yaw_rad}) {
    for (const size_t row : {size_t{0}, size_t{20}, path.poses.size() - 1}) {
      Trajectory changed = path;
      changed.poses[row].*member += 1e-9;
      CHECK(Fingerprint(changed) != print);
    }
  }
  Trajectory same = path;
  for (auto& pose : same.poses) pose.y_m = -0.0, pose.target_x_m = 1.0;
  CHECK(Fingerprint(same) == print);
  same.poses.pop_back();
  CHECK(Fingerprint(same) != print);
  CHECK(Fingerprint({}) == 0);  // there is none
}

TEST_CASE("What is forgotten of a trial is its path for pictures alone") {
  TrialEvidence evidence{
      .fingerprint = 3, .errors_m = {{0.1, 0.2}}, .path_m = {{0.1F, 0.2F}}, .path_times_s = {0.5F}};
  evidence.ForgetPath();
  CHECK(evidence.path_m.empty());
  CHECK(evidence.path_times_s.empty());
  CHECK(evidence.fingerprint == 3);
  CHECK(evidence.errors_m.size() == 1);
}

/// Along x at 0.2 m/s and 20 Hz, towards targets at 0.3 and 0.6 m.
Trajectory Driven() {
  Trajectory log;
  for (int i = 0; i < 61; ++i) {
    const double x_m = 0.01 * i;
    log.poses.push_back({.t_s = 5.0 + 0.05 * i,
                         .x_m = x_m,
                         .yaw_rad = 0.0,
                         .target_x_m = x_m < 0.27 ? 0.3 : 0.6,
                         .target_y_m = 0.0});
  }
  return log;
}

TEST_CASE("A controller is not rebuilt without a second row, yaw, or both coordinates of targets") {
  const Trajectory log = Driven();
  REQUIRE(RebuildLimits(log, {}));
  Trajectory one = log;
  one.poses.resize(1);
  CHECK_FALSE(RebuildLimits(one, {}));
  CHECK_FALSE(RebuildLimits({}, {}));
  Trajectory without_yaw = log;
  without_yaw.poses[7].yaw_rad = NAN;
  CHECK_FALSE(RebuildLimits(without_yaw, {}));
  Trajectory without_x = log, without_y = log;
  for (auto& pose : without_x.poses) pose.target_x_m = NAN;
  for (auto& pose : without_y.poses) pose.target_y_m = NAN;
  CHECK_FALSE(RebuildLimits(without_x, {}));
  CHECK_FALSE(RebuildLimits(without_y, {}));
  Trajectory two = log;
  two.poses.resize(2);
  CHECK(RebuildLimits(two, {}));
}

TEST_CASE("A rebuilt controller drives on to the last target and stops there") {
  const Trajectory log = Driven();
  const auto whole = RebuildLimits(log, {});
  // Within 0.05 m of the end the task is done: 0.55 m, rows 0 to 55, of which some settle.
  CHECK(whole->decisions > 40);
  CHECK(whole->decisions <= 56);
  Trajectory longer = log;
  for (int i = 61; i < 80; ++i) {
    longer.poses.push_back(longer.poses.back());
    longer.poses.back().t_s += 0.05;
  }
  CHECK(RebuildLimits(longer, {})->decisions == whole->decisions);
  Trajectory half = log;
  half.poses.resize(27);  // towards the first target alone
  CHECK(RebuildLimits(half, {})->decisions < 27);
}

TEST_CASE("The controller saw the tag, behind the point that a moved log names") {
  const Trajectory log = Driven();
  // The task ends within 0.05 m: a tag that is 0.1 m behind does not get there.
  const auto moved = RebuildLimits(trajectory::OffsetAlongHeading(log, 0.1), {}, 0.1);
  CHECK(moved->decisions == RebuildLimits(log, {})->decisions);
  CHECK(RebuildLimits(log, {}, 0.1)->decisions != moved->decisions);
}

/// Counts of each limit, then decisions.
std::vector<size_t> CountsOf(const trial::LimitCounts& limits) {
  std::vector<size_t> counts;
  trial::LimitCounts::Fields(limits,
                             [&](std::string_view, size_t count) { counts.push_back(count); });
  counts.push_back(limits.decisions);
  return counts;
}

TEST_CASE("What is rebuilt from a log is what the controller asked for when it was driven") {
  control::NavigatorOptions options;
  options.slew_rate_per_s = 1.5;
  const std::vector<control::Waypoint> task{
      {.name = "s"}, {.name = "a", .x_m = 0.5}, {.name = "b", .x_m = 0.4, .y_m = 0.4}};
  control::Navigator navigator(options, task);
  trial::Recorder recorder(task, 0.0);
  Trajectory log;
  geometry::Pose2 pose;
  for (int i = 0; i < 200; ++i) {  // a robot of 0.6 m/s at full power, which does what it is told
    const double t_s = 3.0 + 0.0625 * i;
    const control::Decision decision = navigator.Step({t_s, 0.0625, t_s, pose});
    if (decision.finished) break;
    navigator.NoteSent(t_s, decision.power);
    recorder.Decided(t_s, decision, navigator.active());
    log.poses.push_back({.t_s = t_s,
                         .x_m = pose.x_m,
                         .y_m = pose.y_m,
                         .yaw_rad = pose.yaw_rad,
                         .target_x_m = navigator.Target_m().x(),
                         .target_y_m = navigator.Target_m().y()});
    const auto [left, right] = decision.power;
    pose = pose * geometry::Pose2{0.015 * (left + right), 0.0, 0.1 * (right - left)};
  }
  REQUIRE(navigator.active() == 2);  // it stopped at the first target
  const trial::LimitCounts& driven = recorder.result().limits;
  const auto rebuilt = RebuildLimits(log, options);
  REQUIRE(rebuilt);
  CHECK(CountsOf(*rebuilt) == CountsOf(driven));
  CHECK(driven.slew > 0);
  CHECK(rebuilt->largest_raw_v == Approx(driven.largest_raw_v));
  CHECK(rebuilt->largest_raw_w == Approx(driven.largest_raw_w));
}

}  // namespace
}  // namespace rift::sweep
