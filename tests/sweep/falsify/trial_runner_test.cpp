#include "rift/sweep/falsify/trial_runner.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <csignal>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/sweep.hpp"
#include "rift/sweep/run/journal_summary.hpp"
#include "support/inputs/paths.hpp"
#include "support/processes/process.hpp"
#include "support/sanitizer.hpp"
#include "sweep/falsify/job_status.hpp"

namespace rift::sweep {
namespace {

experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.name = "trouble";
  plan.space.parameters = {{.key = "case",
                            .levels = {{"fine", {}},
                                       {"hangs", {}},
                                       {"segfaults", {}},
                                       {"nan", {}},
                                       {"eats", {}},
                                       {"throws", {}},
                                       {"wide", {}}}}};
  plan.reference.trials.names = {"1", "2"};
  plan.seed = 7;
  return plan;
}

Recording Straight() { return {.source = "path", .trajectory = test::StraightPath(0.7, 40)}; }

Recording Troubled(const TrialRequest& request) {
  const std::string& what = request.theta[0].text;
  if (what == "hangs") ::sleep(1000);
  if (what == "segfaults") std::raise(SIGSEGV);
  if (what == "throws") throw std::runtime_error("the wheel came off");
  std::vector<std::vector<char>> eaten;
  while (what == "eats") eaten.emplace_back(1 << 20, 'x');
  Recording path{.source = "simulation", .trajectory = test::StraightPath(0.7, 40)};
  if (what == "nan") path.trajectory.poses[7].x_m = std::numeric_limits<double>::quiet_NaN();
  const double offset_m = what == "wide" ? 0.08 : 0.001 * static_cast<double>(*request.seed);
  path.trajectory = test::Moved(std::move(path.trajectory), {0.0, offset_m, 0.0});
  return path;
}

TrialRow Evaluated(const TrialRequest& request) {
  return CompareTrial(Plan(), request, Troubled(request), Straight());
}

std::string KeyOf(const TrialRequest& request) {
  return request.theta[0].text + " " + request.trial + " " + std::to_string(*request.seed);
}

SweepResult SweepWith(int workers, Journal* journal, const Watch& watch = {}) {
  TrialRunner runner(Evaluated, KeyOf, journal, workers, {.timeout_s = 3.0, .memory_mb = 32},
                     watch);
  const auto run = [&](std::vector<TrialRequest> all) { return runner.Run(std::move(all)); };
  std::optional<SweepResult> result = SweepGrid(Plan(), run);
  REQUIRE(result);
  return *result;
}

bool SameRows(const SweepResult& a, const SweepResult& b) {
  REQUIRE(a.rows.size() == b.rows.size());
  for (size_t i = 0; i < a.rows.size(); ++i) {
    const TrialRow &x = a.rows[i], &y = b.rows[i];
    const bool same_gap = x.comparison.gap_m == y.comparison.gap_m ||
                          (std::isnan(x.comparison.gap_m) && std::isnan(y.comparison.gap_m));
    const bool same =
        x.theta == y.theta && x.trial == y.trial && x.seed == y.seed && x.status == y.status &&
        x.reason == y.reason && same_gap && x.falsified == y.falsified &&
        x.candidate == y.candidate && x.reference == y.reference &&
        x.evidence.fingerprint == y.evidence.fingerprint &&
        x.evidence.errors_m == y.evidence.errors_m && x.evidence.path_m == y.evidence.path_m &&
        x.evidence.path_times_s == y.evidence.path_times_s;
    if (!same) return false;
  }
  return true;
}

TEST_CASE("A sweep with planted trouble ends and each trouble is a row with its reason") {
  SKIP_UNDER_SANITIZER();
  const SweepResult result = SweepWith(2, nullptr);
  REQUIRE(result.rows.size() == 14);
  const auto row = [&](int setting) -> const TrialRow& { return result.rows[2 * setting]; };
  CHECK(row(0).IsOk());
  CHECK(row(0).comparison.gap_m == Approx(0.007));
  CHECK(result.rows[1].comparison.gap_m == Approx(0.008));
  CHECK(row(1).status == TrialStatus::kHung);
  CHECK(row(1).candidate == "simulation");  // as the watch names it
  CHECK(row(1).reason == "had not ended after 3 s (run.timeout_s), twice");
  CHECK(row(2).status == TrialStatus::kCrashed);
  CHECK(row(2).reason == "ended by signal 11 (Segmentation fault), twice");
  CHECK(row(3).status == TrialStatus::kNan);
  CHECK(row(3).reason == "simulation: a position is not finite");
  CHECK(row(4).status == TrialStatus::kOutOfMemory);
  CHECK(row(4).reason == "wanted more than 32 MB of memory, twice");
  CHECK(row(5).status == TrialStatus::kFault);
  CHECK(row(5).reason == "the wheel came off");
  CHECK(row(6).falsified);
  CHECK(result.all.n == 4);
  CHECK(result.all.not_ok == 10);
}

TEST_CASE("A search with planted trouble ends and trouble is neither a failure nor a pass") {
  SKIP_UNDER_SANITIZER();
  TrialRunner runner(Evaluated, KeyOf, nullptr, 2, {.timeout_s = 3.0, .memory_mb = 32}, {});
  experiment::Experiment plan = Plan();
  plan.search.budget = 20;  // the space has 7 settings
  plan.falsify.until = Until::kBudget;
  const std::optional<SweepResult> result = Falsify(
      plan, [&](std::vector<TrialRequest> all) { return runner.Run(std::move(all)); },
      [](const auto&) { return true; });
  REQUIRE(result);
  REQUIRE(result->settings.size() == 7);
  const Falsification& found = *result->falsification;
  CHECK(found.verdict == gap::Verdict::kFalsified);
  CHECK(result->Count(gap::Verdict::kFalsified) == 1);
  CHECK(result->Count(gap::Verdict::kUndecided) == 5);  // of those no trial tells
  CHECK(found.ended == "every point of the space");
  CHECK(result->settings[*found.worst_setting].theta[0].text == "wide");
  std::set<TrialStatus> seen;
  for (const TrialRow& row : result->rows) {
    seen.insert(row.status);
    CHECK(row.reason.empty() == row.IsOk());
    CHECK(row.falsified == (row.theta[0].text == "wide"));
  }
  CHECK(seen == std::set<TrialStatus>{TrialStatus::kOk, TrialStatus::kHung, TrialStatus::kCrashed,
                                      TrialStatus::kNan, TrialStatus::kOutOfMemory,
                                      TrialStatus::kFault});
}

TEST_CASE("The rows of a sweep are the same for one worker and for two and for none") {
  experiment::Experiment plan = Plan();
  plan.space.parameters[0].levels = {{"fine", {}}, {"wide", {}}};
  const auto sweep_of = [&](int workers) {
    TrialRunner runner(Evaluated, KeyOf, nullptr, workers, {}, {});
    return *SweepGrid(plan, [&](auto all) { return runner.Run(std::move(all)); });
  };
  const SweepResult here = *SweepGrid(plan, RunHere(Evaluated, {}));
  CHECK(SameRows(sweep_of(1), here));
  CHECK(SameRows(sweep_of(2), here));
  CHECK(SameRows(SweepWith(1, nullptr), SweepWith(2, nullptr)));
}

TEST_CASE("What the journal holds is not computed again and gives the same rows") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", {{"version", "1"}});
  int computed = 0, remembered = 0;
  Watch watch;
  watch.seen = [&](const TrialRow&, bool from_journal) {
    ++(from_journal ? remembered : computed);
  };
  const SweepResult first = SweepWith(2, &journal, watch);
  CHECK(computed == 14);
  CHECK(SameRows(first, SweepWith(2, &journal, watch)));
  CHECK(computed == 14);
  CHECK(remembered == 14);
}

