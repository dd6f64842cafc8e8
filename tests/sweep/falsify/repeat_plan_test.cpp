// How many further trials the settings of a batch are worth, and when a search is over.
#include <catch2/catch.hpp>
#include <cmath>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/verdict.hpp"

namespace rift::sweep {
namespace {

using Rows = std::vector<TrialRow>;

/// `failing` trials at 0.08 m and `passing` ones, each with a path of its own.
Rows Trials(int failing, int passing, double passing_m = 0.02) {
  Rows rows(static_cast<size_t>(failing + passing));
  for (size_t i = 0; i < rows.size(); ++i) {
    rows[i].falsified = i < static_cast<size_t>(failing);
    rows[i].comparison.gap_m = rows[i].falsified ? 0.08 : passing_m;
    rows[i].seed = i;
    rows[i].evidence.fingerprint = i + 1;
  }
  return rows;
}

Rows Untold(int count) {
  Rows rows(static_cast<size_t>(count));
  for (TrialRow& row : rows) row.status = TrialStatus::kCrashed;
  return rows;
}

Rows With(Rows rows, const Rows& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

int MoreOf(const Rows& rows, const FalsifyOptions& options, int settings = 1) {
  return RepeatPlan(options, settings, 0.06).More({rows}).front();
}

TEST_CASE("One setting is falsified by one failure where one in ten may fail") {
  // The evidence needed is log(1 / 0.05); failures alone each weigh at most log(1 / 0.1).
  CHECK(TrialsToFalsify({}, 1) == 2);
  CHECK(TrialsToFalsify({.share = 0.01, .confidence = 0.9}, 1) == 1);
  CHECK(TrialsToFalsify({}, 10) > TrialsToFalsify({}, 1));
  CHECK(TrialsToFalsify({.share = 0.5}, 1) > TrialsToFalsify({.share = 0.1}, 1));
  CHECK(TrialsToFalsify({.confidence = 0.999}, 1) > TrialsToFalsify({.confidence = 0.9}, 1));
}

TEST_CASE(
    "A setting with a failure gets as many trials as could decide it, and no more once done") {
  const int needed = TrialsToFalsify({}, 1);
  for (int failures = 1; failures <= needed; ++failures) {
    INFO(failures);
    CHECK(MoreOf(Trials(failures, 0), {}) == needed - failures);
  }
}

TEST_CASE("Among many settings more trials are needed than for one") {
  CHECK(MoreOf(Trials(1, 0), {}, 500) == TrialsToFalsify({}, 500) - 1);
  CHECK(MoreOf(Trials(1, 0), {}, 500) > MoreOf(Trials(1, 0), {}, 1));
}

TEST_CASE("Which settings are looked at again depends on what is asked for") {
  const Rows far = Trials(0, 1, 0.02), near = Trials(0, 1, 0.0551), at_bound = Trials(0, 1, 0.05);
  const FalsifyOptions none{.repeat = Repeat::kNone}, doubtful{.repeat = Repeat::kDoubtful},
      every{.repeat = Repeat::kEvery};
  CHECK(MoreOf(Trials(1, 0), none) == 0);
  CHECK(MoreOf(near, none) == 0);
  CHECK(MoreOf(far, none) == 0);
  CHECK(MoreOf(Trials(1, 0), doubtful) > 0);
  CHECK(MoreOf(near, doubtful) > 0);  // 4.9 mm below the threshold
  CHECK(MoreOf(far, doubtful) == 0);
  CHECK(MoreOf(at_bound, {.near_m = 0.011}) > 0);
  CHECK(MoreOf(at_bound, {.near_m = 0.009}) == 0);
  CHECK(MoreOf(Trials(0, 2, 0.0551), doubtful) == 0);  // looked at again once
  CHECK(MoreOf(Trials(1, 1), doubtful) > 0);
  CHECK(MoreOf(far, every) > 0);
  CHECK(MoreOf(Trials(0, 2), every) > 0);
}

TEST_CASE("A setting that no number of trials left could decide gets none") {
  const int needed = TrialsToFalsify({}, 1);
  CHECK(MoreOf(Trials(1, 0), {.most_repeats = needed}) == needed - 1);
  CHECK(MoreOf(Trials(1, 0), {.most_repeats = needed - 1}) == 0);
}

TEST_CASE(
    "Trials that do not tell are replaced where no more than two of them outnumber the rest") {
  const FalsifyOptions every{.repeat = Repeat::kEvery};
  CHECK(MoreOf(Untold(1), every) == 1);
  CHECK(MoreOf(Untold(2), every) == 1);
  CHECK(MoreOf(Untold(3), every) == 0);
  CHECK(MoreOf(With(Trials(1, 0), Untold(3)), every) > 0);
  CHECK(MoreOf(With(Trials(1, 0), Untold(4)), every) == 0);
  CHECK(MoreOf(Untold(1), {.repeat = Repeat::kDoubtful}) == 1);
  CHECK(MoreOf(Untold(1), {.repeat = Repeat::kNone}) == 0);
}

TEST_CASE("A setting that passes gets trials until it is decided, and none from then on") {
  const FalsifyOptions every{.repeat = Repeat::kEvery};
  int trials = 1;
  for (; trials < 100 && MoreOf(Trials(0, trials), every) > 0; ++trials) {
    CHECK(CountFailures(Trials(0, trials), every).verdict == gap::Verdict::kNotSeenToFail);
  }
  CHECK(CountFailures(Trials(0, trials), every).verdict == gap::Verdict::kPassed);
  CHECK(trials > 20);
  CHECK(MoreOf(Trials(0, trials - 1), every) == 1);
  // Where so many are not allowed, those that could still show failures are run.
  CHECK(MoreOf(Trials(0, trials - 1), {.repeat = Repeat::kEvery, .most_repeats = trials - 1}) == 0);
}

TEST_CASE("Others of a batch that are decided make a setting need less") {
  RepeatPlan plan({}, 10, 0.06);
  const Rows decided = Trials(TrialsToFalsify({}, 10), 0), open = Trials(1, 0);
  const int alone = plan.More({open}).front();
  const std::vector<int> together = plan.More({decided, open});
  CHECK(together[0] == 0);
  CHECK(together[1] <= alone);
  RepeatPlan known({}, 10, 0.06);
  known.Add({decided});
  CHECK(known.More({open}).front() == together[1]);
  RepeatPlan two({}, 2, 0.06), two_known({}, 2, 0.06);
  two_known.Add({Trials(9, 0)});
  CHECK(two_known.More({open}).front() < two.More({open}).front());
}

TEST_CASE("A search has falsified with the first setting that has the evidence") {
  for (const int settings : {1, 500}) {
    RepeatPlan plan({}, settings, 0.06);
    CHECK_FALSE(plan.HasFalsified());
    plan.Add({Trials(TrialsToFalsify({}, settings) - 1, 0)});
    CHECK_FALSE(plan.HasFalsified());
    plan.Add({Trials(0, 3), Trials(TrialsToFalsify({}, settings), 0)});
    CHECK(plan.HasFalsified());
  }
  RepeatPlan passed({}, 1, 0.06);
  passed.Add({Trials(0, 200)});
  CHECK_FALSE(passed.HasFalsified());
}

TEST_CASE("Robustness is the threshold less the mean loss of the rows that tell") {
  CHECK(Robustness_m(With(Trials(1, 1), Untold(2)), 0.06) == Approx(0.06 - 0.05));
  CHECK(std::isnan(Robustness_m(Untold(2), 0.06)));
}

TEST_CASE("A failing setting without chance is falsified by two trials and has all or nothing") {
  Rows same = Trials(2, 0);
  for (TrialRow& row : same) row.evidence.fingerprint = 5;
  const gap::RepeatVerdict fails = CountFailures(same, {});
  CHECK(fails.share_low == 1.0);
  CHECK(fails.share_high == 1.0);
  CHECK(fails.evidence.above == std::numeric_limits<double>::infinity());
  CHECK(fails.evidence.below == -std::numeric_limits<double>::infinity());
  for (TrialRow& row : same) row.falsified = false;
  const gap::RepeatVerdict passes = CountFailures(same, {});
  CHECK(passes.share_low == 0.0);
  CHECK(passes.share_high == 0.0);
  CHECK(passes.evidence.above == -std::numeric_limits<double>::infinity());
  CHECK(passes.evidence.below == std::numeric_limits<double>::infinity());
  for (TrialRow& row : same) row.seed = 4;  // the same trial twice says nothing of others
  CHECK(CountFailures(same, {}).verdict == gap::Verdict::kNotSeenToFail);
  CHECK(CountFailures(same, {}).repeats == 1);
  same.resize(1);
  CHECK(CountFailures(same, {}).verdict == gap::Verdict::kNotSeenToFail);
  CHECK(CountFailures({}, {}).verdict == gap::Verdict::kUndecided);
}

/// Gives out the points it holds and remembers what it is told.
class Scripted : public search::Strategy {
 public:
  explicit Scripted(int points) : left_(points) {}

  std::vector<search::Point> Ask(int count) override {
    asked.push_back(count);
    std::vector<search::Point> points;
    for (int i = 0; i < count && left_ > 0; ++i, --left_) {
      points.push_back({static_cast<double>(next_++)});
    }
    return points;
  }
  void Tell(std::span<const search::Evaluation> evaluations) override {
    for (const search::Evaluation& one : evaluations) told.push_back(one);
  }

  std::vector<int> asked;
  std::vector<search::Evaluation> told;

 private:
  int left_;
  int next_ = 0;
};

/// Each point is a trial, and point 2 gets one more; a loss is the number of rows.
SearchGoal Goal(int budget, int batch) {
  const auto trial_of = [](const search::Point& point) {
    return TrialRequest{.theta = {{std::to_string(static_cast<int>(point[0])), point[0]}}};
  };
  return {
      .budget = budget,
      .batch = batch,
      .trials =
          [=](const search::Point& point) { return std::vector<TrialRequest>{trial_of(point)}; },
      .more =
          [=](std::span<const TriedPoint> tried) {
            std::vector<std::vector<TrialRequest>> more(tried.size());
            for (size_t i = 0; i < tried.size(); ++i) {
              if (tried[i].point[0] == 2.0 && tried[i].rows.size() < 2) {
                more[i] = {trial_of(tried[i].point)};
              }
            }
            return more;
          },
      .loss = [](std::span<const TrialRow> rows) { return static_cast<double>(rows.size()); },
      .is_enough = [](std::span<const TriedPoint>) { return false; }};
}

RunTrials Echo() {
  return RunHere([](const TrialRequest& request) { return RowFor(request); }, {});
}

bool Always(const std::vector<TrialRequest>&) { return true; }

TEST_CASE("A search asks for batches within its budget and tells each point with all its rows") {
  Scripted strategy(100);
  const auto outcome = Search(strategy, Goal(7, 3), Echo(), Always);
  REQUIRE(outcome);
  CHECK(outcome->ended == "the budget");
  CHECK(strategy.asked == std::vector<int>{3, 3, 1});
  REQUIRE(outcome->points.size() == 7);
  REQUIRE(strategy.told.size() == 7);
  for (size_t i = 0; i < 7; ++i) {
    const size_t rows = i == 2 ? 2 : 1;
    CHECK(outcome->points[i].point[0] == static_cast<double>(i));
    CHECK(outcome->points[i].rows.size() == rows);
    CHECK(*outcome->points[i].rows.back().theta[0].number == static_cast<double>(i));
    CHECK(outcome->points[i].loss == static_cast<double>(rows));
    CHECK(strategy.told[i].point == outcome->points[i].point);
    CHECK(strategy.told[i].loss == static_cast<double>(rows));
  }
}

TEST_CASE("A search ends where nothing is left to try, with the hit, or in time") {
  Scripted few(4);
  const auto all = Search(few, Goal(7, 3), Echo(), Always);
  CHECK(all->ended == "every point of the space");
  CHECK(all->points.size() == 4);

  Scripted strategy(100);
  SearchGoal goal = Goal(7, 3);
  goal.is_enough = [](std::span<const TriedPoint> tried) { return tried.back().point[0] >= 3.0; };
  const auto hit = Search(strategy, goal, Echo(), Always);
  CHECK(hit->ended == "the first hit");
  CHECK(hit->points.size() == 6);

  Scripted timed(100);
  int asked = 0;  // batch, repeat of point 2, batch
  const auto late = Search(timed, Goal(9, 3), Echo(), [&](const auto&) { return ++asked <= 3; });
  CHECK(late->ended == "the time");
  CHECK(late->points.size() == 6);

  Scripted before_repeat(100);
  const auto half = Search(before_repeat, Goal(9, 3), Echo(),
                           [](const auto& requests) { return requests.size() != 1; });
  CHECK(half->ended == "the time");
  REQUIRE(half->points.size() == 3);  // what was run is kept, and told
  CHECK(half->points[2].rows.size() == 1);
  CHECK(before_repeat.told.size() == 3);

  Scripted none(100);
  const auto nothing = Search(none, Goal(9, 3), Echo(), [](const auto&) { return false; });
  CHECK(nothing->ended == "the time");
  CHECK(nothing->points.empty());
}

TEST_CASE("A search that is told to stop gives nothing, in a batch and in its repeats") {
  for (const int trials : {0, 2, 3}) {  // the fourth is the repeat
    Scripted strategy(100);
    int run = 0;
    Watch watch;
    watch.go_on = [&] { return run < trials; };
    watch.seen = [&](const TrialRow&, bool) { ++run; };
    const RunTrials runs =
        RunHere([](const TrialRequest& request) { return RowFor(request); }, watch);
    CHECK_FALSE(Search(strategy, Goal(7, 3), runs, Always));
    CHECK(run == trials);
    CHECK(strategy.told.empty());
  }
}

experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.goal = experiment::Goal::kFalsify;
  plan.space.parameters = {{.key = "x", .min = 0.0, .max = 1.0}};
  plan.falsify.until = Until::kBudget;
  plan.falsify.repeat = Repeat::kNone;
  plan.search.budget = 20;
  plan.search.strategy = search::Method::kRandom;
  return plan;
}

SweepResult Falsified(const experiment::Experiment& plan, double fails_above) {
  return *Falsify(plan,
                  RunHere(
                      [&](const TrialRequest& request) {
                        TrialRow row = RowFor(request);
                        row.comparison.gap_m = 0.1 * *row.theta[0].number;
                        row.falsified = *row.theta[0].number > fails_above;
                        return row;
                      },
                      {}),
                  Always);
}

TEST_CASE("The worst setting of a search is the worst falsified one, else the worst of all") {
  experiment::Experiment plan = Plan();
  const auto gap_of = [](const SweepResult& result, int setting) {
    return result.settings[static_cast<size_t>(setting)].mean_gap_m;
  };
  const SweepResult open = Falsified(plan, 0.6);  // one trial each: nothing is decided
  CHECK(open.falsification->verdict == gap::Verdict::kUndecided);
  CHECK_FALSE(open.falsification->first_evaluation);
  CHECK(open.falsification->strategy == "random");
  CHECK(open.falsification->budget == 20);
  double largest_m = 0.0;
  for (int i = 0; i < 20; ++i) largest_m = std::max(largest_m, gap_of(open, i));
  CHECK(gap_of(open, *open.falsification->worst_setting) == largest_m);

  const SweepResult safe = Falsified(plan, 2.0);
  CHECK(safe.falsification->verdict == gap::Verdict::kNotSeenToFail);
  CHECK(gap_of(safe, *safe.falsification->worst_setting) == largest_m);

  plan.reference.trials.names = {"1", "2", "3", "4", "5", "6"};
  const SweepResult low =
      *Falsify(plan,
               RunHere(
                   [&](const TrialRequest& request) {
                     TrialRow row = RowFor(request);
                     row.comparison.gap_m = 0.1 * *row.theta[0].number;
                     row.falsified = *row.theta[0].number < 0.5;  // those with the smaller gaps
                     return row;
                   },
                   {}),
               Always);
  REQUIRE(low.falsification->verdict == gap::Verdict::kFalsified);
  double largest_failing_m = 0.0;
  int first = 0;
  for (int i = 19; i >= 0; --i) {
    if (*low.settings[static_cast<size_t>(i)].theta[0].number >= 0.5) continue;
    largest_failing_m = std::max(largest_failing_m, gap_of(low, i));
    first = i + 1;
  }
  CHECK(low.falsification->first_evaluation == first);
  CHECK(gap_of(low, *low.falsification->worst_setting) == largest_failing_m);
}

// Numbers of trials below: the evidence of a mixture of five alternatives against what so many
// settings and decisions need (statistics::EvidenceOnShare, NeededEvidence), in Python.

TEST_CASE("As many trials falsify the first of so many settings as by hand") {
  for (const auto& [settings, trials] :
       {std::pair{1, 2}, {2, 3}, {10, 4}, {100, 5}, {500, 5}, {5000, 7}}) {
    CAPTURE(settings);
    CHECK(TrialsToFalsify({}, settings) == trials);
  }
  const gap::VerdictOptions half{.share = 0.5, .confidence = 0.99};
  CHECK(TrialsToFalsify(half, 1) == 9);
  CHECK(TrialsToFalsify(half, 10) == 13);
  CHECK(TrialsToFalsify(half, 500) == 19);
}

FalsifyOptions Every(double share, double confidence, int most_repeats = 100) {
  FalsifyOptions options{.repeat = Repeat::kEvery, .most_repeats = most_repeats};
  options.share = share;
  options.confidence = confidence;
  return options;
}

TEST_CASE("A setting gets the trials that could decide it, from what it has had so far") {
  struct Case {
    int failing, passing, settings, more, more_of_three_in_ten;
  };
  for (const Case& one : {Case{1, 0, 1, 1, 2},
                          {1, 3, 1, 3, 6},
                          {1, 0, 20, 3, 5},
                          {2, 6, 20, 5, 12},
                          {2, 0, 500, 3, 7},
                          {1, 4, 500, 7, 15},
                          {0, 1, 1, 3, 5},
                          {0, 5, 20, 7, 13},
                          {3, 10, 20, 6, 15}}) {
    CAPTURE(one.failing, one.passing, one.settings);
    const Rows rows = Trials(one.failing, one.passing);
    CHECK(MoreOf(rows, Every(0.1, 0.95), one.settings) == one.more);
    CHECK(MoreOf(rows, Every(0.3, 0.9), one.settings) == one.more_of_three_in_ten);
    // One trial less than it needs is not allowed, and so none is worth it.
    const int all = one.failing + one.passing + one.more;
    CHECK(MoreOf(rows, Every(0.1, 0.95, all), one.settings) == one.more);
    CHECK(MoreOf(rows, Every(0.1, 0.95, all - 1), one.settings) == 0);
  }
}

TEST_CASE("Each setting that is decided makes the next need less, of its own kind alone") {
  // Of 20: so many falsified ones before, then what an open one still needs.
  for (const auto& [before, more] : {std::pair{0, 4}, {4, 4}, {5, 3}, {7, 3}}) {
    CAPTURE(before);
    RepeatPlan plan(Every(0.1, 0.95), 20, 0.06);
    for (int i = 0; i < before; ++i) plan.Add({Trials(9, 0)});
    CHECK(plan.More({Trials(1, 2)}).front() == more);
  }
  // And passed ones, where half of the runs may fail.
  for (const auto& [before, more] : {std::pair{0, 9}, {1, 8}, {2, 7}, {4, 7}, {5, 6}, {8, 6}}) {
    CAPTURE(before);
    RepeatPlan plan(Every(0.5, 0.95), 20, 0.06);
    for (int i = 0; i < before; ++i) plan.Add({Trials(0, 80)});
    CHECK(plan.More({Trials(0, 2)}).front() == more);
    CHECK_FALSE(plan.HasFalsified());
  }
}

TEST_CASE("The settings of a batch have their own numbers of trials, in their order") {
  RepeatPlan plan(Every(0.1, 0.95), 20, 0.06);
  const Rows far = Trials(0, 5), fails = Trials(1, 2), sure = Trials(9, 0), lost = Untold(3);
  CHECK(plan.More({far, fails, lost, fails}) == std::vector<int>{7, 4, 0, 4});
  CHECK(plan.More({sure, fails}).front() == 0);
  CHECK(plan.More({}).empty());
}

}  // namespace
}  // namespace rift::sweep
