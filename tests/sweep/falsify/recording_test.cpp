// A trajectory as a sweep gets it: how it ended, how far it was from the end, as bytes, as a row.
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/falsify/job_status.hpp"
#include "sweep/falsify/simulated_recording.hpp"

namespace rift::sweep {
namespace {

TEST_CASE("Every outcome of a trial and every end of a job is the status of that name") {
  using trial::Outcome;
  CHECK(StatusOf(Outcome::kReached) == TrialStatus::kOk);
  CHECK(StatusOf(Outcome::kTimedOut) == TrialStatus::kTimedOut);
  CHECK(StatusOf(Outcome::kFell) == TrialStatus::kFell);
  CHECK(StatusOf(Outcome::kLeftArena) == TrialStatus::kLeftArena);
  CHECK(StatusOf(Outcome::kLost) == TrialStatus::kLost);
  CHECK(StatusOf(Outcome::kFault) == TrialStatus::kFault);
  CHECK(StatusOf(JobEnd::kDone) == TrialStatus::kOk);
  CHECK(StatusOf(JobEnd::kThrew) == TrialStatus::kFault);
  CHECK(StatusOf(JobEnd::kHung) == TrialStatus::kHung);
  CHECK(StatusOf(JobEnd::kCrashed) == TrialStatus::kCrashed);
  CHECK(StatusOf(JobEnd::kOutOfMemory) == TrialStatus::kOutOfMemory);
}

TEST_CASE("A job that ended is a row with the first line of its reason") {
  const TrialRequest request{
      .theta = {{"1", 1.0}}, .trial = "2", .seed = 3, .is_random_draw = true};
  const TrialRow row = EndedRow(request, {JobEnd::kThrew, "one line\nand another"});
  CHECK(row.status == TrialStatus::kFault);
  CHECK(row.reason == "one line");
  CHECK(row.theta == request.theta);
  CHECK(row.trial == "2");
  CHECK(row.seed == 3u);
  CHECK(row.is_random_draw);
  const TrialRow done = EndedRow(request, {JobEnd::kDone, "bytes"});
  CHECK(done.IsOk());
  CHECK(done.reason.empty());
  CHECK(RequestOf(row).is_random_draw);
  CHECK(RequestOf(row).seed == 3u);
  CHECK(RequestOf(row).trial == "2");
  CHECK(RequestOf(row).theta == request.theta);
}

/// Three legs of 3, 4 and 2 m; ends at `end` with `reached` of the three targets.
Recording Ended(trial::Outcome outcome, int reached, std::optional<Eigen::Vector2d> end) {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "s"},
                                             {.name = "a", .x_m = 3.0},
                                             {.name = "b", .x_m = 3.0, .y_m = 4.0},
                                             {.name = "c", .x_m = 1.0, .y_m = 4.0}},
      .seed = 17};
  SimulatedRun run;
  run.result.outcome = outcome;
  run.result.reason = "why";
  run.result.visits.resize(3);
  run.result.limits.decisions = 5;
  run.result.trajectory = test::StraightPath(1.0, 3);
  for (int i = 0; i < reached; ++i) run.result.visits[static_cast<size_t>(i)].reached_s = 1.0 * i;
  if (end) {
    run.truth.poses = {{.x_m = 9.0, .y_m = 9.0}, {.x_m = end->x(), .y_m = end->y()}};
  }
  return RecordingOf(std::move(run), trial);
}

TEST_CASE("What is left of a run is the way to the next target and along all the others") {
  using trial::Outcome;
  const auto left_m = [](int reached, const std::optional<Eigen::Vector2d>& end) {
    return Ended(Outcome::kTimedOut, reached, end).left_m;
  };
  CHECK(left_m(0, Eigen::Vector2d(0.0, 0.0)) == Approx(9.0));
  CHECK(left_m(0, Eigen::Vector2d(3.0, -0.5)) == Approx(6.5));
  CHECK(left_m(1, Eigen::Vector2d(3.0, 0.0)) == Approx(6.0));
  CHECK(left_m(1, Eigen::Vector2d(0.0, 4.0)) == Approx(5.0));
  CHECK(left_m(2, Eigen::Vector2d(3.0, 3.0)) == Approx(std::sqrt(5.0)));
  CHECK(left_m(3, Eigen::Vector2d(5.0, 5.0)) == 0.0);
  CHECK(left_m(0, std::nullopt) == Approx(9.0));  // it never moved: from the start
}