TEST_CASE("A sweep that is stopped goes on with the trials that are missing") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", {{"version", "1"}});
  std::set<std::string> computed;
  const auto run_until = [&](size_t enough) {
    Watch watch;
    watch.seen = [&](const TrialRow& row, bool from_journal) {
      if (!from_journal) CHECK(computed.insert(row.theta[0].text + row.trial).second);
    };
    watch.go_on = [&] { return computed.size() < enough; };
    TrialRunner runner(Evaluated, KeyOf, &journal, 2, {.timeout_s = 3.0, .memory_mb = 32}, watch);
    return SweepGrid(Plan(), [&](auto all) { return runner.Run(std::move(all)); });
  };
  CHECK_FALSE(run_until(3));
  CHECK(computed.size() >= 3);
  const std::optional<SweepResult> whole = run_until(100);
  REQUIRE(whole);
  CHECK(computed.size() == 14);
  CHECK(SameRows(*whole, SweepWith(1, nullptr)));
}

/// A row with a value of its own in each member.
TrialRow FullRow() {
  TrialRow row = RowFor({.theta = {{"fine", {}}}, .trial = "1", .seed = 7});
  row.status = TrialStatus::kTimedOut;
  row.reason = "why";
  row.candidate = "c";
  row.reference = "r";
  row.comparison.gap_m = 0.1;
  row.comparison.equal_time_m = 0.2;
  row.way_gap_m = 0.3;
  row.falsified = true;
  row.left_m = 0.4;
  row.evidence.fingerprint = 5;
  row.evidence.candidate_limits.emplace().decisions = 6;
  row.evidence.reference_limits.emplace().decisions = 7;
  row.evidence.errors_m = {{0.8, 0.9}};
  row.evidence.path_m = {{1.0F, 2.0F}, {3.0F, 4.0F}};
  row.evidence.path_times_s = {5.0F, 6.0F};
  row.doubts = {{DoubtAbout::kReference, "doubt"}};
  return row;
}

