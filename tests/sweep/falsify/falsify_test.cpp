#include "rift/sweep/falsify/falsify.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "rift/statistics/random.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/sweep/falsify/verdict.hpp"

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
  const size_t needed = static_cast<size_t>(TrialsToFalsify({}, 500));
  CHECK(worst.rows.size() == needed);  // all of them fail, and it stops as soon as it is sure
  std::set<std::uint64_t> seeds;
  for (const int row : worst.rows) seeds.insert(*result->rows[row].seed);
  CHECK(seeds.size() == needed);
  CHECK(*seeds.rbegin() == needed);
  CHECK(result->rows.size() < needed * result->settings.size());
}

TEST_CASE("A search maps all failures when asked and spends its budget") {
  FalsifyOptions options;
  options.until = Until::kBudget;
  const std::optional<SweepResult> result = Search(Budget(200), options);
  REQUIRE(result);
  CHECK(result->falsification->evaluations == 200);
  CHECK(result->falsification->ended == "the budget");
  CHECK(result->Count(gap::Verdict::kFalsified) > 1);
  CHECK(result->settings.size() == 200);
}

TEST_CASE("The same seed gives the same search and its rows say when they are random draws") {
  const SweepResult a = *Search(Budget(60)), b = *Search(Budget(60));
  REQUIRE(a.rows.size() == b.rows.size());
  for (size_t i = 0; i < a.rows.size(); ++i) CHECK(a.rows[i].theta == b.rows[i].theta);
  CHECK_FALSE(a.rows[0].is_random_draw);
  CHECK((*Search(Budget(10, search::Method::kRandom))).rows[0].is_random_draw);
}

TEST_CASE("Time that is up ends a search before the next trials") {
  int asked = 0;  // for the first batch, for its repeats, and no more
  const std::optional<SweepResult> result =
      Falsify(Plan(Budget(500, search::Method::kRandom), {.until = Until::kBudget}),
              RunHere(Simulated, {}), [&](const auto&) { return ++asked <= 2; });
  REQUIRE(result);
  CHECK(result->falsification->ended == "the time");
  CHECK(result->falsification->evaluations == 8);
}

std::vector<TrialRow> Rows(int failing, int passing) {
  std::vector<TrialRow> rows(static_cast<size_t>(failing + passing));
  for (int i = 0; i < failing; ++i) rows[static_cast<size_t>(i)].falsified = true;
  for (size_t i = 0; i < rows.size(); ++i) rows[i].seed = i;
  return rows;
}

TEST_CASE("Trials that do not tell have no vote") {
  std::vector<TrialRow> rows = Rows(3, 2);
  rows[0].status = TrialStatus::kFell;  // a failure that counts
  rows[4].status = TrialStatus::kCrashed;
  const gap::RepeatVerdict verdict = CountFailures(rows, {});
  CHECK(verdict.above == 3);
  CHECK(verdict.repeats == 4);
}

TEST_CASE("As many failing trials falsify as are said to be needed") {
  for (const double share : {0.01, 0.1, 0.5, 0.9}) {
    for (const int settings : {1, 500}) {
      const gap::VerdictOptions options{.share = share};
      const int needed = TrialsToFalsify(options, settings);
      std::vector<gap::RepeatVerdict> verdicts{CountFailures(Rows(needed, 0), options)};
      gap::JudgeTogether(verdicts, settings, options);
      CHECK(verdicts[0].verdict == gap::Verdict::kFalsified);
      verdicts[0] = CountFailures(Rows(needed - 1, 0), options);
      gap::JudgeTogether(verdicts, settings, options);
      CHECK(verdicts[0].verdict == gap::Verdict::kUndecided);
    }
  }
}

