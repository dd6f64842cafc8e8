#include "rift/gap/result.hpp"

#include <catch2/catch.hpp>
#include <limits>

#include "rift/gap/comparison.hpp"
#include "support/paths.hpp"

namespace rift::gap {
namespace {

TEST_CASE("Repeats that agree decide and repeats that do not are undecided") {
  CHECK(JudgeRepeats(std::vector{0.07, 0.08}, 0.06).verdict == Verdict::kFalsified);
  CHECK(JudgeRepeats(std::vector{0.05, 0.06}, 0.06).verdict == Verdict::kNotFalsified);
  CHECK(JudgeRepeats(std::vector{0.05, 0.07}, 0.06).verdict == Verdict::kUndecided);
  CHECK(JudgeRepeats(std::vector<double>{}, 0.06).verdict == Verdict::kUndecided);
}

TEST_CASE("A repeat without a gap has no vote") {
  const double missing = std::numeric_limits<double>::quiet_NaN();
  const RepeatVerdict verdict = JudgeRepeats(std::vector{0.07, missing}, 0.06);
  CHECK(verdict.verdict == Verdict::kFalsified);
  CHECK(verdict.repeats == 1);
}

TEST_CASE("The interval for the share of failing trials is that of Clopper and Pearson") {
  // 3 of 3 and 0 of 3: (alpha / 2)^(1/3) and its mirror image.
  const RepeatVerdict all = JudgeRepeats(std::vector{1.0, 1.0, 1.0}, 0.06);
  CHECK(all.share_low == Approx(std::cbrt(0.025)));
  CHECK(all.share_high == 1.0);
  const RepeatVerdict none = JudgeRepeats(std::vector{0.0, 0.0, 0.0}, 0.06);
  CHECK(none.share_low == 0.0);
  CHECK(none.share_high == Approx(1.0 - std::cbrt(0.025)));
  // 4 of 10 at 95 %: 0.1216 to 0.7376 (table of Clopper and Pearson).
  std::vector<double> gaps_m(10, 0.0);
  for (int i = 0; i < 4; ++i) gaps_m[i] = 1.0;
  const RepeatVerdict some = JudgeRepeats(gaps_m, 0.06);
  CHECK(some.share_low == Approx(0.1216).margin(5e-5));
  CHECK(some.share_high == Approx(0.7376).margin(5e-5));
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