TEST_CASE("Every finding of a row comes back from its bytes, and what was asked for stays") {
  TrialRow back = RowFor({.theta = {{"other", {}}}, .trial = "9", .is_random_draw = true});
  DecodeFindings(EncodeFindings(FullRow()), back);
  CHECK(back.theta[0].text == "other");
  CHECK(back.trial == "9");
  CHECK(back.is_random_draw);
  CHECK(back.seed == 7u);  // which may have been replaced
  CHECK(back.status == TrialStatus::kTimedOut);
  CHECK(back.reason == "why");
  CHECK(back.candidate == "c");
  CHECK(back.reference == "r");
  CHECK(back.comparison.gap_m == 0.1);
  CHECK(back.comparison.equal_time_m == 0.2);
  CHECK(back.way_gap_m == 0.3);
  CHECK(back.falsified);
  CHECK(back.left_m == 0.4);
  CHECK(back.evidence.fingerprint == 5);
  CHECK(back.evidence.candidate_limits->decisions == 6);
  CHECK(back.evidence.reference_limits->decisions == 7);
  CHECK(back.evidence.errors_m[0] == Eigen::Vector2d(0.8, 0.9));
  CHECK(back.evidence.path_m[1] == Eigen::Vector2f(3.0F, 4.0F));
  CHECK(back.evidence.path_times_s == std::vector<float>{5.0F, 6.0F});
  REQUIRE(back.doubts.size() == 1);
  CHECK(back.doubts[0].about == DoubtAbout::kReference);
  CHECK(back.doubts[0].text == "doubt");
  CHECK_THROWS_WITH(DecodeFindings(EncodeFindings(back) + "x", back),
                    Catch::Contains("of another layout"));
}

TEST_CASE("Every part of a request comes back from its bytes") {
  const TrialRequest request{
      .theta = {{"0.2", 0.2}, {"ice", {}}}, .trial = "3", .seed = 11, .is_random_draw = true};
  const TrialRequest back = DecodeRequest(EncodeRequest(request));
  CHECK(back.theta == request.theta);
  CHECK(back.trial == "3");
  CHECK(back.seed == 11u);
  CHECK(back.is_random_draw);
  CHECK_FALSE(DecodeRequest(EncodeRequest({.trial = "3"})).seed);
}

