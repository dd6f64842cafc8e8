#include "rift/sweep/falsify/chance_among_runs.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "rift/sweep/falsify/verdict.hpp"
#include "sweep/falsify/rows.hpp"

namespace rift::sweep {
namespace {

using Rows = std::vector<TrialRow>;

TrialRow Driven(TrialRow row, std::uint64_t seed, int setting = 0) {
  row.theta = {{std::to_string(setting), static_cast<double>(setting)}};
  row.trial = std::to_string(seed);
  row.seed = seed;
  return row;
}

bool IsSeen(const std::vector<Rows>& settings) {
  ChanceAmongRuns chance;
  for (const Rows& rows : settings) {
    std::vector<const TrialRow*> trials;
    for (const TrialRow& row : rows) trials.push_back(&row);
    chance.Note(trials);
  }
  return chance.IsSeen();
}

TEST_CASE("Chance among runs is seen where repeats part and one of their runs comes again") {
  const Rows same{Driven(Ok(0.02, 7), 1), Driven(Ok(0.02, 7), 2)};
  CHECK_FALSE(IsSeen({same}));
  const Rows part{Driven(Ok(0.02, 7), 1), Driven(Failed(0.5, 7), 2)};
  CHECK_FALSE(IsSeen({part}));
  CHECK(IsSeen({part, same}));
  CHECK(IsSeen({same, part}));
  CHECK(IsSeen({{same[0], part[1], Driven(Ok(0.02, 7), 3)}}));
  // The same noise at another setting, where the parameter does nothing.
  CHECK_FALSE(IsSeen({part, {Driven(Ok(0.02, 7), 1, 1), Driven(Failed(0.5, 7), 2, 1)}}));
}

TEST_CASE(
    "Noise that moves every path is no chance among runs, whatever a setting without it does") {
  const Rows noisy{Driven(Ok(0.02, 1), 1), Driven(Ok(0.03, 2), 2), Driven(Ok(0.02, 3), 3)};
  const Rows without{Driven(Ok(0.02, 7), 1), Driven(Ok(0.02, 7), 2), Driven(Ok(0.02, 7), 3)};
  CHECK_FALSE(IsSeen({noisy, without}));
}

TEST_CASE("Trials without a path, without a seed or that do not tell say nothing of chance") {
  const Rows part{Driven(Ok(0.02, 7), 1), Driven(Ok(0.09, 8), 2), Driven(Ok(0.02, 7), 3)};
  REQUIRE(IsSeen({part}));
  Rows without = part;
  for (TrialRow& row : without) row.evidence.fingerprint = 0;
  CHECK_FALSE(IsSeen({without}));
  without = part;
  for (TrialRow& row : without) row.seed.reset();
  CHECK_FALSE(IsSeen({without}));
  without = part;
  without[1] = Driven(Failed(0.5, 8), 2);
  without[1].falsified = false;
  CHECK_FALSE(IsSeen({without}));
}

TEST_CASE("A search takes no setting for decided by runs that chance among a few brings again") {
  const Rows fails{Driven(Failed(0.5, 7), 1), Driven(Failed(0.5, 7), 2)};
  RepeatPlan alone({}, 500, 0.06);
  CHECK(alone.More({fails}).front() == 0);
  RepeatPlan plan({}, 500, 0.06);
  const Rows part{Driven(Ok(0.02, 6), 1, 1), Driven(Failed(0.5, 7), 2, 1)};
  CHECK(plan.More({part, fails}).back() > 0);
  // What was decided before is open again.
  RepeatPlan later({}, 500, 0.06);
  later.Add({fails});
  REQUIRE(later.HasFalsified());
  later.Add({part});
  CHECK_FALSE(later.HasFalsified());
}

TEST_CASE("What was falsified without chance stays so while no other setting shows any") {
  const Rows fails{Driven(Failed(0.5, 7), 1), Driven(Failed(0.5, 7), 2)};
  const Rows noisy{Driven(Ok(0.02, 8), 1, 1), Driven(Ok(0.03, 9), 2, 1)};
  RepeatPlan plan({}, 500, 0.06);
  plan.Add({fails});
  plan.Add({noisy});
  CHECK(plan.HasFalsified());
}

TEST_CASE("A passing setting exactly as near to the threshold as is doubtful is tried again") {
  Rows one{Driven(Ok(0.125), 1)};
  one[0].falsified = false;
  CHECK(RepeatPlan({.near_m = 0.125}, 1, 0.25).More({one}).front() > 0);
  CHECK(RepeatPlan({.near_m = 0.124}, 1, 0.25).More({one}).front() == 0);
}

TEST_CASE("Settings of a sweep with chance among a few runs are judged by each of their trials") {
  SweepResult result{.parameters = {{"p", {{"0", 0.0}, {"1", 1.0}}}}};
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    result.rows.push_back(Driven(Ok(0.02, 7), seed, 0));
  }
  Summarise(result);
  CHECK_FALSE(result.chance_repeats_runs);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kPassed);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    result.rows.push_back(Driven(seed < 3 ? Failed(0.5, 7) : Ok(0.02, 7), seed, 1));
  }
  Summarise(result);
  CHECK(result.chance_repeats_runs);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kNotSeenToFail);
  CHECK(result.settings[0].verdict.repeats == 8);
  CHECK(result.settings[1].verdict.repeats == 8);
  // A part of it keeps what the whole has shown.
  result.rows.resize(8);
  Summarise(result);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kNotSeenToFail);
}

TEST_CASE("Settings that passed by runs that chance brings again make no other need less") {
  const FalsifyOptions every{.repeat = Repeat::kEvery};
  const Rows part{Driven(Ok(0.02, 6), 1, 1), Driven(Failed(0.5, 7), 2, 1)};
  RepeatPlan fresh(every, 100, 0.06), later(every, 100, 0.06);
  for (int setting = 2; setting < 22; ++setting) {
    const Rows passed{Driven(Ok(0.02, 6), 1, setting), Driven(Ok(0.02, 6), 2, setting)};
    later.Add({passed});
  }
  fresh.Add({part});
  later.Add({part});
  Rows open;
  std::vector<int> of_fresh, of_later;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    open.push_back(Driven(Ok(0.02, 100 + seed), seed, 50));
    of_fresh.push_back(fresh.More({open}).front());
    of_later.push_back(later.More({open}).front());
  }
  CHECK(of_later == of_fresh);
}

}  // namespace
}  // namespace rift::sweep
