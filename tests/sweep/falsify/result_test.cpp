#include "rift/sweep/falsify/result.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "sweep/falsify/rows.hpp"

namespace rift::sweep {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_CASE("What counts is the smaller of both gaps, or the one there is") {
  TrialRow row = Ok(0.09);
  CHECK(row.CountedGap_m() == 0.09);
  row.way_gap_m = 0.04;
  CHECK(row.CountedGap_m() == 0.04);
  row.way_gap_m = 0.12;
  CHECK(row.CountedGap_m() == 0.09);
}

TEST_CASE("A loss is the gap that counts, or the threshold and the way left, or nothing") {
  TrialRow short_of_goal = Ok(0.09);
  short_of_goal.way_gap_m = 0.03;
  CHECK(Loss_m(short_of_goal, 0.06) == 0.03);
  CHECK(Loss_m(Failed(0.5), 0.06) == Approx(0.56));
  CHECK(Loss_m(Failed(0.0), 0.06) == Approx(0.06));
  CHECK(Loss_m(Failed(kNan), 0.07) == Approx(0.14));
  TrialRow untold = Failed(0.5);
  untold.falsified = false;
  CHECK(std::isnan(Loss_m(untold, 0.06)));
  CHECK_FALSE(untold.Tells());
  CHECK(Failed(0.5).Tells());
  CHECK(Ok(0.01).Tells());
}

TEST_CASE("The worst row is the first with the largest gap, and has one") {
  SweepResult result;
  CHECK_FALSE(WorstRow(result));
  result.rows = {Failed(9.0)};
  CHECK_FALSE(WorstRow(result));
  result.rows = {Failed(9.0), Ok(0.02), Ok(0.05), Ok(0.05), Ok(0.03)};
  CHECK(WorstRow(result) == 2);
  result.rows[1].comparison.gap_m = 0.2;
  CHECK(WorstRow(result) == 1);
  result.rows[4].comparison.gap_m = 0.3;
  CHECK(WorstRow(result) == 4);
}

const experiment::Parameter kRange{.key = "control.v_min", .min = 0.0, .max = 1.0};
const experiment::Parameter kWords{.key = "surface", .levels = {{"ice", {}}, {"rock", {}}}};
const experiment::Parameter kNumbers{.key = "a.b.count", .levels = {{"0.123456", 0.123456}}};

TEST_CASE("A value of a range is shortened for people, and one of a list stands as written") {
  CHECK(ShortText(kRange, {"0.12345678", 0.12345678}) == "0.1235");
  CHECK(ShortText(kRange, {"word", {}}) == "word");
  const experiment::Parameter far{.key = "a", .min = 1e6, .max = 1e6 + 10.0};
  CHECK(ShortText(far, experiment::NumberValue(1e6 + 4.25)) == "1000004.25");
  const experiment::Parameter below{.key = "a", .min = -120.0, .max = -119.0};
  CHECK(ShortText(below, experiment::NumberValue(-119.123456)) == "-119.123");
  // The end that is further from 0 has three digits in front of the point, the other has two.
  const experiment::Parameter left{.key = "a", .min = -100.4, .max = -99.4},
      right{.key = "a", .min = 99.4, .max = 100.4};
  CHECK(ShortText(left, experiment::NumberValue(-99.712345)) == "-99.7123");
  CHECK(ShortText(right, experiment::NumberValue(99.712345)) == "99.7123");
  // No double has more than 17 digits that tell.
  const experiment::Parameter narrow{.key = "a", .min = 1.0, .max = 1.0 + 0x1p-48};
  CHECK(ShortText(narrow, experiment::NumberValue(1.0 + 0x5p-51)) == "1.0000000000000022");
  const experiment::Parameter point{.key = "a", .min = 0.25, .max = 0.25};
  CHECK(ShortText(point, experiment::NumberValue(0.25)) == "0.25");
  CHECK(ShortText(kNumbers, {"0.123456", 0.123456}) == "0.123456");
  CHECK(ShortText(kWords, {"ice", {}}) == "ice");
}

TEST_CASE("A setting is told by the last names of its parameters, in their order") {
  CHECK(SettingText({kWords, kRange, kNumbers},
                    {{"ice", {}}, {"0.5", 0.5}, {"0.123456", 0.123456}}) ==
        "surface ice, v_min 0.5, count 0.123456");
  CHECK(SettingText({kRange}, {{"0.25", 0.25}}) == "v_min 0.25");
  CHECK(SettingText({}, {}) == "the only setting");
}

TEST_CASE("Without words the first parameter stands alone, and one parameter has no others") {
  const FactorSplit numbers = SplitFactors({kNumbers, kRange});
  CHECK(numbers.main_factor == 0);
  CHECK(numbers.others == std::vector<int>{1});
  CHECK(numbers.others_name == "v_min");
  const FactorSplit one = SplitFactors({kWords});
  CHECK(one.main_factor == 0);
  CHECK(one.others.empty());
  CHECK(one.others_name.empty());
  const FactorSplit last = SplitFactors({kNumbers, kRange, kWords});
  CHECK(last.main_factor == 2);
  CHECK(last.others == std::vector<int>{0, 1});
  CHECK(last.others_name == "[count, v_min]");
  CHECK_THROWS_WITH(SplitFactors({}), "the space has no parameters");
  CHECK(MainLevel({kNumbers, kWords}, {{"0.123456", 0.123456}, {"rock", {}}}) == "rock");
  CHECK(MainLevel({}, {}).empty());
  CHECK(CombinationLabel({{"a", {}}, {"b", {}}, {"c", {}}}, {2, 0}) == "[c, a]");
  CHECK(CombinationLabel({{"a", {}}}, {}) == "[]");
  // Values that hold a comma are quoted: labels that differ are of combinations that differ.
  CHECK(CombinationLabel({{"oil", {}}, {"wet, dry", {}}}, {0, 1}) == "[oil, \"wet, dry\"]");
  CHECK(CombinationLabel({{"oil, wet", {}}, {"dry", {}}}, {0, 1}) == "[\"oil, wet\", dry]");
  CHECK(CombinationLabel({{"3\"", {}}, {"a", {}}}, {0, 1}) == "[\"3\"\"\", a]");
  CHECK(CombinationLabel({{"oil, wet", {}}, {"dry", {}}}, {0}) == "oil, wet");
}

/// Settings x = 1 and x = 2, 3 and 4 trials of unequal gaps.
SweepResult Uneven() {
  SweepResult result;
  result.parameters = {{.key = "x", .levels = {{"1", 1.0}, {"2", 2.0}}},
                       {.key = "y", .levels = {{"0", 0.0}}}};
  const auto add = [&](int level, TrialRow row) {
    row.theta = {result.parameters[0].levels[static_cast<size_t>(level)], {"0", 0.0}};
    result.rows.push_back(row);
  };
  add(1, Ok(0.070, 1));
  add(0, Ok(0.010, 2));
  add(1, Ok(0.080, 3));
  add(0, Ok(0.020, 4));
  add(1, Failed(0.2));
  add(0, Ok(0.020, 4));  // the same run again
  TrialRow missing;
  missing.status = TrialStatus::kMissing;
  add(1, missing);
  Summarise(result);
  return result;
}

TEST_CASE("Counts of a level are of its trials with a gap, that fail, that tell and without one") {
  const SweepResult result = Uneven();
  const std::vector<LevelSummary> levels = SummariseBy(result, {0});
  REQUIRE(levels.size() == 2);
  CHECK(levels[0].level == "2");  // in the order of the rows
  CHECK(levels[0].n == 2);
  CHECK(levels[0].failures == 3);
  CHECK(levels[0].told == 3);
  CHECK(levels[0].not_ok == 2);
  CHECK(levels[0].mean_gap_m == Approx(0.075));
  CHECK(levels[0].sd_gap_m == Approx(0.01 / std::sqrt(2.0)));
  CHECK(levels[1].n == 3);
  CHECK(levels[1].failures == 0);
  CHECK(levels[1].told == 3);
  CHECK(levels[1].not_ok == 0);
  CHECK(levels[1].mean_gap_m == Approx(0.05 / 3.0));
  CHECK(result.all.level == "all");
  CHECK(result.all.n == 5);
  CHECK(result.all.told == 6);
  CHECK(result.all.not_ok == 2);
  CHECK(result.all.failures == 3);
}

TEST_CASE("A setting has the mean gap of its trials and the loss of the distinct ones") {
  const SweepResult result = Uneven();
  REQUIRE(result.settings.size() == 2);
  const SettingResult &two = result.settings[0], &one = result.settings[1];
  CHECK(two.rows == std::vector<int>{0, 2, 4, 6});
  CHECK(one.rows == std::vector<int>{1, 3, 5});
  CHECK(two.theta[0].text == "2");
  CHECK(two.mean_gap_m == Approx(0.075));
  CHECK(two.mean_loss_m == Approx((0.07 + 0.08 + 0.26) / 3.0));
  CHECK(one.mean_gap_m == Approx(0.05 / 3.0));
  CHECK(one.mean_loss_m == Approx(0.015));
  CHECK(one.loss_m.low == Approx(0.015 - 12.7062047362 * 0.005));  // Student, one degree
  CHECK(one.loss_m.high == Approx(0.015 + 12.7062047362 * 0.005));
  CHECK(two.verdict.above == 3);
  CHECK(two.verdict.repeats == 3);
  CHECK(one.verdict.above == 0);
  CHECK(one.verdict.repeats == 2);
  CHECK(two.verdict.settings == 2);
}

TEST_CASE("As many settings are judged together as were planned, and never fewer than there are") {
  SweepResult result = Uneven();
  result.judged_settings = 500;
  Summarise(result);
  CHECK(result.settings[0].verdict.settings == 500);
  CHECK(result.Count(gap::Verdict::kUndecided) == 1);  // three failures are too few for that
  CHECK(result.Count(gap::Verdict::kFalsified) == 0);
  result.judged_settings = 1;
  Summarise(result);
  CHECK(result.settings[0].verdict.settings == 2);
  CHECK(result.Count(gap::Verdict::kUndecided) == 0);
  CHECK(result.Count(gap::Verdict::kNotSeenToFail) == 1);
  CHECK(result.Count(gap::Verdict::kFalsified) == 1);
  CHECK(result.anova.size() == 1);  // however often it is summarised
}

TEST_CASE("The variance is analysed for each list of several values, by the losses that count") {
  const SweepResult result = Uneven();
  REQUIRE(result.anova.size() == 1);  // y has one value
  const Anova& x = result.anova[0];
  CHECK(x.parameter == "x");
  CHECK(x.levels.size() == 2);
  CHECK(x.df_between == 1.0);
  CHECK(x.df_within == 3.0);  // 3 losses of x = 2 and 2 distinct ones of x = 1
  // By hand: means 0.41/3 and 0.015, squares within 0.0225666... + 0.00005.
  const double within =
      2.0 * 0.0001 / 4.0 +
      (std::pow(0.07 - 0.41 / 3, 2) + std::pow(0.08 - 0.41 / 3, 2) + std::pow(0.26 - 0.41 / 3, 2));
  const double between = 3.0 * 2.0 / 5.0 * std::pow(0.41 / 3 - 0.015, 2);
  CHECK(x.f == Approx(between / (within / 3.0)));
  CHECK(x.eta_squared == Approx(between / (between + within)));
}

TEST_CASE("Values whose texts hold a comma are groups of their own") {
  SweepResult result;
  result.parameters = {{.key = "a", .levels = {{"1, 2", {}}, {"1", {}}}},
                       {.key = "b", .levels = {{"3", {}}, {"2, 3", {}}}}};
  for (const auto& theta :
       {experiment::Theta{{"1, 2", {}}, {"3", {}}}, experiment::Theta{{"1", {}}, {"2, 3", {}}}}) {
    result.rows.push_back(Ok(0.01));
    result.rows.back().theta = theta;
  }
  CHECK(SummariseBy(result, {0, 1}).size() == 2);
}

TEST_CASE("The names of how a trial ended are those of the tables") {
  const auto names = EnumNames(TrialStatus{});
  const auto name = [&](TrialStatus status) { return names[static_cast<size_t>(status)]; };
  CHECK(name(TrialStatus::kOk) == "ok");
  CHECK(name(TrialStatus::kMissing) == "missing");
  CHECK(name(TrialStatus::kUnreadable) == "unreadable");
  CHECK(name(TrialStatus::kTimedOut) == "timed_out");
  CHECK(name(TrialStatus::kFell) == "fell");
  CHECK(name(TrialStatus::kLeftArena) == "left_arena");
  CHECK(name(TrialStatus::kLost) == "lost");
  CHECK(name(TrialStatus::kFault) == "fault");
  CHECK(name(TrialStatus::kInvalid) == "invalid");
  CHECK(name(TrialStatus::kNan) == "nan");
  CHECK(name(TrialStatus::kHung) == "hung");
  CHECK(name(TrialStatus::kCrashed) == "crashed");
  CHECK(name(TrialStatus::kOutOfMemory) == "out_of_memory");
}

}  // namespace
}  // namespace rift::sweep