TEST_CASE("A runner knows what its journal lacks, and keeps the first paths alone") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", {{"version", "1"}});
  std::vector<TrialRequest> requests;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    requests.push_back({.theta = {{"fine", {}}}, .trial = "1", .seed = seed});
  }
  const Evaluate full = [](const TrialRequest&) { return FullRow(); };
  TrialRunner runner(full, KeyOf, &journal, 1, {}, {}, 3);
  CHECK(runner.PathsLeft() == 3);
  CHECK_FALSE(runner.HasAll(requests));
  CHECK(runner.HasAll({}));
  CHECK(runner.Missing(requests) == std::vector<size_t>{0, 1, 2, 3, 4});
  const auto rows = runner.Run({requests[1], requests[3]});
  REQUIRE(rows);
  CHECK((*rows)[0].evidence.path_m.size() == 2);
  CHECK((*rows)[1].evidence.path_times_s.size() == 2);
  CHECK(runner.PathsLeft() == 1);
  CHECK(runner.Missing(requests) == std::vector<size_t>{0, 2, 4});
  CHECK(runner.HasAll({requests[3], requests[1]}));
  CHECK_FALSE(runner.HasAll({requests[3], requests[0]}));
  const auto more = runner.Run({requests[1], requests[2], requests[0]});  // one from the journal
  REQUIRE(more);
  CHECK((*more)[0].evidence.path_m.size() == 2);
  CHECK((*more)[1].evidence.path_m.empty());
  CHECK((*more)[2].evidence.path_m.empty());
  CHECK((*more)[2].evidence.errors_m.size() == 1);
  CHECK(runner.PathsLeft() == 0);
  const auto again = runner.Run({requests[1]});
  CHECK((*again)[0].evidence.path_m.empty());  // from the journal, which has it
  TrialRunner without(full, KeyOf, nullptr, 1, {}, {});
  CHECK_FALSE(without.HasAll({}));
  CHECK(without.Missing(requests).size() == 5);
  CHECK(without.PathsLeft() == 5000);
}

TEST_CASE("A journal tells people how a trial ended, its gap and whether it fails") {
  const test::TemporaryFolder folder;
  {
    Journal journal(folder / "journal.sqlite", {{"version", "1"}});
    TrialRunner runner([](const TrialRequest&) { return FullRow(); }, KeyOf, &journal, 1, {}, {});
    REQUIRE(runner.Run({{.theta = {{"fine", {}}}, .trial = "1", .seed = 7}}));
    journal.Close();
  }
  SQLite::Database database(folder / "journal.sqlite");
  SQLite::Statement rows(database, "SELECT key, status, gap_m, falsified FROM trial");
  REQUIRE(rows.executeStep());
  CHECK(rows.getColumn(0).getString() == "fine 1 7");
  CHECK(rows.getColumn(1).getString() == "timed_out");
  CHECK(rows.getColumn(2).getDouble() == 0.1);
  CHECK(rows.getColumn(3).getInt() == 1);
  CHECK_FALSE(rows.executeStep());
}

TEST_CASE("What was run stands in the journal for others as soon as a batch ends or is stopped") {
  const test::TemporaryFolder folder;
  const std::string file = folder / "journal.sqlite";
  Journal journal(file, {{"version", "1"}});
  std::vector<TrialRequest> requests;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    requests.push_back({.theta = {{"fine", {}}}, .trial = "1", .seed = seed});
  }
  const auto committed = [&] {
    const std::map<std::string, int> rows = ReadJournal(file).trials_by_status;
    return rows.contains("timed_out") ? rows.at("timed_out") : 0;
  };
  const Evaluate full = [](const TrialRequest&) { return FullRow(); };
  TrialRunner runner(full, KeyOf, &journal, 1, {}, {});
  REQUIRE(runner.Run({requests[0], requests[1]}));
  CHECK(committed() == 2);
  int seen = 0;
  Watch watch;
  watch.seen = [&](const TrialRow&, bool) { ++seen; };
  watch.go_on = [&] { return seen == 0; };
  TrialRunner stopped(full, KeyOf, &journal, 1, {}, watch);
  CHECK_FALSE(stopped.Run({requests[2], requests[3], requests[4], requests[5]}));
  CHECK(seen >= 1);
  CHECK(committed() == 2 + seen);
}

