#include "rift/sweep/explain/suggest.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "rift/experiment/settable.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

using Catch::Matchers::Contains;

experiment::ParameterValue Numeric(double value) { return experiment::NumberValue(value); }

TrialRow Row(experiment::Theta theta, bool fails, std::uint64_t path) {
  TrialRow row{.theta = std::move(theta), .trial = std::to_string(path)};
  row.seed = path;
  row.comparison.gap_m = fails ? 0.08 : 0.04;
  row.falsified = fails;
  row.evidence.fingerprint = path;
  return row;
}

/// A floor that a person lays, a power that a person sets, a mismatch that nobody can set. On ice
/// every run fails, on ground none, on sand every second one.
SweepResult Sampled(int runs = 4) {
  SweepResult result;
  result.reference_kind = "nominal";
  result.parameters = {
      {.key = "simulation.terrain.surface", .levels = {{"ice", {}}, {"ground", {}}, {"sand", {}}}},
      {.key = "control.v_min", .min = 0.1, .max = 0.2},
      {.key = "simulation.motor.mismatch", .min = -0.1, .max = 0.1}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  std::uint64_t path = 1;
  for (const experiment::ParameterValue& surface : result.parameters[0].levels) {
    for (int i = 0; i < runs; ++i) {
      const bool fails = surface.text == "ice" || (surface.text == "sand" && i % 2 == 0);
      result.rows.push_back(
          Row({surface, Numeric(0.1496 + 0.0008 * even(random)), Numeric(0.2 * even(random) - 0.1)},
              fails, path++));
    }
  }
  Summarise(result);
  return result;
}

TEST_CASE("Only what a person can set is suggested, in steps that a person can set") {
  const SweepResult result = Sampled();
  const Suggestions suggestions = SuggestExperiments(result);
  CHECK(suggestions.settable == std::vector<int>{0, 1});
  REQUIRE_FALSE(suggestions.list.empty());
  for (const Suggestion& suggestion : suggestions.list) {
    REQUIRE(suggestion.values.size() == 2);
    CHECK(suggestion.values[1].text == "0.15");
    CHECK(suggestion.rows.size() == 4);
    CHECK_THAT(suggestion.sentence, !Contains("mismatch"));
  }
  CHECK_THAT(suggestions.note, Contains("as they are on the robot: mismatch"));
}

TEST_CASE("The space overrides what can be set and in which steps") {
  SweepResult result = Sampled();
  result.parameters[0].settable = false;
  result.parameters[1].settable = false;
  result.parameters[2].settable = true;
  result.parameters[2].step = 0.05;
  const Suggestions suggestions = SuggestExperiments(result, {.least_gain = 0.0});
  CHECK(suggestions.settable == std::vector<int>{2});
  for (const Suggestion& suggestion : suggestions.list) {
    const double steps = *suggestion.values[0].number / 0.05;
    CHECK(steps == Approx(std::round(steps)));
  }
  result.parameters[2].settable = false;
  CHECK(SuggestExperiments(result).list.empty());
  CHECK(SuggestExperiments(result).note ==
        "no parameter can be set on the robot (surface, v_min, mismatch): mark one that can in "
        "space, with settable: true");
}

TEST_CASE("Trials that take too little from the risk are not suggested") {
  // 200 runs of the robot itself tell: none of them is worth repeating.
  SweepResult result = Sampled(200);
  result.reference_kind = "logs";
  const Suggestions suggestions = SuggestExperiments(result);
  CHECK(suggestions.list.empty());
  CHECK_THAT(suggestions.note, Contains("none is worth a trial"));
  for (const Suggestion& suggestion : SuggestExperiments(Sampled()).list) {
    CHECK(suggestion.wrong_now - suggestion.wrong_after >= 3 * SuggestOptions{}.least_gain);
  }
}

TEST_CASE("Repeats of one setting outweigh none of those that a person sets alike") {
  SweepResult result;
  result.reference_kind = "logs";
  result.parameters = {{.key = "control.v_min", .min = 0.1, .max = 0.2},
                       {.key = "simulation.motor.mismatch", .min = -0.1, .max = 0.1}};
  std::uint64_t path = 1;
  // About 0.15 m/s 20 settings, of which one fails and was repeated; about 0.18 m/s one alone.
  for (int i = 0; i < 20; ++i) {
    const bool fails = i == 7;
    result.rows.push_back(Row({Numeric(0.15), Numeric(0.001 * i)}, fails, path++));
  }
  for (int i = 0; i < 4; ++i) {
    result.rows.push_back(Row({Numeric(0.15), Numeric(0.007)}, true, path++));
    result.rows.push_back(Row({Numeric(0.18), Numeric(0.0)}, i > 1, path++));
  }
  Summarise(result);
  result.falsification.emplace();
  const SuggestOptions options{.experiments = 9, .repeats = 20, .least_gain = 0.0};
  const Suggestions all = SuggestExperiments(result, options);
  REQUIRE(all.list.size() == 2);
  const Suggestion &many = all.list[0], &alone = all.list[1];  // the best first
  CHECK(many.values[0].text == "0.15");
  CHECK(many.rows.size() == 20);
  CHECK(many.failures == 1);
  CHECK_FALSE(many.is_predicted_to_fail);
  CHECK(many.mean_loss_m == Approx((19 * 0.04 + 0.08) / 20.0));
  CHECK(alone.rows.size() == 4);
  CHECK(alone.failures == 2);
  CHECK(alone.is_predicted_to_fail);
  // Of a grid a setting with one trial more or less is nothing that was repeated.
  result.falsification.reset();
  const Suggestions of_grid = SuggestExperiments(result, options);
  REQUIRE(of_grid.list.size() == 2);
  CHECK(of_grid.list[0].rows.size() == 21);
  CHECK(of_grid.list[0].failures == 2);
}

TEST_CASE("The best suggestion stands first, though places are kept for predicted failures") {
  // Of a failure with one run a trial takes less from the risk than of a setting that holds so far.
  SweepResult result = Sampled(12);
  const SuggestOptions options{.experiments = 3, .least_gain = 0.0};
  const std::vector<Suggestion> list = SuggestExperiments(result, options).list;
  REQUIRE(list.size() == 3);
  const auto gain = [](const Suggestion& one) { return one.wrong_now - one.wrong_after; };
  CHECK(gain(list[0]) >= gain(list[1]));
  CHECK(gain(list[1]) >= gain(list[2]));
  CHECK(std::count_if(list.begin(), list.end(),
                      [](const Suggestion& one) { return one.is_predicted_to_fail; }) == 2);
  CHECK_FALSE(list.front().is_predicted_to_fail);
}

TEST_CASE("Runs that are the same to the last bit are proposed once") {
  SweepResult result = Sampled();
  result.parameters[0].levels.push_back({"ice again", {}});
  for (int i = 0; i < 4; ++i) {
    TrialRow row = result.rows[static_cast<size_t>(i)];
    row.theta[0] = result.parameters[0].levels.back();
    result.rows.push_back(row);
  }
  Summarise(result);
  const Suggestions suggestions = SuggestExperiments(result, {.experiments = 20});
  std::set<std::string> surfaces;
  for (const Suggestion& suggestion : suggestions.list) surfaces.insert(suggestion.values[0].text);
  CHECK(surfaces.contains("ice"));
  CHECK_FALSE(surfaces.contains("ice again"));
  CHECK_THAT(suggestions.note, Contains("1 left out as the same runs to the last bit"));
}

TEST_CASE("The risk expected after more trials is what simulation finds") {
  const Suggestions suggestions = SuggestExperiments(Sampled(1), {.least_gain = 0.0});
  REQUIRE_FALSE(suggestions.list.empty());
  const Suggestion& suggestion = suggestions.list.front();
  const double q = gap::VerdictOptions{}.share;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  // The side, then the share within it, then three runs; called by which side is likelier of all
  // rounds with that count.
  std::array<int, 4> fails{}, holds{};
  const int rounds = 200'000;
  for (int i = 0; i < rounds; ++i) {
    const bool is_failing = even(random) < suggestion.fails_now;
    const double share = is_failing ? q + (1.0 - q) * even(random) : q * even(random);
    int failures = 0;
    for (int k = 0; k < 3; ++k) failures += even(random) < share;
    ++(is_failing ? fails : holds)[static_cast<size_t>(failures)];
  }
  int wrong = 0;
  for (size_t k = 0; k < 4; ++k) wrong += std::min(fails[k], holds[k]);
  CHECK(suggestion.wrong_after == Approx(double(wrong) / rounds).margin(0.005));
}

TEST_CASE("What the robot did counts and moves the trust in the other predictions") {
  const SweepResult result = Sampled();
  const Suggestions before = SuggestExperiments(result, {.experiments = 20});
  CHECK(before.trusted == 0.5);
  const auto of_ice = std::find_if(before.list.begin(), before.list.end(),
                                   [](const auto& one) { return one.values[0].text == "ice"; });
  REQUIRE(of_ice != before.list.end());
  const experiment::Theta ice = of_ice->values;
  const Suggestions confirmed =
      SuggestExperiments(result, {.experiments = 20}, {{ice, true, 3, 3}});
  CHECK(confirmed.trusted == Approx(2.0 / 3.0));
  for (const Suggestion& suggestion : confirmed.list) CHECK(suggestion.values != ice);  // decided
  const Suggestions refuted = SuggestExperiments(result, {.experiments = 20}, {{ice, true, 8, 0}});
  CHECK(refuted.trusted == Approx(1.0 / 3.0));
}

TEST_CASE("A value is rounded to the next step within its range") {
  using experiment::NearestSettable;
  const experiment::Parameter v_min{.key = "control.v_min", .min = 0.104, .max = 0.255};
  CHECK(NearestSettable(v_min, Numeric(0.17341)).text == "0.17");
  CHECK(NearestSettable(v_min, Numeric(0.1041)).text == "0.11");
  CHECK(NearestSettable(v_min, Numeric(0.2549)).text == "0.25");
  const auto step_of = [](double max) {
    return experiment::StepOf({.key = "own", .min = 0.0, .max = max});
  };
  CHECK(step_of(3.0) == Approx(0.2));  // 1, 2 or 5 times a power of ten, at most 20 steps
  CHECK(step_of(0.1) == Approx(0.005));
  CHECK(step_of(18.0) == Approx(1.0));
  CHECK(step_of(120.0) == Approx(10.0));
  const experiment::Parameter column{.key = "v_min", .min = 0.1, .max = 0.3};
  CHECK(experiment::IsSettable(column));
  CHECK_FALSE(experiment::IsSettable({.key = "simulation.motor.mismatch"}));
  CHECK(experiment::IsSettable({.key = "waypoints[2].x"}));
}

}  // namespace
}  // namespace rift::sweep
