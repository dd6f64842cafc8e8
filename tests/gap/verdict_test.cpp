#include "rift/gap/result.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "rift/gap/comparison.hpp"
#include "support/inputs/paths.hpp"

namespace rift::gap {
namespace {

TEST_CASE("A setting is falsified or passed once its share of failures is shown") {
  CHECK(JudgeCounts(3, 3, {}).verdict == Verdict::kFalsified);
  CHECK(JudgeCounts(1, 1, {}).verdict == Verdict::kUndecided);
  CHECK(JudgeCounts(2, 20, {}).verdict == Verdict::kUndecided);
  CHECK(JudgeCounts(0, 3, {}).verdict == Verdict::kNotSeenToFail);
  CHECK(JudgeCounts(0, 100, {}).verdict == Verdict::kPassed);
  CHECK(JudgeCounts(1, 200, {}).verdict == Verdict::kPassed);
  CHECK(JudgeCounts(0, 0, {}).verdict == Verdict::kUndecided);
  CHECK(JudgeCounts(3, 3, {.share = 0.5}).verdict == Verdict::kUndecided);
}

TEST_CASE("A verdict holds at the confidence that is asked for, alone and among others") {
  // One failure of one trial speaks 3.94 times for a share above 0.1: enough for 1 / (1 - 0.746).
  for (const double confidence : {0.74, 0.75}) {
    INFO(confidence);
    const VerdictOptions options{.confidence = confidence};
    const RepeatVerdict alone = JudgeCounts(1, 1, options);
    const bool is_enough = confidence < 0.746;
    CHECK((alone.verdict == Verdict::kFalsified) == is_enough);
    CHECK((alone.share_low > 0.1) == is_enough);
    std::vector<RepeatVerdict> together{alone};
    JudgeTogether(together, 1, options);
    CHECK(together[0].verdict == alone.verdict);
    JudgeTogether(together, 500, options);
    CHECK(VerdictText(together[0]) ==
          (is_enough ? "undecided (1 of 1 trial fails, too few among so many settings)"
                     : "undecided (1 of 1 trial fails)"));
  }
}

TEST_CASE("The words of a verdict say how many trials or why") {
  CHECK(VerdictText(JudgeCounts(3, 3, {})) == "falsified");
  CHECK(VerdictText(JudgeCounts(0, 100, {})) == "passed");
  CHECK(VerdictText(JudgeCounts(0, 1, {})) == "not seen to fail (1 trial)");
  CHECK(VerdictText(JudgeCounts(1, 1, {})) == "undecided (1 of 1 trial fails)");
  CHECK(VerdictText(JudgeCounts(2, 20, {})) == "undecided (2 of 20 trials fail)");
  CHECK(VerdictText(JudgeCounts(0, 0, {})) == "undecided (no trial tells)");
}

TEST_CASE("The interval of a share never contradicts its verdict") {
  for (int repeats = 1; repeats <= 60; ++repeats) {
    for (int above = 0; above <= repeats; ++above) {
      const RepeatVerdict verdict = JudgeCounts(above, repeats, {});
      CHECK((verdict.verdict == Verdict::kFalsified) == (verdict.share_low > 0.1));
      CHECK((verdict.verdict == Verdict::kPassed) == (verdict.share_high < 0.1));
    }
  }
}

TEST_CASE("Among many settings one needs more failures and less once others are falsified too") {
  const auto judged = [](int failing, int settings) {
    std::vector<RepeatVerdict> verdicts(static_cast<size_t>(failing), JudgeCounts(4, 4, {}));
    JudgeTogether(verdicts, settings, {});
    return VerdictText(verdicts.front());
  };
  CHECK(judged(1, 1) == "falsified");
  CHECK(judged(1, 500) == "undecided (4 of 4 trials fail, too few among so many settings)");
  CHECK(judged(100, 500) == "falsified");
}

TEST_CASE("A repeat without a gap has no vote") {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const RepeatVerdict verdict = JudgeRepeats(std::vector{0.07, missing, 0.06}, 0.06);
  CHECK(verdict.above == 1);
  CHECK(verdict.repeats == 2);
}

TEST_CASE("The noise floor is the mean gap between every two real trials") {
  const trajectory::Trajectory path = test::StraightPath(1.0, 20);
  const std::vector<trajectory::Trajectory> reals{path, test::Moved(path, {0.0, 0.03, 0.0}),
                                                  test::Moved(path, {0.0, 0.06, 0.0})};
  CHECK(NoiseFloor_m(reals, {}) == Approx(0.04));
  CHECK(std::isnan(NoiseFloor_m(std::vector{path}, {})));
}

}  // namespace
}  // namespace rift::gap
