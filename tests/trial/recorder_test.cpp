#include <catch2/catch.hpp>

#include "rift/trial/trial.hpp"
#include "support/mirror.hpp"

namespace rift::trial {
namespace {

const std::vector<control::Waypoint> kTask{
    {"start", 0.0, 0.0}, {"one", 0.1, 0.0}, {"two", 0.2, 0.0}, {"three", 0.3, 0.0}};

control::Decision Driving(std::size_t waypoint, double distance_m) {
  control::Decision decision;
  decision.waypoint = waypoint;
  decision.distance_m = distance_m;
  return decision;
}

TEST_CASE("Each waypoint keeps its least distance and when it was reached or passed through") {
  Recorder recorder(kTask, 0.0);
  recorder.Decided(1.0, Driving(1, 0.10), 1);
  recorder.Decided(1.1, Driving(1, 0.04), 1);
  recorder.Decided(1.2, Driving(1, 0.07), 1);
  recorder.Decided(1.3, Driving(3, 0.09), 3);  // two waypoints were passed through
  control::Decision arrived = Driving(3, 0.01);
  arrived.reached = true;
  recorder.Decided(1.4, arrived, 3);
  const std::vector<WaypointVisit>& visits = recorder.result().visits;
  REQUIRE(visits.size() == 3);
  CHECK(visits[0].name == "one");
  CHECK(visits[0].closest_m == 0.04);
  CHECK(visits[0].reached_s == 1.3);
  CHECK(visits[1].reached_s == 1.3);
  CHECK_FALSE(visits[1].closest_m);
  CHECK(visits[2].closest_m == 0.01);
  CHECK(visits[2].reached_s == 1.4);
}

TEST_CASE("Limits are counted over the decisions that drove, with the most that was asked for") {
  Recorder recorder(kTask, 0.0);
  control::Decision decision = Driving(1, 0.1);
  decision.raw_v = 0.4;
  decision.raw_w = -0.9;
  decision.limits.v_max = decision.limits.w_min = true;
  recorder.Decided(1.0, decision, 1);
  decision.raw_v = 0.2;
  decision.raw_w = 0.5;
  decision.limits.w_min = false;
  recorder.Decided(1.1, decision, 1);
  decision.set_clock = true;  // it drove nothing
  recorder.Decided(1.2, decision, 1);
  const LimitCounts& limits = recorder.result().limits;
  CHECK(limits.decisions == 2);
  CHECK(limits.v_max == 2);
  CHECK(limits.w_min == 1);
  CHECK(limits.v_min == 0);
  CHECK(limits.w_max == 0);
  CHECK(limits.largest_raw_v == 0.4);
  CHECK(limits.largest_raw_w == 0.9);
}

TEST_CASE("Ages of poses are means, of the decisions and of the arrivals by themselves") {
  Recorder recorder(kTask, 0.0);
  CHECK(recorder.result().pose_age_s == -1.0);
  CHECK(recorder.result().arrival_age_s == -1.0);
  for (const double age_s : {0.1, 0.2, 0.6}) recorder.DecidedOn(age_s);
  for (const double age_s : {0.05, 0.15}) recorder.CameIn(age_s);
  CHECK(recorder.result().pose_age_s == Approx(0.3));
  CHECK(recorder.result().arrival_age_s == Approx(0.1));
}

TEST_CASE("Refused poses are counted by their moves and by their turns") {
  Recorder recorder(kTask, 0.0);
  recorder.Refused(true, false);
  recorder.Refused(true, true);
  recorder.Refused(true, false);
  recorder.Refused(false, false);
  recorder.Stale();
  CHECK(recorder.result().poses_refused == 4);
  CHECK(recorder.result().refused_moves == 3);
  CHECK(recorder.result().refused_turns == 1);
  CHECK(recorder.result().stale_decisions == 1);
}

TEST_CASE("A drive begins with the first power of either wheel") {
  test::OnBothSides("left", "right", [](const test::Side& side) {
    Recorder recorder(kTask, 0.0);
    recorder.Sent(1.0, {});
    CHECK(recorder.result().driving_s == -1.0);
    recorder.Sent(1.1, side.Of<control::WheelPower>(0.2, 0.0));
    recorder.Sent(1.2, {0.3, 0.3});
    CHECK(recorder.result().driving_s == 1.1);
    CHECK(recorder.result().commands.size() == 3);
    Recorder at_once(kTask, 0.0);
    at_once.Sent(0.0, side.Of<control::WheelPower>(0.2, 0.0));
    at_once.Sent(0.1, {0.3, 0.3});
    CHECK(at_once.result().driving_s == 0.0);
  });
}

TEST_CASE("A row has the pose, its target, its powers and its speeds, and the period thins them") {
  Recorder recorder(kTask, 0.25);
  PoseMeasurement pose{.captured_s = 1.0,
                       .world_from_robot = {0.1, 0.2, 0.3},
                       .z_m = 0.03,
                       .roll_rad = 0.01,
                       .pitch_rad = -0.02};
  control::Decision decision;
  decision.power = {0.15, 0.25};
  decision.v = 0.2;
  decision.w = 0.05;
  recorder.Pose(pose, {0.4, 0.5}, decision);
  pose.captured_s = 1.2;
  recorder.Pose(pose, {0.4, 0.5}, decision);
  pose.captured_s = 1.25;
  recorder.Pose(pose, {0.6, 0.7}, decision);
  recorder.Pose(pose, {0.6, 0.7}, decision);  // the same picture again
  const trajectory::Trajectory& log = recorder.result().trajectory;
  REQUIRE(log.poses.size() == 2);
  CHECK(log.poses[0].x_m == 0.1);
  CHECK(log.poses[0].y_m == 0.2);
  CHECK(log.poses[0].yaw_rad == 0.3);
  CHECK(log.poses[0].z_m == 0.03);
  CHECK(log.poses[0].roll_rad == 0.01);
  CHECK(log.poses[0].pitch_rad == -0.02);
  CHECK(log.poses[1].target_x_m == 0.6);
  CHECK(log.poses[1].target_y_m == 0.7);
  REQUIRE(log.channels.size() == 4);
  const std::vector<double> values{0.15, 0.25, 0.2, 0.05};
  for (std::size_t i = 0; i < 4; ++i) CHECK(log.channels[i].values.back() == values[i]);
  CHECK(log.channels[0].name == "power_left");
  CHECK(log.channels[1].name == "power_right");
  CHECK(log.channels[2].name == "v");
  CHECK(log.channels[3].name == "w");
}

TEST_CASE("A side of the arena belongs to it, and the sides must be in order") {
  test::OnBothSides("x", "y", [](const test::Side& side) {
    Arena arena;
    side.In(arena, &Arena::x_min_m, &Arena::y_min_m) = -0.1;
    side.In(arena, &Arena::x_max_m, &Arena::y_max_m) = 0.2;
    const auto contains = [&](double along_m) {
      return side.IsFirst() ? arena.Contains(along_m, 9.0) : arena.Contains(9.0, along_m);
    };
    CHECK(contains(-0.1));
    CHECK(contains(0.2));
    CHECK_FALSE(contains(-0.101));
    CHECK_FALSE(contains(0.201));
    TrialOptions options;
    options.arena = arena;
    CHECK_NOTHROW(options.Check());
    side.In(options.arena, &Arena::x_max_m, &Arena::y_max_m) = -0.1;
    CHECK_THROWS_WITH(options.Check(), Catch::Contains(side.IsFirst() ? "arena.x_min_m is -0.1"
                                                                      : "arena.y_min_m is -0.1"));
  });
  TrialOptions options;
  options.pose_stale_s = options.lost_after_s = 1.0;
  CHECK_NOTHROW(options.Check());
  options.pose_stale_s = 1.001;
  CHECK_THROWS_WITH(options.Check(), Catch::Contains("pose_stale_s is 1.001"));
  options = {};
  options.timeout_s = 0.0;
  CHECK_THROWS_WITH(options.Check(), Catch::Contains("timeout_s 0"));
}

}  // namespace
}  // namespace rift::trial