TEST_CASE("Rows stand in the order of their requests, known and new ones mixed") {
  const test::TemporaryFolder folder;
  Journal journal(folder / "journal.sqlite", {{"version", "1"}});
  const Evaluate evaluate = [](const TrialRequest& request) {
    TrialRow row = RowFor(request);
    row.comparison.gap_m = 0.01 * static_cast<double>(*request.seed);
    return row;
  };
  std::vector<TrialRequest> requests;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    requests.push_back({.theta = {{"fine", {}}}, .trial = "1", .seed = seed});
  }
  std::vector<std::pair<std::uint64_t, bool>> seen;
  Watch watch;
  watch.seen = [&](const TrialRow& row, bool from_journal) {
    seen.emplace_back(*row.seed, from_journal);
  };
  TrialRunner runner(evaluate, KeyOf, &journal, 1, {}, watch);
  REQUIRE(runner.Run({requests[1], requests[3]}));
  const auto rows = runner.Run({requests[4], requests[3], requests[0], requests[1], requests[2]});
  REQUIRE(rows);
  const std::vector<std::uint64_t> order{4, 3, 0, 1, 2};
  for (size_t i = 0; i < order.size(); ++i) {
    CHECK((*rows)[i].seed == order[i]);
    CHECK((*rows)[i].comparison.gap_m == 0.01 * static_cast<double>(order[i]));
  }
  CHECK(seen ==
        std::vector<std::pair<std::uint64_t, bool>>{
            {1, false}, {3, false}, {3, true}, {1, true}, {4, false}, {0, false}, {2, false}});
}

TEST_CASE("Whoever watches names the sides of rows that could not name them, and of no others") {
  const Evaluate evaluate = [](const TrialRequest& request) {
    if (*request.seed == 1) throw std::runtime_error("no wheel");
    return FullRow();
  };
  Watch watch;
  watch.name_sides = [](TrialRow& row) {
    row.candidate = "program of trial " + row.trial;
    row.reference = "its log";
  };
  TrialRunner runner(evaluate, KeyOf, nullptr, 1, {}, watch);
  const auto rows = runner.Run({{.theta = {{"fine", {}}}, .trial = "1", .seed = 0},
                                {.theta = {{"fine", {}}}, .trial = "2", .seed = 1}});
  REQUIRE(rows);
  CHECK((*rows)[0].candidate == "c");
  CHECK((*rows)[0].reference == "r");
  CHECK((*rows)[1].candidate == "program of trial 2");
  CHECK((*rows)[1].reference == "its log");
  CHECK((*rows)[1].reason == "no wheel");
}

TEST_CASE("A trial that is run apart ends in a process of its own, as it ends") {
  const TrialRequest request{.theta = {{"fine", {}}}, .trial = "4", .seed = 9};
  const JobResult done = RunApart(
      [](const std::string& job) {
        const TrialRequest asked = DecodeRequest(job);
        return asked.theta[0].text + asked.trial + std::to_string(*asked.seed) + " " +
               std::to_string(::getpid());
      },
      request, {});
  CHECK(done.end == JobEnd::kDone);
  CHECK(done.bytes.starts_with("fine49 "));
  CHECK(done.bytes != "fine49 " + std::to_string(::getpid()));
  const JobResult hung = RunApart(
      [](const std::string&) -> std::string {
        ::sleep(1000);
        return "";
      },
      request, {.timeout_s = 0.1, .retries = 1});
  CHECK(hung.end == JobEnd::kHung);
  CHECK(hung.bytes == "had not ended after 0.1 s (run.timeout_s), twice");
}

}  // namespace
}  // namespace rift::sweep
