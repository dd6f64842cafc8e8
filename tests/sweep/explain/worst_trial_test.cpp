#include "rift/sweep/explain/worst_trial.hpp"

#include <catch2/catch.hpp>

#include "sweep/falsify/rows.hpp"

namespace rift::sweep {
namespace {

constexpr std::optional<double> kNoGap;

TEST_CASE("The worst trial has the largest gap, the first of equal ones") {
  CHECK(WorstTrial({{0.01, false}, {0.07, true}, {0.05, true}, {0.07, true}}) == 1u);
  CHECK(WorstTrial({{kNoGap, false}, {0.01, false}, {0.02, false}}) == 2u);
  CHECK(WorstTrial({{kNoGap, true}, {0.07, true}}) == 1u);
}

TEST_CASE("Where the largest gap does not fail, the worst trial is the first that does") {
  CHECK(WorstTrial({{0.02, false}, {kNoGap, false}, {kNoGap, true}, {kNoGap, true}}) == 2u);
  CHECK(WorstTrial({{0.05, false}, {0.02, true}}) == 1u);
  CHECK(WorstTrial({{kNoGap, true}}) == 0u);
}

TEST_CASE("Without a gap and without a failure no trial is the worst") {
  CHECK_FALSE(WorstTrial({}).has_value());
  CHECK_FALSE(WorstTrial({{kNoGap, false}}).has_value());
}

TEST_CASE("The worst row of a sweep fails where any does, though it has no gap") {
  SweepResult result;
  result.rows = {Ok(0.02), Failed(0.5), Ok(0.01)};
  CHECK(WorstTrialOf(result) == 1u);
  result.rows[2] = Ok(0.07);
  CHECK(WorstTrialOf(result) == 2u);
  CHECK_FALSE(WorstTrialOf({}).has_value());
}

}  // namespace
}  // namespace rift::sweep