TEST_CASE("Identical runs count once and a setting without chance needs no more of them") {
  std::vector<TrialRow> rows = Rows(3, 0);
  for (TrialRow& row : rows) {
    row.comparison.gap_m = 0.07;
    row.evidence.fingerprint = 7;
  }
  CHECK(CountFailures(rows, {}).repeats == 1);
  CHECK(CountFailures(rows, {}).verdict == gap::Verdict::kFalsified);
  for (TrialRow& row : rows) row.falsified = false;
  CHECK(CountFailures(rows, {}).verdict == gap::Verdict::kPassed);
  for (TrialRow& row : rows) row.seed.reset();  // logs: one run, named several times
  CHECK(CountFailures(rows, {}).verdict == gap::Verdict::kNotSeenToFail);
  rows[2].comparison.gap_m = 0.05;  // the same run against another log
  CHECK(CountFailures(rows, {}).repeats == 2);
}

TEST_CASE("Settings carry the verdicts of a search that counts its whole budget") {
  FalsifyOptions options{.until = Until::kBudget};
  const SweepResult result = *Search(Budget(120), options);
  CHECK(result.judged_settings == 120);
  CHECK(result.Count(gap::Verdict::kFalsified) > 0);
  for (const SettingResult& setting : result.settings) {
    CHECK(setting.verdict.settings == 120);
    if (setting.verdict.above == 0 && setting.verdict.repeats > 0) {
      CHECK(setting.verdict.verdict == gap::Verdict::kNotSeenToFail);
    }
  }
  CHECK(result.falsification->verdict == gap::Verdict::kFalsified);
}

TEST_CASE("A run that does not arrive costs the more the further it was from the end") {
  TrialRow row;
  row.status = TrialStatus::kTimedOut;
  row.left_m = 0.3;
  CHECK(std::isnan(Robustness_m(std::span(&row, 1), 0.06)));  // where it does not count
  row.falsified = true;
  CHECK(Robustness_m(std::span(&row, 1), 0.06) == Approx(-0.3));
  row.left_m = 0.1;
  CHECK(Robustness_m(std::span(&row, 1), 0.06) == Approx(-0.1));
  row.left_m = gap::kNotComputed;
  CHECK(Robustness_m(std::span(&row, 1), 0.06) == Approx(-0.06));
}

/// The share of failures is the value of the only parameter.
RunTrials Planted() {
  return RunHere(
      [](const TrialRequest& request) {
        const double share = *request.theta[0].number;
        statistics::Random random(*request.seed, static_cast<std::uint64_t>(1e6 * share));
        TrialRow row{.theta = request.theta, .trial = request.trial, .seed = request.seed};
        row.falsified = random.Uniform() < share;
        row.comparison.gap_m = row.falsified ? 0.08 : 0.04;
        return row;
      },
      {});
}

TEST_CASE("Of 200 settings with known shares of failures few are judged wrongly or left open") {
  experiment::Experiment plan;
  experiment::Parameter shares{.key = "share"};
  for (int i = 0; i < 200; ++i) {
    shares.levels.push_back(experiment::NumberValue(0.02 + 0.96 * i / 199.0));
  }
  plan.space.parameters = {shares};
  plan.falsify.repeat = Repeat::kEvery;
  for (const double share : {0.1, 0.5}) {
    plan.falsify.share = share;
    plan.falsify.most_repeats = 300;
    int decided = 0, wrong = 0, clear = 0, open = 0, trials = 0;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      plan.seed = 1000 * seed;
      const SweepResult result = *SweepGrid(plan, Planted());
      trials += static_cast<int>(result.rows.size());
      for (const SettingResult& setting : result.settings) {
        const double truth = *setting.theta[0].number;
        const bool is_falsified = setting.verdict.verdict == gap::Verdict::kFalsified;
        const bool is_passed = setting.verdict.verdict == gap::Verdict::kPassed;
        decided += is_falsified || is_passed;
        wrong += (is_falsified && truth <= share) || (is_passed && truth >= share);
        const bool is_clear =
            truth < share / 3.0 || truth > std::min(3.0 * share, 1.0 - (1.0 - share) / 3.0);
        clear += is_clear;
        open += is_clear && !is_falsified && !is_passed;
      }
    }
    CAPTURE(share, decided, wrong, clear, open, trials);
    CHECK(decided >= 450);
    CHECK(wrong <= 0.05 * decided);
    CHECK(open <= 0.2 * clear);
  }
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
  CHECK(refusal() ==
        "goal is falsify, and candidate.kind is logs: only simulated trials can be searched");
  plan = Plan(Budget(10));
  plan.space.parameters.clear();
  CHECK(refusal() == "goal is falsify, and space has no parameters to search");
}

