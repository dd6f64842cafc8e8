// Which rows tell that a parameter did nothing, and what its test could have seen, word by word.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "rift/sweep/explain/inert.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

/// Trials 1 and 2 at the first value, then at the second, each on a path of its own.
SweepResult Two(const std::string& key, const experiment::ParameterValue& first = {"1", 1.0}) {
  SweepResult result;
  result.parameters = {{.key = key, .levels = {first, {"2", 2.0}}}};
  for (const experiment::ParameterValue& level : result.parameters[0].levels) {
    for (const char* trial : {"1", "2"}) {
      TrialRow row{.theta = {level}, .trial = trial};
      row.evidence.fingerprint = result.rows.size() + 1;
      row.comparison.gap_m = 0.01 * static_cast<double>(result.rows.size());
      result.rows.push_back(row);
    }
  }
  return result;
}

TEST_CASE("A trial without a path, or without its like at the other value, is passed over") {
  SweepResult result = Two("x");
  result.rows[0].evidence.fingerprint = 0;
  const Inertness inert = FindInert(result, {})[0];
  CHECK(inert.compared == 1);
  CHECK(inert.identical == 0);
}

TEST_CASE("A limit with a word among its values is no number that could be cut") {
  SweepResult result = Two("control.v_max", {"slow", {}});
  for (TrialRow& row : result.rows) row.evidence.candidate_limits.emplace().decisions = 5;
  const Inertness inert = FindInert(result, {})[0];
  CHECK(inert.candidate_limit.empty());
  CHECK(inert.sentences.empty());
}

TEST_CASE("One run at a value tells of its limit, and binds with a single decision") {
  SweepResult result = Two("control.v_max");
  trial::LimitCounts& limits = result.rows[1].evidence.candidate_limits.emplace();
  limits.decisions = 40;
  limits.v_max = 1;
  const Inertness inert = FindInert(result, {})[0];
  REQUIRE(inert.candidate_limit.size() == 1);
  CHECK(inert.candidate_limit[0].runs == 1);
  CHECK(inert.candidate_limit[0].runs_bound == 1);
  CHECK(inert.candidate_limit[0].bound == 1);
}

Effects Measured(double p, double share_low, double sd_m, double df = 6.0) {
  Effects effects{.residual_df = df, .residual_sd_m = sd_m};
  effects.parameters = {
      {.parameter = 0, .name = "x", .share = 0.1, .share_low = share_low, .p = p}};
  return effects;
}

std::string TooFew(double range_m, double detectable_m) {
  return fmt::format(
      "the trials are too few to show a difference between two values of x: all gaps lie within "
      "{:.4f} m, and only one of {:.4f} m would be seen with 80 % probability",
      range_m, detectable_m);
}

std::string WouldBeSeen(double detectable_m) {
  return fmt::format(
      "a difference of {:.4f} m between two values of x would have been seen with 80 % probability",
      detectable_m);
}

using Sentences = std::vector<std::string>;

TEST_CASE("What a test could have seen is said beside the range of the gaps, up to all of it") {
  SweepResult result = Two("x");  // gaps from 0 to 0.03 m
  const auto sentences = [&result](const Effects& effects) {
    return FindInert(result, effects)[0].sentences;
  };
  const double wide_m = SmallestDetectable({2, 2}, 0.02, 6.0, 0.8),
               narrow_m = SmallestDetectable({2, 2}, 0.005, 6.0, 0.8);
  REQUIRE(wide_m > 0.03);
  REQUIRE(narrow_m < 0.03);
  CHECK(sentences(Measured(0.4, 0.0, 0.02)) == Sentences{TooFew(0.03, wide_m)});
  CHECK(sentences(Measured(0.4, 0.0, 0.005)) == Sentences{WouldBeSeen(narrow_m)});
  result.rows[3].comparison.gap_m = wide_m;
  CHECK(sentences(Measured(0.4, 0.0, 0.02)) == Sentences{WouldBeSeen(wide_m)});
}

TEST_CASE("Nothing is said of what a test could have seen where there was none or it was seen") {
  const SweepResult result = Two("x");
  const auto sentences = [&result](const Effects& effects) {
    return FindInert(result, effects)[0].sentences;
  };
  CHECK(sentences(Measured(std::nan(""), 0.0, 0.02)).empty());
  CHECK(sentences(Measured(0.01, 0.05, 0.02)).empty());
  CHECK(sentences(Measured(0.4, 0.0, 0.02, 0.0)).empty());  // nothing is left of the trials
}

TEST_CASE("Trials without a gap are none of its range, whichever come first") {
  SweepResult result = Two("x");
  result.rows[0].status = TrialStatus::kTimedOut;
  result.rows[0].comparison.gap_m = 5.0;
  const double detectable_m = SmallestDetectable({1, 2}, 0.02, 6.0, 0.8);
  CHECK(FindInert(result, Measured(0.4, 0.0, 0.02))[0].sentences ==
        Sentences{TooFew(0.02, detectable_m)});
  for (TrialRow& row : result.rows) {  // all of them fail without one
    row.status = TrialStatus::kTimedOut;
    row.falsified = true;
    row.left_m = 0.1;
  }
  CHECK(FindInert(result, Measured(0.4, 0.0, 0.02))[0].sentences ==
        Sentences{TooFew(0.0, SmallestDetectable({2, 2}, 0.02, 6.0, 0.8))});
}

TEST_CASE("A parameter of one value, and a range, are none that could have done nothing") {
  SweepResult result = Two("x");
  result.parameters[0].levels.pop_back();
  CHECK(FindInert(result, {}).empty());
  result.parameters[0] = {.key = "x", .min = 1.0, .max = 2.0};
  CHECK(FindInert(result, {}).empty());
}

}  // namespace
}  // namespace rift::sweep
