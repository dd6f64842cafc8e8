#include "rift/sweep/falsify/settings.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

namespace rift::sweep {
namespace {

using experiment::CandidateKind;

experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.name = "plan";
  plan.seed = 40;
  plan.reference.trials.names = {"a", "b", "c"};
  plan.space.parameters = {{.key = "control.v_min", .min = 0.1, .max = 0.3},
                           {.key = "control.v_max", .levels = {{"0.3", 0.3}, {"0.4", 0.4}}}};
  return plan;
}

const experiment::Theta kTheta{{"0.2", 0.2}, {"0.4", 0.4}};

TEST_CASE("Trials of a setting take the names in turn and count up the seed of the experiment") {
  const experiment::Experiment plan = Plan();
  const std::vector<TrialRequest> first = TrialsAt(plan, kTheta);
  REQUIRE(first.size() == 3);
  const std::vector<TrialRequest> more = FurtherTrials(plan, kTheta, TrialKind::kComparison, 3, 4);
  REQUIRE(more.size() == 4);
  const char* names[] = {"a", "b", "c"};
  for (size_t i = 0; i < 7; ++i) {
    const TrialRequest& request = i < 3 ? first[i] : more[i - 3];
    INFO(i);
    CHECK(request.trial == names[i % 3]);
    CHECK(request.seed == 40 + i);
    CHECK(request.theta == kTheta);
    CHECK_FALSE(request.is_random_draw);
  }
  CHECK(FurtherTrials(plan, kTheta, TrialKind::kComparison, 3, 0).empty());
}

TEST_CASE("Random draws have numbers of their own, counted up within a setting") {
  const experiment::Experiment plan = Plan();
  const auto draws = TrialsAt(plan, kTheta, TrialKind::kRandomDraw);
  const auto others = TrialsAt(plan, {{"0.25", 0.25}, {"0.4", 0.4}}, TrialKind::kRandomDraw);
  const auto written = TrialsAt(plan, {{"0.20", 0.2}, {".4", 0.4}}, TrialKind::kRandomDraw);
  CHECK(draws[0].is_random_draw);
  CHECK(*draws[1].seed == *draws[0].seed + 1);
  CHECK(*draws[2].seed == *draws[0].seed + 2);
  CHECK(*draws[0].seed != 40);
  CHECK(*others[0].seed != *draws[0].seed);
  CHECK(*written[0].seed == *draws[0].seed);
  const auto more = FurtherTrials(plan, kTheta, TrialKind::kRandomDraw, 3, 1);
  CHECK(*more[0].seed == *draws[0].seed + 3);
  experiment::Experiment another = plan;
  another.seed = 41;
  CHECK(*TrialsAt(another, kTheta, TrialKind::kRandomDraw)[0].seed != *draws[0].seed);
}

TEST_CASE("Logs have no seed, simulations and programs that of the experiment") {
  experiment::Experiment plan = Plan();
  CHECK(FirstSeed(plan) == 40u);
  plan.candidate.kind = CandidateKind::kProgram;
  CHECK(FirstSeed(plan) == 40u);
  plan.candidate.kind = CandidateKind::kLogs;
  CHECK_FALSE(FirstSeed(plan));
  for (const TrialRequest& request : TrialsAt(plan, kTheta)) CHECK_FALSE(request.seed);
}

TEST_CASE("Fresh seeds are short, and others for each seed and each stream") {
  std::set<std::uint64_t> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t stream = 1; stream <= 20; ++stream) {
      const std::uint64_t fresh = FreshSeed(seed, stream);
      CHECK(fresh < (1ULL << 31));
      CHECK(fresh == FreshSeed(seed, stream));
      seen.insert(fresh);
    }
  }
  CHECK(seen.size() == 400);
  CHECK(*seen.rbegin() > (1ULL << 30));  // ten digits at most, and not fewer bits than that
}