TEST_CASE("A search has passed where every setting has, and is open where one is not decided") {
  experiment::Experiment plan = Plan(Budget(12, search::Method::kRandom));
  plan.falsify.repeat = Repeat::kNone;
  plan.reference.trials.names = {"1", "2"};
  const auto verdict = [&](double chance_from) {
    const SweepResult result =
        *Falsify(plan,
                 RunHere(
                     [&](const TrialRequest& request) {
                       TrialRow row = RowFor(request);
                       row.comparison.gap_m = 0.02;
                       const bool is_by_chance = *request.theta[0].number >= chance_from;
                       row.evidence.fingerprint = is_by_chance ? *request.seed + 100 : 7;
                       return row;
                     },
                     {}),
                 [](const auto&) { return true; });
    return result.falsification->verdict;
  };
  CHECK(verdict(2.0) == gap::Verdict::kPassed);
  CHECK(verdict(0.5) == gap::Verdict::kNotSeenToFail);
}

TEST_CASE("Another seed of the experiment is another search") {
  experiment::Experiment plan = Plan(Budget(8, search::Method::kRandom));
  const auto first = [&](std::uint64_t seed) {
    plan.seed = seed;
    return Falsify(plan, RunHere(Simulated, {}), [](const auto&) { return true; })->rows[0].theta;
  };
  CHECK(first(1) != first(2));
}

TEST_CASE("The worst setting is the first of those that are equally bad") {
  experiment::Experiment plan =
      Plan(Budget(6, search::Method::kRandom), {.until = Until::kBudget, .repeat = Repeat::kNone});
  const SweepResult result = *Falsify(plan,
                                      RunHere(
                                          [](const TrialRequest& request) {
                                            TrialRow row = RowFor(request);
                                            row.comparison.gap_m = 0.02;
                                            return row;
                                          },
                                          {}),
                                      [](const auto&) { return true; });
  CHECK(result.falsification->worst_setting == 0);
  CHECK(result.falsification->evaluations == 6);
}

TEST_CASE("What is falsified later is the worst where it costs more, and what is not is none") {
  // The trials of a search in turn: how far apart, and whether they fail.
  const std::vector<std::pair<double, bool>> trials{{0.09, false}, {0.07, true},  {0.10, false},
                                                    {0.08, true},  {0.075, true}, {0.20, false}};
  experiment::Experiment plan =
      Plan(Budget(6, search::Method::kRandom), {.until = Until::kBudget, .repeat = Repeat::kNone});
  plan.reference.trials.names = {"1", "2", "3", "4", "5", "6"};
  int run = 0;
  const SweepResult result = *Falsify(plan,
                                      RunHere(
                                          [&](const TrialRequest& request) {
                                            const auto& [gap_m, fails] =
                                                trials[static_cast<size_t>(run++ / 6)];
                                            TrialRow row = RowFor(request);
                                            row.comparison.gap_m = gap_m;
                                            row.falsified = fails;
                                            return row;
                                          },
                                          {}),
                                      [](const auto&) { return true; });
  CHECK(result.falsification->verdict == gap::Verdict::kFalsified);
  CHECK(result.falsification->first_evaluation == 2);
  CHECK(result.falsification->worst_setting == 3);
}

TEST_CASE("Four strategies choose points blindly, the others by what they were told") {
  using search::Method;
  constexpr auto kNames = EnumNames(Method{});
  for (size_t i = 0; i < kNames.size(); ++i) {
    const auto method = static_cast<Method>(i);
    const bool is_blind = method == Method::kRandom || method == Method::kSobol ||
                          method == Method::kLatinHypercube || method == Method::kCorners;
    CAPTURE(kNames[i]);
    CHECK(IsChosenByResults({.strategy = std::string(kNames[i])}) == !is_blind);
  }
}

}  // namespace
}  // namespace rift::sweep
