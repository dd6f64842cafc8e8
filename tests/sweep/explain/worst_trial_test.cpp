#include "rift/sweep/explain/worst_trial.hpp"

#include <catch2/catch.hpp>

#include "sweep/falsify/rows.hpp"

namespace rift::sweep {
namespace {

constexpr std::optional<double> kNoGap;

TEST_CASE("The worst trial fails with the largest loss, the first of equal ones") {
  CHECK(WorstTrial({{0.01, false}, {0.07, true, 0.07}, {0.1, true, 0.065}, {0.07, true, 0.07}}) ==
        1u);
  CHECK(WorstTrial({{0.07, true, 0.07}, {kNoGap, true, 0.5}, {kNoGap, true, 0.4}}) == 1u);
  CHECK(WorstTrial({{kNoGap, true, 0.065}, {0.07, true, 0.07}}) == 1u);
  CHECK(WorstTrial({{0.26, false}, {0.07, true, 0.07}, {0.201, true, 0.201}}) == 2u);
  CHECK(WorstTrial({{kNoGap, true, 0.1}}) == 0u);
}

TEST_CASE("Where no trial fails, the worst has the largest gap, the first of equal ones") {
  CHECK(WorstTrial({{kNoGap, false}, {0.01, false}, {0.02, false}, {0.02, false}}) == 2u);
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
  CHECK(WorstTrialOf(result) == 1u);  // a loss of 0.56 m: the threshold and the way left
  result.rows[2] = Ok(0.57);
  CHECK(WorstTrialOf(result) == 2u);
  CHECK_FALSE(WorstTrialOf({}).has_value());
}

}  // namespace
}  // namespace rift::sweep