TEST_CASE("A grid asks for every trial of each setting before the next setting") {
  const std::vector<TrialRequest> trials =
      GridTrials({{.key = "x", .levels = {{"1", 1.0}, {"2", 2.0}}}}, {"p", "q"});
  REQUIRE(trials.size() == 4);
  const char* expected[][2] = {{"1", "p"}, {"1", "q"}, {"2", "p"}, {"2", "q"}};
  for (size_t i = 0; i < 4; ++i) {
    CHECK(trials[i].theta[0].text == expected[i][0]);
    CHECK(trials[i].trial == expected[i][1]);
    CHECK_FALSE(trials[i].seed);
  }
}

TEST_CASE("The key of a trial holds its setting, its repeat and its seed, 0 for none") {
  const std::vector<experiment::Parameter> parameters = Plan().space.parameters;
  CHECK(TrialKey(parameters, {.theta = kTheta, .trial = "b", .seed = 7}) ==
        "control.v_min=0.2 control.v_max=0.4 trial=b seed=7");
  CHECK(TrialKey(parameters, {.theta = kTheta, .trial = "b"}) ==
        "control.v_min=0.2 control.v_max=0.4 trial=b seed=0");
}

TEST_CASE("A text with a blank, an equals sign or a quote is quoted in a key, quotes doubled") {
  const std::vector<experiment::Parameter> one{{.key = "k"}};
  CHECK(SettingKey(one, {{"plain", {}}}) == "k=plain ");
  CHECK(SettingKey(one, {{"a b", {}}}) == "k=\"a b\" ");
  CHECK(SettingKey(one, {{"a=b", {}}}) == "k=\"a=b\" ");
  CHECK(SettingKey(one, {{"a\"b", {}}}) == "k=\"a\"\"b\" ");
}

TEST_CASE("Values are numbers in JSON where they are numbers") {
  CHECK(ValueJson({"0.30", 0.3}).dump() == "0.3");
  CHECK(ValueJson({"ground", {}}).dump() == "\"ground\"");
}

TEST_CASE("A point of a search stays within the range, rounded for whole numbers") {
  const std::vector<experiment::Parameter> space{
      {.key = "plain", .min = -1.0, .max = 2.0},
      {.key = "log", .min = 0.1, .max = 10.0, .is_logarithmic = true},
      {.key = "whole", .min = 2.0, .max = 5.0, .is_integer = true}};
  const experiment::Theta low = ThetaAt(space, {-1.0, std::log(0.1), 2.0});
  CHECK(*low[0].number == -1.0);
  CHECK(*low[1].number == Approx(0.1));
  CHECK(*low[1].number >= 0.1);
  CHECK(*low[2].number == 2.0);
  const experiment::Theta high = ThetaAt(space, {2.0, std::log(10.0), 5.0});
  CHECK(*high[0].number == 2.0);
  CHECK(*high[1].number == Approx(10.0));
  CHECK(*high[1].number <= 10.0);
  CHECK(*high[2].number == 5.0);
  const experiment::Theta beyond = ThetaAt(space, {7.0, 9.0, -3.0});
  CHECK(*beyond[0].number == 2.0);
  CHECK(*beyond[1].number == 10.0);
  CHECK(*beyond[2].number == 2.0);
  CHECK(*ThetaAt(space, {0.0, 0.0, 3.6})[1].number == 1.0);
  CHECK(ThetaAt(space, {0.0, 0.0, 3.6})[2].text == "4");
  CHECK(ThetaAt(space, {0.0, 0.0, 3.4})[2].text == "3");
}

TEST_CASE("Axes of a search have the names, kinds and ends of their parameters") {
  const std::vector<search::Axis> axes =
      AxesOf({{.key = "a.plain", .min = -1.0, .max = 2.0},
              {.key = "a.log", .min = 0.1, .max = 10.0, .is_logarithmic = true},
              {.key = "a.whole", .min = 2.0, .max = 5.0, .is_integer = true},
              {.key = "a.words", .levels = {{"x", {}}, {"y", {}}, {"z", {}}}},
              {.key = "a.ranks", .levels = {{"3", 3.0}, {"1", 1.0}}}});
  REQUIRE(axes.size() == 5);
  CHECK(axes[0].name == "a.plain");
  CHECK(axes[0].min == -1.0);
  CHECK(axes[0].max == 2.0);
  CHECK(axes[1].kind == search::AxisKind::kContinuous);
  CHECK(axes[1].min == Approx(-2.302585093));
  CHECK(axes[1].max == Approx(2.302585093));
  CHECK(axes[2].kind == search::AxisKind::kInteger);
  CHECK(axes[2].min == 2.0);
  CHECK(axes[2].max == 5.0);
  CHECK(axes[3].kind == search::AxisKind::kCategorical);
  CHECK(axes[3].min == 0.0);
  CHECK(axes[3].max == 2.0);
  CHECK(axes[4].kind == search::AxisKind::kInteger);
  CHECK(axes[4].max == 1.0);
}

