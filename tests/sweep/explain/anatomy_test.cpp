#include "rift/sweep/explain/anatomy.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::sweep {
namespace {

constexpr double kNan = gap::kNotComputed;

TrialRow Row(const char* level, double gap_m) {
  TrialRow row;
  row.theta = {{level, {}}};
  row.comparison.gap_m = gap_m;
  row.comparison.start_aligned_gap_m = gap_m - 0.020;
  row.comparison.shape_gap_m = gap_m - 0.025;
  row.comparison.frechet_m = gap_m - 0.003;
  row.comparison.equal_time_m = gap_m + 0.07;
  row.way_gap_m = gap_m - 0.004;
  row.falsified = row.CountedGap_m() > 0.06;
  return row;
}

/// Settings a, b and c with 1, 2 and 3 trials.
SweepResult Three() {
  SweepResult result;
  result.parameters = {{.key = "s", .levels = {{"a", {}}, {"b", {}}, {"c", {}}}}};
  result.rows = {Row("a", 0.03), Row("b", 0.05), Row("b", 0.07),
                 Row("c", 0.06), Row("c", 0.09), Row("c", 0.12)};
  Summarise(result);
  return result;
}

TEST_CASE("From three settings on the gap is the mean over settings with its interval") {
  const Anatomy anatomy = Dissect(Three());
  // Means 0.03, 0.06, 0.09: mean 0.06, sd 0.03; Student's 97.5 % quantile with two degrees.
  CHECK(anatomy.is_over_settings);
  CHECK(anatomy.gap_m.n == 3);
  CHECK(anatomy.gap_m.mean == Approx(0.06));
  CHECK(anatomy.gap_m.low == Approx(0.06 - 4.30265273 * 0.03 / std::sqrt(3.0)));
  CHECK(anatomy.gap_m.high == Approx(0.06 + 4.30265273 * 0.03 / std::sqrt(3.0)));
}

TEST_CASE("Below three settings the gap is the mean over trials") {
  SweepResult result = Three();
  std::erase_if(result.rows, [](const TrialRow& row) { return row.theta[0].text == "c"; });
  Summarise(result);
  CHECK_FALSE(Dissect(result).is_over_settings);
  CHECK(Dissect(result).gap_m.n == 3);
  CHECK(Dissect(result).gap_m.mean == Approx(0.05));
}

TEST_CASE("A setting without a value of a trial does not count as one") {
  SweepResult result = Three();
  result.rows[0].status = TrialStatus::kTimedOut;
  Summarise(result);
  const Anatomy anatomy = Dissect(result);  // two settings: their five trials
  CHECK(anatomy.gap_m.n == 5);
  CHECK(anatomy.gap_m.mean == Approx(0.39 / 5.0));
  // One that ended without a gap, before others of its setting, hides none of them.
  result = Three();
  result.rows[3].status = TrialStatus::kTimedOut;
  result.rows[3].falsified = true;
  Summarise(result);
  CHECK(Dissect(result).gap_m.n == 3);
  CHECK(Dissect(result).gap_m.mean == Approx((0.03 + 0.06 + 0.105) / 3.0));
  result = Three();
  result.rows[3].comparison.shape_gap_m = kNan;
  Summarise(result);
  CHECK(Dissect(result).shape_m.n == 3);
  CHECK(Dissect(result).shape_m.mean == Approx((0.03 + 0.06 + 0.105) / 3.0 - 0.025));
  // A setting of which no trial has a shape, before others that have one.
  result = Three();
  result.rows[0].comparison.shape_gap_m = kNan;
  Summarise(result);
  CHECK(Dissect(result).shape_m.n == 2);
  CHECK(Dissect(result).shape_m.mean == Approx((0.06 + 0.09) / 2.0 - 0.025));
}

TEST_CASE("Each part of the gap is the difference that its name says") {
  SweepResult result = Three();
  const Anatomy anatomy = Dissect(result);
  CHECK(anatomy.start_m.mean == Approx(0.020));
  CHECK(anatomy.frame_m.mean == Approx(0.005));
  CHECK(anatomy.shape_m.mean == Approx(0.035));
  CHECK(anatomy.pace_m.mean == Approx(0.003));
  CHECK(anatomy.timing_m.mean == Approx(0.07));
  CHECK(anatomy.goal_m.mean == Approx(0.004));
  REQUIRE(anatomy.parts.size() == 3);
  CHECK(anatomy.parts[0].name == "start placement");
  CHECK(anatomy.parts[0].size_m.mean == anatomy.start_m.mean);
  CHECK(anatomy.parts[1].name == "frame");
  CHECK(anatomy.parts[1].size_m.mean == anatomy.frame_m.mean);
  CHECK(anatomy.parts[2].name == "shape");
  CHECK(anatomy.parts[2].size_m.mean == anatomy.shape_m.mean);
  CHECK(anatomy.parts[1].remedy.find("camera") == std::string::npos);
  result.reference_kind = "logs";
  CHECK(Dissect(result).parts[1].remedy.find("camera") != std::string::npos);
}

TEST_CASE("Trials above the threshold by the end alone are counted, and those that fail are not") {
  SweepResult result = Three();
  CHECK(Dissect(result).only_at_goal == 0);
  result.rows[2].way_gap_m = 0.06;  // of 0.07 m
  result.rows[2].falsified = false;
  CHECK(Dissect(result).only_at_goal == 1);
  result.rows[3].falsified = false;  // 0.06 m is at the threshold
  CHECK(Dissect(result).only_at_goal == 1);
  result.rows[2].status = TrialStatus::kFell;
  CHECK(Dissect(result).only_at_goal == 0);
}

TEST_CASE("Noise and what can be removed are over the settings that have a noise floor") {
  SweepResult result = Three();
  result.settings[0].noise_floor_m = 0.010;
  result.settings[2].noise_floor_m = 0.020;
  const Anatomy anatomy = Dissect(result);
  CHECK(anatomy.noise_m.n == 2);
  CHECK(anatomy.noise_m.mean == Approx(0.015));
  CHECK(anatomy.removable_m.n == 2);
  CHECK(anatomy.removable_m.mean == Approx(0.5 * (0.02 + 0.07)));
}

/// Ten repeats of each setting, at "a" path 1 and at the others path 2 with its gap, where those
/// of `apart` differ by their repeat.
SweepResult Repeated(const std::vector<std::string>& settings, const std::string& apart = "") {
  SweepResult result;
  result.parameters = {{.key = "s"}};
  for (const std::string& setting : settings) {
    result.parameters[0].levels.push_back({setting, {}});
    for (std::uint64_t repeat = 0; repeat < 10; ++repeat) {
      const double own_m = setting == apart ? 0.001 * static_cast<double>(repeat) : 0.0;
      TrialRow row = Row(setting.c_str(), (setting == "a" ? 0.03 : 0.05) + own_m);
      row.trial = std::to_string(repeat + 1);
      row.seed = repeat + 1;
      row.evidence.fingerprint = setting == apart ? 100 + repeat : setting == "a" ? 1 : 2;
      result.rows.push_back(row);
    }
  }
  Summarise(result);
  for (SettingResult& setting : result.settings) {
    setting.noise_floor_m = setting.theta[0].text == "a" ? 0.01 : 0.02;
  }
  return result;
}

TEST_CASE("Repeats that are one run are one value, and where chance acts each is one") {
  const Anatomy same = Dissect(Repeated({"a", "b"}));
  CHECK(same.gap_m.n == 2);
  CHECK(same.gap_m.mean == Approx(0.04));
  // Student's 97.5 % quantile with one degree; the standard error of 0.03 and 0.05 is 0.01.
  CHECK(same.gap_m.high == Approx(0.04 + 12.7062047 * 0.01));
  CHECK(same.start_m.n == 2);
  CHECK(same.goal_m.n == 2);
  const Anatomy apart = Dissect(Repeated({"a", "b"}, "b"));
  CHECK(apart.gap_m.n == 11);
  CHECK(apart.gap_m.mean == Approx((0.03 + 10 * 0.0545) / 11.0));
  CHECK(apart.removable_m.n == 2);
  CHECK(apart.removable_m.mean == Approx(0.5 * (0.02 + 0.0345)));
}

TEST_CASE("Settings that are copies of one another are one") {
  const Anatomy copied = Dissect(Repeated({"a", "b", "c", "d"}));
  CHECK(copied.gap_m.n == 2);
  CHECK(copied.gap_m.mean == Approx(0.04));
  CHECK(copied.noise_m.n == 2);
  CHECK(copied.noise_m.mean == Approx(0.015));
  CHECK(copied.removable_m.n == 2);
  CHECK(copied.removable_m.mean == Approx(0.025));
  const Anatomy apart = Dissect(Repeated({"a", "b", "c", "d"}, "d"));
  CHECK(apart.gap_m.n == 3);
  CHECK(apart.noise_m.n == 3);
  CHECK(apart.gap_m.mean == Approx((0.03 + 0.05 + 0.0545) / 3.0));
}

TEST_CASE("The mean gap of a setting is that of its distinct runs, also against its noise") {
  SweepResult result = Repeated({"a", "b"}, "b");
  for (size_t i = 0; i < 19; ++i) {  // a log copied nine times over
    TrialRow copy = result.rows[10];
    result.rows.push_back(copy);
  }
  Summarise(result);
  for (SettingResult& setting : result.settings) setting.noise_floor_m = 0.01;
  const Anatomy anatomy = Dissect(result);
  CHECK(anatomy.gap_m.n == 11);
  CHECK(anatomy.removable_m.mean == Approx(0.5 * (0.02 + 0.0445)));
}

TEST_CASE("An estimate is clear when its interval lies on one side of zero") {
  CHECK(IsClear({0.2, 0.1, 0.3, 5}));
  CHECK(IsClear({-0.2, -0.3, -0.1, 5}));
  CHECK_FALSE(IsClear({0.1, -0.1, 0.3, 5}));
  CHECK_FALSE(IsClear({0.1, 0.0, 0.2, 5}));
  CHECK_FALSE(IsClear({-0.1, -0.2, 0.0, 5}));
  CHECK_FALSE(IsClear({0.1, kNan, kNan, 1}));
}

}  // namespace
}  // namespace rift::sweep
