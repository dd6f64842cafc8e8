#include "rift/sweep/falsify/falsify.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "rift/sweep/falsify/search_space.hpp"

namespace rift::sweep {
namespace {

const std::vector<experiment::Parameter> kSpace{
    {.key = "control.v_min", .min = 0.0, .max = 1.0},
    {.key = "simulation.mass_kg", .min = 0.01, .max = 1.0, .is_logarithmic = true},
    {.key = "trial.count", .min = 1.0, .max = 9.0, .is_integer = true},
    {.key = "control.order", .levels = {{"0.5", 0.5}, {"0.1", 0.1}, {"0.3", 0.3}}},
    {.key = "surface", .levels = {{"ground", {}}, {"ice", {}}}}};

experiment::Experiment Plan(const SearchPlan& search = {}, const FalsifyOptions& options = {}) {
  experiment::Experiment plan;
  plan.name = "test";
  plan.goal = experiment::Goal::kFalsify;
  plan.space.parameters = kSpace;
  plan.search = search;
  plan.falsify = options;
  return plan;
}

/// Fails on ice at a high v_min, by a margin above the noise only near the corner.
TrialRow Simulated(const TrialRequest& request) {
  TrialRow row{.theta = request.theta,
               .trial = request.trial,
               .seed = request.seed,
               .is_random_draw = request.is_random_draw};
  const double noise_m = 0.001 * static_cast<double>(*request.seed % 3);
  const double v_min = *request.theta[0].number;
  row.comparison.gap_m = (request.theta[4].text == "ice" ? 0.08 : 0.02) * v_min + noise_m;
  row.falsified = row.comparison.gap_m > 0.06;
  if (v_min > 0.99) {
    row = {.theta = request.theta, .trial = request.trial, .seed = request.seed};
    row.status = TrialStatus::kFell;
  }
  return row;
}

std::optional<SweepResult> Search(const SearchPlan& search, const FalsifyOptions& options = {},
                                  const Watch& watch = {}) {
  return Falsify(Plan(search, options), RunHere(Simulated, watch),
                 [](const auto&) { return true; });
}

SearchPlan Budget(int budget, search::Method method = search::Method::kPortfolio) {
  SearchPlan plan;
  plan.budget = budget;
  plan.strategy = method;
  return plan;
}

TEST_CASE("Every kind of parameter becomes an axis and its values come back") {
  const std::vector<search::Axis> axes = AxesOf(kSpace);
  REQUIRE(axes.size() == 5);
  CHECK(axes[0].kind == search::AxisKind::kContinuous);
  CHECK(axes[1].min == Approx(std::log(0.01)));
  CHECK(axes[2].kind == search::AxisKind::kInteger);
  CHECK(axes[3].kind == search::AxisKind::kInteger);
  CHECK(axes[3].max == 2.0);
  CHECK(axes[4].kind == search::AxisKind::kCategorical);
  const experiment::Theta theta = ThetaAt(kSpace, {0.25, std::log(1.0), 4.0, 1.0, 1.0});
  CHECK(theta[0].text == "0.25");
  CHECK(theta[1].text == "1");
  CHECK(theta[2].text == "4");
  CHECK(theta[3].text == "0.3");  // of numbers the rank counts, not the place in the list
  CHECK(theta[4].text == "ice");
}

TEST_CASE("A search finds a failure and stops at the first that is sure") {
  const std::optional<SweepResult> result = Search(Budget(500));
  REQUIRE(result);
  const Falsification& found = *result->falsification;
  CHECK(found.verdict == gap::Verdict::kFalsified);
  CHECK(found.evaluations < 500);
  CHECK(found.ended == "the first hit");
  REQUIRE(found.worst_setting);
  const SettingResult& worst = result->settings[*found.worst_setting];
  CHECK(worst.theta[4].text == "ice");
  CHECK(worst.mean_gap_m > 0.06);
  CHECK(worst.rows.size() == 6);  // repeated until it is sure
  std::set<std::uint64_t> seeds;
  for (const int row : worst.rows) seeds.insert(*result->rows[row].seed);
  CHECK(seeds == std::set<std::uint64_t>{1, 2, 3, 4, 5, 6});
  // Far from the threshold one trial is enough.
  CHECK(result->settings.front().rows.size() <= 6);
  CHECK(result->rows.size() < 6 * result->settings.size());
}

TEST_CASE("A search maps all failures when asked and spends its budget") {
  FalsifyOptions options;
  options.until = Until::kBudget;
  const std::optional<SweepResult> result = Search(Budget(200), options);
  REQUIRE(result);
  CHECK(result->falsification->evaluations == 200);
  CHECK(result->falsification->ended == "the budget");
  CHECK(result->falsification->falsified > 1);
  CHECK(result->settings.size() == 200);
}

TEST_CASE("The same seed gives the same search and its rows say when they are random draws") {
  const SweepResult a = *Search(Budget(60)), b = *Search(Budget(60));
  REQUIRE(a.rows.size() == b.rows.size());
  for (size_t i = 0; i < a.rows.size(); ++i) CHECK(a.rows[i].theta == b.rows[i].theta);
  CHECK_FALSE(a.rows[0].is_random_draw);
  CHECK((*Search(Budget(10, search::Method::kRandom))).rows[0].is_random_draw);
}

TEST_CASE("Time that is up ends a search before the next batch") {
  int batches = 0;
  const std::optional<SweepResult> result =
      Falsify(Plan(Budget(500, search::Method::kRandom), {.until = Until::kBudget}),
              RunHere(Simulated, {}), [&](const auto&) { return ++batches <= 2; });
  REQUIRE(result);
  CHECK(result->falsification->ended == "the time");
  CHECK(result->falsification->evaluations == 16);
}

TEST_CASE("A verdict needs enough repeats that agree") {
  std::vector<TrialRow> rows(6);
  for (TrialRow& row : rows) row.falsified = true;
  CHECK(JudgeSetting(rows, {}) == gap::Verdict::kFalsified);
  CHECK(JudgeSetting(std::span(rows).first(5), {}) == gap::Verdict::kUndecided);
  CHECK(JudgeSetting(std::span(rows).first(5), {.confidence = 0.9}) == gap::Verdict::kFalsified);
  rows[0].falsified = false;
  CHECK(JudgeSetting(rows, {}) == gap::Verdict::kUndecided);
  for (TrialRow& row : rows) row.falsified = false;
  CHECK(JudgeSetting(rows, {}) == gap::Verdict::kNotFalsified);
  for (TrialRow& row : rows) row.status = TrialStatus::kCrashed;
  CHECK(JudgeSetting(rows, {}) == gap::Verdict::kUndecided);
}

TEST_CASE("As many failing trials falsify as are said to be needed") {
  for (const double share : {0.0, 0.1, 0.5, 0.9}) {
    for (const double confidence : {0.8, 0.95, 0.99}) {
      const FalsifyOptions options{.share = share, .confidence = confidence};
      std::vector<TrialRow> rows(static_cast<size_t>(TrialsToFalsify(options)));
      for (TrialRow& row : rows) row.falsified = true;
      CHECK(JudgeSetting(rows, options) == gap::Verdict::kFalsified);
      rows.pop_back();
      CHECK(JudgeSetting(rows, options) == gap::Verdict::kUndecided);
    }
  }
  CHECK(TrialsToFalsify({}) == 6.0);
  CHECK(std::isinf(TrialsToFalsify({.share = 1.0})));
}

TEST_CASE("Settings carry the verdicts that the search counts") {
  FalsifyOptions options{.until = Until::kBudget, .most_repeats = 8, .confidence = 0.8};
  const SweepResult result = *Search(Budget(120), options);
  int falsified = 0, undecided = 0;
  for (const SettingResult& setting : result.settings) {
    CHECK(setting.verdict.confidence == 0.8);
    falsified += setting.verdict.verdict == gap::Verdict::kFalsified;
    undecided += setting.verdict.verdict == gap::Verdict::kUndecided && setting.verdict.above > 0;
    if (setting.verdict.above == 0 && setting.verdict.repeats > 0) {
      CHECK(setting.verdict.verdict == gap::Verdict::kNotFalsified);
    }
  }
  CHECK(falsified == result.falsification->falsified);
  CHECK(undecided == result.falsification->undecided);
  CHECK(falsified > 0);
}

TEST_CASE("A fall tells only where falls count") {
  TrialRow fall;
  fall.status = TrialStatus::kFell;
  CHECK(std::isnan(Robustness_m(std::span(&fall, 1), 0.06)));
  fall.falsified = true;
  CHECK(Robustness_m(std::span(&fall, 1), 0.06) == Approx(-0.06));
}

TEST_CASE("A search over logs or over nothing is refused") {
  experiment::Experiment plan = Plan(Budget(10));
  const auto refusal = [&]() -> std::string {
    try {
      Falsify(plan, RunHere(Simulated, {}), [](const auto&) { return true; });
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "accepted";
  };
  plan.candidate.kind = experiment::CandidateKind::kLogs;
  CHECK(refusal().find("only simulated trials") != std::string::npos);
  plan = Plan(Budget(10));
  plan.space.parameters.clear();
  CHECK(refusal().find("no parameters") != std::string::npos);
}

}  // namespace
}  // namespace rift::sweep