TEST_CASE("A simulated run names its seed, and has a reason and a way left unless it arrived") {
  const Recording lost = Ended(trial::Outcome::kLost, 0, Eigen::Vector2d(0.0, 0.0));
  CHECK(lost.status == TrialStatus::kLost);
  CHECK(lost.source == "simulation with seed 17");
  CHECK(lost.reason == "why");
  CHECK(lost.limits->decisions == 5);
  CHECK(lost.trajectory.poses.size() == 3);
  const Recording arrived = Ended(trial::Outcome::kReached, 3, Eigen::Vector2d(1.0, 4.0));
  CHECK(arrived.status == TrialStatus::kOk);
  CHECK(arrived.reason.empty());
  CHECK(std::isnan(arrived.left_m));
}

TEST_CASE("A simulated robot that drives off the table has fallen, with a way left") {
  SimulatedTrial trial{
      .task = std::vector<control::Waypoint>{{.name = "s"}, {.name = "a", .x_m = 0.4}}, .seed = 3};
  trial.simulation.terrain.table_half_size_m = 0.1;
  const Recording fallen = RecordingOf(Simulate(trial), trial);
  CHECK(fallen.status == TrialStatus::kFell);
  CHECK_THAT(fallen.reason, Catch::Contains(" at (0.1"));
  CHECK(fallen.left_m == Approx(0.28).margin(0.05));
}

TEST_CASE("A recording comes back from its bytes, and other bytes are refused") {
  Recording recording{.status = TrialStatus::kFell,
                      .reason = "it fell",
                      .source = "program",
                      .trajectory = test::StraightPath(0.7, 5),
                      .doubts = {"one", "two"},
                      .left_m = 0.25};
  recording.limits.emplace().largest_raw_v = 0.4;
  recording.trajectory.channels = {{"v", {1, 2, 3, 4, 5}}};
  const std::string bytes = EncodeRecording(recording);
  const Recording back = DecodeRecording(bytes);
  CHECK(back.status == TrialStatus::kFell);
  CHECK(back.reason == "it fell");
  CHECK(back.source == "program");
  CHECK(back.doubts == recording.doubts);
  CHECK(back.left_m == 0.25);
  CHECK(back.limits->largest_raw_v == 0.4);
  CHECK(back.trajectory.poses[4].x_m == Approx(0.7));
  CHECK(back.trajectory.channels[0].values[2] == 3.0);
  CHECK(EncodeRecording(back) == bytes);
  CHECK_THROWS_WITH(DecodeRecording(bytes + "x"), Catch::Contains("of another layout"));
}

TEST_CASE("Each end of a candidate counts as a failure by its own switch and no other") {
  struct Case {
    TrialStatus status;
    bool CountOptions::*counts;
  };
  const Case table[] = {{TrialStatus::kTimedOut, &CountOptions::timed_out},
                        {TrialStatus::kFell, &CountOptions::fell},
                        {TrialStatus::kLeftArena, &CountOptions::left_arena},
                        {TrialStatus::kLost, &CountOptions::lost}};
  const Recording reference{.source = "path", .trajectory = test::StraightPath(0.7, 40)};
  experiment::Experiment plan;
  for (const Case& one : table) {
    const Recording candidate{.status = one.status,
                              .reason = "why",
                              .source = "run",
                              .trajectory = test::StraightPath(0.3, 20),
                              .left_m = 0.4};
    for (const Case& other : table) {
      plan.falsify.count = {false, false, false, false};
      plan.falsify.count.*other.counts = true;
      const TrialRow row = CompareTrial(plan, {}, candidate, reference);
      CHECK(row.falsified == (one.status == other.status));
      CHECK((row.evidence.fingerprint != 0) == row.falsified);
      CHECK(row.status == one.status);
      CHECK(row.reason == "run: why");
      CHECK(row.left_m == 0.4);
      CHECK(row.evidence.path_m.size() == kPathSteps + 1);
      CHECK(row.evidence.path_times_s.back() == Approx(0.3F));
      CHECK(std::isnan(row.comparison.gap_m));
    }
  }
  plan.falsify.count = {};
  for (const TrialStatus status :
       {TrialStatus::kMissing, TrialStatus::kUnreadable, TrialStatus::kFault, TrialStatus::kInvalid,
        TrialStatus::kHung, TrialStatus::kCrashed, TrialStatus::kOutOfMemory}) {
    CHECK_FALSE(CompareTrial(plan, {}, {.status = status}, reference).falsified);
  }
}