TEST_CASE("Only a simulated run has the experiment at its setting") {
  experiment::Experiment plan = Plan();
  CHECK(ExperimentFor(plan, {.theta = kTheta}).control.v_min == 0.2);
  CHECK(ExperimentFor(plan, {.theta = kTheta}).control.v_max == 0.4);
  plan.candidate.kind = CandidateKind::kLogs;
  CHECK(ExperimentFor(plan, {.theta = kTheta}).control.v_min == plan.control.v_min);
  plan.candidate.kind = CandidateKind::kProgram;
  CHECK(ExperimentFor(plan, {.theta = kTheta}).control.v_min == plan.control.v_min);
}

TEST_CASE("The controller of a log takes numbers under its keys, with and without their block") {
  experiment::Experiment plan = Plan();
  plan.candidate.kind = CandidateKind::kLogs;
  plan.control.v_min = 0.11;
  plan.space.parameters = {{.key = "v_max", .levels = {{"0.35", 0.35}}},
                           {.key = "control.reach_radius_m", .levels = {{"0.07", 0.07}}},
                           {.key = "surface.v_min", .levels = {{"0.2", 0.2}}},
                           {.key = "v_min", .levels = {{"slow", {}}}}};
  const control::NavigatorOptions control =
      ControllerFor(plan, {.theta = {{"0.35", 0.35}, {"0.07", 0.07}, {"0.2", 0.2}, {"slow", {}}}});
  CHECK(control.v_max == 0.35);
  CHECK(control.reach_radius_m == 0.07);
  CHECK(control.v_min == 0.11);
}

TEST_CASE("A goal is the last waypoint of a task of several, within reach of the setting") {
  experiment::Experiment plan = Plan();
  plan.control.reach_radius_m = 0.04;
  plan.space.parameters = {{.key = "control.reach_radius_m", .min = 0.01, .max = 0.1}};
  const TrialRow row{.theta = {{"0.08", 0.08}}, .trial = "a"};
  plan.waypoints = {{.name = "s", .x_m = 9.0}, {.name = "e", .x_m = 0.5, .y_m = -0.3}};
  const std::optional<gap::Goal> goal = WayGoalOf(plan, row);
  REQUIRE(goal);
  CHECK(goal->position_m == Eigen::Vector2d(0.5, -0.3));
  CHECK(goal->radius_m == 0.08);
  experiment::Experiment stops = plan;
  stops.falsify.count.stop = true;
  CHECK_FALSE(WayGoalOf(stops, row));
  experiment::Experiment wheels = plan;
  wheels.objective = experiment::Objective::kOdometry;
  CHECK_FALSE(WayGoalOf(wheels, row));
  experiment::Experiment program = plan;
  program.program.segments = {{.straight_m = 0.5}};
  CHECK_FALSE(WayGoalOf(program, row));
  plan.waypoints.pop_back();
  CHECK_FALSE(WayGoalOf(plan, row));
}

TEST_CASE("The nominal request is the first trial at the experiment's own values") {
  experiment::Experiment plan = Plan();
  plan.control.v_min = 0.17;
  const TrialRequest request = NominalRequest(plan, 12);
  CHECK(request.trial == "a");
  CHECK(request.seed == 12u);
  REQUIRE(request.theta.size() == 2);
  CHECK(*request.theta[0].number == 0.17);
  CHECK_FALSE(NominalRequest(plan).seed);
}

