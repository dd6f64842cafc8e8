#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/sweep.hpp"

#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "support/inputs/paths.hpp"
#include "sweep/falsify/experiment_sides.hpp"

namespace rift::sweep {
namespace {

const std::vector<experiment::Parameter> kParameters{
    {.key = "surface", .levels = {{"ground", {}}, {"ice", {}}}},
    {.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.2", 0.2}}}};

experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.name = "test";
  plan.candidate.kind = experiment::CandidateKind::kLogs;
  plan.space.parameters = kParameters;
  plan.reference.trials.names = {"1", "2"};
  return plan;
}

experiment::Experiment WithPaths(experiment::Experiment plan, const std::string& candidate,
                                 const std::string& reference) {
  plan.candidate.path.text = candidate;
  plan.reference.path.text = reference;
  return plan;
}

Recording Simulated(const TrialRequest&, const Recording&) {
  return {.source = "simulator", .trajectory = test::StraightPath(0.7, 40)};
}

/// The real path lies beside the simulated one: 0.05 m in trial 1, 0.08 m in trial 2.
Recording Real(const TrialRequest& request) {
  const double offset_m = request.trial == "1" ? 0.05 : 0.08;
  return {.source = request.theta[0].text + "/" + request.theta[1].text + "_" + request.trial,
          .trajectory = test::Moved(test::StraightPath(0.7, 40), {0.0, offset_m, 0.0})};
}

template <class Candidate, class Reference>
SweepResult CompareGrid(const experiment::Experiment& plan, const Candidate& candidate,
                        const Reference& reference) {
  const auto evaluate = [&](const TrialRequest& request) {
    const Recording real = reference(request);
    return CompareTrial(plan, request, candidate(request, real), real);
  };
  return *SweepGrid(plan, RunHere(evaluate, {}));
}

template <class Call>
std::string Refusal(const Call& call) {
  try {
    call();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST_CASE("A path template is filled in with values as written or as specified") {
  const experiment::Theta theta{{"ground", {}}, {"0.2", 0.2}};
  CHECK(experiment::FillTemplate("a/{surface}/v{v_min:.2f}_{v_min}_{trial}.csv", kParameters, theta,
                                 "3") == "a/ground/v0.20_0.2_3.csv");
  CHECK(experiment::FillTemplate("{trial:03d}", kParameters, theta, "3") == "003");
  CHECK(experiment::FillTemplate("plain.csv", kParameters, theta, "3") == "plain.csv");
}

TEST_CASE("A path template that cannot be filled in is refused with the reason") {
  const experiment::Theta theta{{"ground", {}}, {"0.2", 0.2}};
  const auto fill = [&](const std::string& text) {
    return Refusal([&] { experiment::FillTemplate(text, kParameters, theta, "3"); });
  };
  CHECK(fill("{vmin}.csv") ==
        "path '{vmin}.csv' names {vmin}, and the space has only surface, v_min, trial");
  CHECK(fill("{surface.csv") == "path '{surface.csv' has a brace without its partner");
  CHECK(fill("surface}.csv") == "path 'surface}.csv' has a brace without its partner");
  CHECK(fill("{v_min:.2f}{surface:.2f}.csv") ==
        "path '{v_min:.2f}{surface:.2f}.csv' cannot be filled in: {surface:.2f} does not fit "
        "'ground'");
  CHECK(fill("{v_min:03d}.csv") ==
        "path '{v_min:03d}.csv' cannot be filled in: {v_min:03d} does not fit '0.2'");
}

TEST_CASE("A grid visits every combination once with the first parameter slowest") {
  const auto points = experiment::GridPoints(kParameters);
  REQUIRE(points.size() == 4);
  CHECK(points[1][0].text == "ground");
  CHECK(points[1][1].text == "0.2");
  CHECK(points[2][0].text == "ice");
  CHECK(experiment::GridPoints({}).size() == 1);
  CHECK(Refusal([] {
          experiment::GridPoints({{.key = "a.b", .min = 0.0, .max = 1.0, .origin = "e.yaml:2:3"}});
        }) ==
        "e.yaml:2:3: space.a.b is a range, and a grid needs the values to visit: write a "
        "list, or set goal: falsify");
}

TEST_CASE("Every trial of every setting is a row with its gap") {
  const SweepResult result = CompareGrid(Plan(), Simulated, Real);
  REQUIRE(result.rows.size() == 8);
  CHECK(result.rows[2].candidate == "simulator");
  CHECK(result.rows[3].reference == "ground/0.2_2");
  CHECK(result.rows[0].comparison.gap_m == Approx(0.05));
  CHECK_FALSE(result.rows[0].falsified);
  CHECK(result.rows[1].comparison.gap_m == Approx(0.08));
  CHECK(result.rows[1].falsified);
  REQUIRE(result.settings.size() == 4);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kUndecided);
}

TEST_CASE("A trial without a trajectory is a row with its status and not a smaller table") {
  const auto reference = [](const TrialRequest& request) {
    Recording real = Real(request);
    if (real.source == "ice/0.15_2")
      real = {TrialStatus::kMissing, "no such file", real.source, {}};
    return real;
  };
  const auto candidate = [](const TrialRequest& request, const Recording& real) {
    Recording simulated = Simulated(request, real);
    if (real.source == "ice/0.2_1") simulated.status = TrialStatus::kFell;
    return simulated;
  };
  const SweepResult result = CompareGrid(Plan(), candidate, reference);
  REQUIRE(result.rows.size() == 8);
  CHECK(result.rows[5].status == TrialStatus::kMissing);
  CHECK(result.rows[5].reason == "ice/0.15_2: no such file");
  CHECK(result.rows[6].status == TrialStatus::kFell);
  CHECK(result.all.n == 6);
  CHECK(result.all.not_ok == 2);
}

TEST_CASE("A candidate can start where its reference did") {
  const auto follower = [](const TrialRequest&, const Recording& real) {
    return Recording{.source = "follower", .trajectory = real.trajectory};
  };
  CHECK(CompareGrid(Plan(), follower, Real).all.mean_gap_m == 0.0);
}

TEST_CASE("Two settings that name the same logs are refused") {
  experiment::Experiment plan = Plan();
  plan.space.parameters[1].levels = {{"0.15", 0.15}, {"0.151", 0.151}};
  CHECK(Refusal([&] {
          CheckPaths(WithPaths(plan, "{surface}/{v_min:.2f}_sim.csv",
                               "{surface}/{v_min:.2f}_{trial}.csv"));
        }) ==
        "two settings name the same logs, surface ground, v_min 0.15 and surface ground, v_min "
        "0.151: give the path templates more digits (ground/0.15_1.csv)");
  CHECK_NOTHROW(CheckPaths(
      WithPaths(plan, "{surface}/{v_min:.2f}_sim.csv", "{surface}/{v_min}_{trial}.csv")));
}

TEST_CASE("A parameter that no path names is refused") {
  const std::string candidate = "{surface}/{v_min}_sim.csv";
  const std::string reference = "{surface}/{v_min}_{trial}.csv";
  CHECK_NOTHROW(CheckPaths(WithPaths(Plan(), candidate, reference)));
  experiment::Experiment plan = Plan();
  plan.space.parameters.push_back({.key = "v_max", .levels = {{"0.3", 0.3}}});
  CHECK(Refusal([&] { CheckPaths(WithPaths(plan, candidate, reference)); }) ==
        "space.v_max is in neither candidate.path nor reference.path as {v_max}: they name "
        "{surface}, {trial}, {v_min}");
  CHECK(Refusal([&] { CheckPaths(WithPaths(Plan(), candidate, "{surface}/{v_min}.csv")); }) ==
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
}

}  // namespace
}  // namespace rift::sweep