TEST_CASE("A reference that is not there is the reason, whatever became of the candidate") {
  const Recording missing{
      .status = TrialStatus::kMissing, .reason = "no such file", .source = "real.csv"};
  const Recording fell{.status = TrialStatus::kFell, .reason = "sim: it fell", .source = "sim"};
  const TrialRow row = CompareTrial({}, {}, fell, missing);
  CHECK(row.status == TrialStatus::kMissing);
  CHECK(row.reason == "real.csv: no such file");
  CHECK_FALSE(row.falsified);
  CHECK(row.candidate == "sim");
  CHECK(row.reference == "real.csv");
  const Recording path{.source = "path", .trajectory = test::StraightPath(0.7, 40)};
  CHECK(CompareTrial({}, {}, fell, path).reason == "sim: it fell");  // named already
}

TEST_CASE("A row fails by a gap above the threshold, and not by one at it") {
  experiment::Experiment plan;
  const Recording reference{.source = "path", .trajectory = test::StraightPath(0.75, 40)};
  Recording candidate = reference;
  candidate.limits.emplace().decisions = 3;
  for (auto& pose : candidate.trajectory.poses) pose.y_m = 0.0625;
  plan.gap.threshold_m = 0.0625;
  const TrialRow at = CompareTrial(plan, {}, candidate, reference);
  CHECK(at.comparison.gap_m == 0.0625);
  CHECK_FALSE(at.falsified);
  CHECK(at.evidence.candidate_limits->decisions == 3);
  CHECK_FALSE(at.evidence.reference_limits);
  CHECK(at.evidence.errors_m.size() == 8);
  CHECK(at.evidence.errors_m[0].y() == Approx(-0.0625));
  CHECK(at.evidence.path_m[0].y() == Approx(0.0625F));
  plan.gap.threshold_m = std::nextafter(0.0625, 0.0);
  CHECK(CompareTrial(plan, {}, candidate, reference).falsified);
}

TEST_CASE("A position that is not finite, or a path that does not move, is a row that says so") {
  const Recording reference{.source = "path", .trajectory = test::StraightPath(0.7, 40)};
  for (double trajectory::StampedPose::*member :
       {&trajectory::StampedPose::x_m, &trajectory::StampedPose::y_m}) {
    Recording candidate{.source = "run", .trajectory = reference.trajectory};
    candidate.trajectory.poses[3].*member = std::numeric_limits<double>::infinity();
    const TrialRow row = CompareTrial({}, {}, candidate, reference);
    CHECK(row.status == TrialStatus::kNan);
    CHECK(row.reason == "run: a position is not finite");
  }
  Recording still{.source = "run", .trajectory = reference.trajectory};
  for (auto& pose : still.trajectory.poses) pose.x_m = 0.0;
  const TrialRow row = CompareTrial({}, {}, still, reference);
  CHECK(row.status == TrialStatus::kUnreadable);
  CHECK_THAT(row.reason, Catch::StartsWith("run against path: "));
}

TEST_CASE("Short of the goal and within its reach a gap at the end does not count") {
  experiment::Experiment plan;
  plan.waypoints = {{.name = "s"}, {.name = "e", .x_m = 1.0}};
  plan.control.reach_radius_m = 0.1;
  const Recording reference{.source = "path", .trajectory = test::StraightPath(1.0, 101)};
  const Recording candidate{.source = "run", .trajectory = test::StraightPath(0.91, 101)};
  const TrialRow row = CompareTrial(plan, {}, candidate, reference);
  CHECK(row.comparison.gap_m == Approx(0.09));
  CHECK(row.way_gap_m == Approx(0.0).margin(1e-9));
  CHECK_FALSE(row.falsified);
  plan.falsify.count.stop = true;
  const TrialRow strict = CompareTrial(plan, {}, candidate, reference);
  CHECK(std::isnan(strict.way_gap_m));
  CHECK(strict.falsified);
}

}  // namespace
}  // namespace rift::sweep
