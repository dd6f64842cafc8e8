#include "rift/sweep/log_sweep.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "rift/sweep/grid.hpp"
#include "rift/sweep/path_template.hpp"
#include "support/paths.hpp"

namespace rift::sweep {
namespace {

const std::vector<Parameter> kParameters{
    {.key = "surface", .levels = {{"ground", {}}, {"ice", {}}}},
    {.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.2", 0.2}}}};

LogSweepPlan Plan() {
  return {.name = "test",
          .parameters = kParameters,
          .trials = {"1", "2"},
          .candidate_path = "{surface}/{v_min:.2f}_sim.csv",
          .reference_path = "{surface}/{v_min:.2f}_real{trial}.csv",
          .gap = {}};
}

/// The real path lies beside the simulated one: 0.05 m in trial 1, 0.08 m in trial 2.
LoadedLog Logs(const std::string& path, Side side) {
  LoadedLog log;
  log.trajectory = test::StraightPath(0.7, 40);
  if (side == Side::kReference) {
    const double offset_m = path.find("real1") != path.npos ? 0.05 : 0.08;
    log.trajectory = test::Moved(log.trajectory, {0.0, offset_m, 0.0});
  }
  return log;
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
  const std::vector<ParameterValue> theta{{"ground", {}}, {"0.2", 0.2}};
  CHECK(FillTemplate("a/{surface}/v{v_min:.2f}_{v_min}_{trial}.csv", kParameters, theta, "3") ==
        "a/ground/v0.20_0.2_3.csv");
  CHECK(FillTemplate("{trial:03d}", kParameters, theta, "3") == "003");
  CHECK(FillTemplate("plain.csv", kParameters, theta, "3") == "plain.csv");
}

TEST_CASE("A path template that cannot be filled in is refused with the reason") {
  const std::vector<ParameterValue> theta{{"ground", {}}, {"0.2", 0.2}};
  const auto fill = [&](const std::string& text) {
    return Refusal([&] { FillTemplate(text, kParameters, theta, "3"); });
  };
  CHECK(fill("{vmin}.csv") ==
        "path '{vmin}.csv' names {vmin}, and the space has only surface, v_min, trial");
  CHECK(fill("{surface.csv") == "path '{surface.csv' has a brace without its partner");
  CHECK(fill("surface}.csv") == "path 'surface}.csv' has a brace without its partner");
  CHECK(fill("{surface:.2f}.csv").starts_with("path '{surface:.2f}.csv' cannot be filled in"));
  CHECK(fill("{v_min:03d}.csv").starts_with("path '{v_min:03d}.csv' cannot be filled in"));
}

TEST_CASE("A grid visits every combination once with the first parameter slowest") {
  const auto points = GridPoints(kParameters);
  REQUIRE(points.size() == 4);
  CHECK(points[1][0].text == "ground");
  CHECK(points[1][1].text == "0.2");
  CHECK(points[2][0].text == "ice");
  CHECK(GridPoints({}).size() == 1);
  CHECK(Refusal([] { GridPoints({{.key = "a.b", .min = 0.0, .max = 1.0}}); }) ==
        "space.a.b is a range, and a grid needs the values to visit: write a list");
}

TEST_CASE("Every trial of every setting is a row with its gap") {
  const SweepResult result = CompareLogs(Plan(), Logs);
  REQUIRE(result.rows.size() == 8);
  CHECK(result.rows[2].candidate == "ground/0.20_sim.csv");
  CHECK(result.rows[3].reference == "ground/0.20_real2.csv");
  CHECK(result.rows[0].comparison.gap_m == Approx(0.05));
  CHECK_FALSE(result.rows[0].falsified);
  CHECK(result.rows[1].comparison.gap_m == Approx(0.08));
  CHECK(result.rows[1].falsified);
  REQUIRE(result.settings.size() == 4);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kUndecided);
  CHECK(result.settings[0].noise_floor_m == Approx(0.03));
}

TEST_CASE("A missing log is a row with its status and not a smaller table") {
  const auto source = [](const std::string& path, Side side) {
    if (path == "ice/0.15_real2.csv") return LoadedLog{TrialStatus::kMissing, "no such file", {}};
    return Logs(path, side);
  };
  const SweepResult result = CompareLogs(Plan(), source);
  REQUIRE(result.rows.size() == 8);
  CHECK(result.rows[5].status == TrialStatus::kMissing);
  CHECK(result.rows[5].reason == "ice/0.15_real2.csv: no such file");
  CHECK(result.all.n == 7);
  CHECK(result.all.not_ok == 1);
  CHECK(std::isnan(result.settings[2].noise_floor_m));
}

TEST_CASE("A parameter that no path names is refused") {
  LogSweepPlan plan = Plan();
  plan.parameters.push_back({.key = "v_max", .levels = {{"0.3", 0.3}}});
  CHECK(Refusal([&] { CompareLogs(plan, Logs); }) ==
        "space.v_max is named in neither candidate.path nor reference.path as {v_max}");
  plan = Plan();
  plan.reference_path = "{surface}/{v_min}.csv";
  CHECK(Refusal([&] { CompareLogs(plan, Logs); }) ==
        "reference.trials asks for repeats, and no path names {trial} to tell them apart");
}

}  // namespace
}  // namespace rift::sweep