TEST_CASE("An empty result has the head of its experiment") {
  experiment::Experiment plan = Plan();
  plan.candidate.kind = CandidateKind::kProgram;
  plan.reference.kind = experiment::ReferenceKind::kNominal;
  plan.reference.tag_offset_m = 0.03;
  plan.gap.threshold_m = 0.07;
  plan.falsify.share = 0.2;
  const SweepResult result = EmptyResult(plan);
  CHECK(result.name == "plan");
  CHECK(result.candidate_kind == "program");
  CHECK(result.reference_kind == "nominal");
  CHECK(result.gap.threshold_m == 0.07);
  CHECK(result.judged_by.share == 0.2);
  CHECK(result.tag_offset_m == 0.03);
  CHECK(result.parameters.size() == 2);
  CHECK(result.rows.empty());
}

TEST_CASE("The tag of a simulated robot is where its setting and its draw have it") {
  experiment::Experiment plan = Plan();
  plan.simulation.mocap.tag_ahead_m = 0.03;
  CHECK(TagAhead_m(plan, {.theta = kTheta}) == 0.03);
  plan.space.parameters = {{.key = "simulation.mocap.tag_ahead_m", .min = -0.1, .max = 0.1}};
  CHECK(TagAhead_m(plan, {.theta = {{"-0.07", -0.07}}}) == -0.07);
  plan.space.parameters.clear();
  plan.ensemble = {{"simulation.mocap.tag_ahead_m"}, {{0.01}, {0.02}}};
  std::set<double> of_seeds;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    of_seeds.insert(TagAhead_m(plan, {.seed = seed}));
    experiment::Experiment own = plan;
    own.seed = seed;  // of a trial without a seed
    CHECK(TagAhead_m(own, {}) == TagAhead_m(plan, {.seed = seed}));
  }
  CHECK(of_seeds == std::set<double>{0.01, 0.02});
  for (const CandidateKind kind : {CandidateKind::kLogs, CandidateKind::kProgram}) {
    plan.candidate.kind = kind;
    CHECK(TagAhead_m(plan, {.seed = 1}) == 0.0);
  }
}

TEST_CASE("Settings are the same where each value is, however its number is written") {
  CHECK(IsSameSetting({{"0.20", 0.2}, {"ice", {}}}, {{"0.2", 0.2}, {"ice", {}}}));
  CHECK_FALSE(IsSameSetting({{"0.2", 0.2}, {"ice", {}}}, {{"0.2", 0.2}, {"rock", {}}}));
  CHECK_FALSE(IsSameSetting({{"0.2", 0.2}, {"ice", {}}}, {{"0.3", 0.3}, {"ice", {}}}));
  CHECK_FALSE(IsSameSetting({{"0.2", 0.2}}, {{"0.2", 0.2}, {"ice", {}}}));
  CHECK_FALSE(IsSameSetting({{"0.2", 0.2}, {"ice", {}}}, {{"0.2", 0.2}}));
  CHECK(IsSameSetting({}, {}));
}

TEST_CASE("The levels of numbers are ranked by their values, and words stay in their order") {
  const std::vector<experiment::Parameter> space{
      {.key = "numbers", .levels = {{"10", 10.0}, {"9", 9.0}, {"-2", -2.0}, {"0.5", 0.5}}},
      {.key = "words", .levels = {{"z", {}}, {"a", {}}, {"7", 7.0}}}};
  const auto at = [&](double number, double word) {
    const experiment::Theta theta = ThetaAt(space, {number, word});
    return theta[0].text + " " + theta[1].text;
  };
  CHECK(at(0.0, 0.0) == "-2 z");
  CHECK(at(1.0, 1.0) == "0.5 a");
  CHECK(at(2.0, 2.0) == "9 7");
  CHECK(at(3.0, 0.0) == "10 z");
  const std::vector<search::Axis> axes = AxesOf(space);
  CHECK(axes[0].kind == search::AxisKind::kInteger);
  CHECK(axes[0].max == 3.0);
  CHECK(axes[1].kind == search::AxisKind::kCategorical);
  CHECK(axes[1].max == 2.0);
}

}  // namespace
}  // namespace rift::sweep
