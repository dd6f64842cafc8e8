#include "rift/sweep/falsify/result.hpp"

#include <catch2/catch.hpp>

namespace rift::sweep {
namespace {

experiment::Parameter Axis(const std::string& key, const std::vector<std::string>& texts,
                           bool numbers) {
  experiment::Parameter axis{.key = key};
  for (const std::string& text : texts) {
    axis.levels.push_back({text, numbers ? std::optional(std::stod(text)) : std::nullopt});
  }
  return axis;
}

/// Two surfaces, two speeds, two trials; the gap is 0.05 on ground and 0.07 on ice, +- 0.001.
SweepResult TwoSurfaces() {
  SweepResult result;
  result.parameters = {Axis("terrain.surface", {"ground", "ice"}, false),
                       Axis("control.v_min", {"0.15", "0.20"}, true)};
  for (const experiment::ParameterValue& surface : result.parameters[0].levels) {
    for (const experiment::ParameterValue& speed : result.parameters[1].levels) {
      for (int trial = 1; trial <= 2; ++trial) {
        TrialRow row{.theta = {surface, speed}, .trial = std::to_string(trial)};
        row.comparison.gap_m = (surface.text == "ground" ? 0.05 : 0.07) + 0.001 * (trial * 2 - 3);
        row.falsified = row.comparison.gap_m > result.gap.threshold_m;
        result.rows.push_back(row);
      }
    }
  }
  return result;
}

TEST_CASE("Means and failures and verdicts follow from the rows") {
  SweepResult result = TwoSurfaces();
  Summarise(result);
  CHECK(result.all.n == 8);
  CHECK(result.all.failures == 4);
  CHECK(result.all.mean_gap_m == Approx(0.06));
  const std::vector<LevelSummary> by_surface = SummariseBy(result, {0});
  REQUIRE(by_surface.size() == 2);
  CHECK(by_surface[0].level == "ground");
  CHECK(by_surface[0].failures == 0);
  CHECK(by_surface[1].failures == 4);
  CHECK(by_surface[1].mean_gap_m == Approx(0.07));
  REQUIRE(result.settings.size() == 4);
  CHECK(result.settings[0].verdict.verdict == gap::Verdict::kNotSeenToFail);
  CHECK(result.settings[3].verdict.verdict == gap::Verdict::kUndecided);
  CHECK(result.settings[3].verdict.above == 2);
}

TEST_CASE("A trial without a gap is counted and never averaged") {
  SweepResult result = TwoSurfaces();
  result.rows[0].status = TrialStatus::kMissing;
  result.rows[0].comparison = {};
  Summarise(result);
  CHECK(result.all.n == 7);
  CHECK(result.all.not_ok == 1);
  CHECK(result.anova[0].levels[0].n == 3);
  CHECK(result.settings[0].verdict.repeats == 1);
}

TEST_CASE("The worst settings are those that fail most often, then those that cost most") {
  SweepResult result = TwoSurfaces();
  result.rows[0].status = TrialStatus::kTimedOut;  // on ground, far from the goal
  result.rows[0].comparison = {};
  result.rows[0].falsified = true;
  result.rows[0].left_m = 0.5;
  result.rows[2].status = result.rows[3].status = TrialStatus::kMissing;  // of ground, v_min 0.20
  for (const int row : {6, 7}) {                                          // of ice, v_min 0.20
    result.rows[row].comparison.gap_m = 0.055 + 0.001 * row;
    result.rows[row].falsified = false;
  }
  const auto order = [&] {
    Summarise(result);
    std::vector<long> places;
    for (const SettingResult* setting : WorstSettings(result)) {
      places.push_back(setting - result.settings.data());
    }
    return places;
  };
  // Both of ice at 0.15 fail, one of ground; of ground at 0.20 nothing is known.
  CHECK(order() == std::vector<long>{2, 0, 1, 3});
  result.rows[5].falsified = false;
  CHECK(order() == std::vector<long>{0, 2, 1, 3});  // one of two each: what stopped costs more
}

TEST_CASE("The categorical parameter stands alone and the others are combined") {
  const SweepResult result = TwoSurfaces();
  std::vector<experiment::Parameter> parameters = result.parameters;
  std::swap(parameters[0], parameters[1]);
  parameters.push_back(Axis("v_max", {"0.3"}, true));
  const FactorSplit split = SplitFactors(parameters);
  CHECK(split.main_factor == 1);
  CHECK(split.others == std::vector<int>{0, 2});
  CHECK(split.others_name == "[v_min, v_max]");
  CHECK(CombinationLabel({{"a", {}}, {"0.30", 0.3}}, {0, 1}) == "[a, 0.30]");
  CHECK(CombinationLabel({{"a", {}}, {"0.30", 0.3}}, {1}) == "0.30");
}

TEST_CASE("Lists have levels and so have ranges of up to twelve whole numbers") {
  CHECK(HasLevels(Axis("v_min", {"0.15"}, true)));
  const auto range = [](double min, double max, bool is_integer) {
    return experiment::Parameter{.key = "n", .min = min, .max = max, .is_integer = is_integer};
  };
  CHECK(HasLevels(range(1, 12, true)));
  CHECK(HasLevels(range(-11, 0, true)));
  CHECK_FALSE(HasLevels(range(0, 12, true)));
  CHECK_FALSE(HasLevels(range(1, 3, false)));
}

TEST_CASE("A share that is near none or all is never told as none or all") {
  CHECK(PercentText(0.0) == "0 %");
  CHECK(PercentText(1.0) == "100 %");
  CHECK(PercentText(0.634) == "63 %");
  CHECK(PercentText(0.01) == "1 %");
  CHECK(PercentText(0.0033) == "0.33 %");
  CHECK(PercentText(0.99) == "99 %");
  CHECK(PercentText(299.0 / 300.0) == "99.67 %");
  CHECK(PercentText(1e-6) == "0.0001 %");
  CHECK(PercentText(1.0 - 4e-6) == "99.9996 %");
  CHECK(PercentText(1.0 - 1e-12) == "100 %");  // rounding errors are no runs
}

}  // namespace
}  // namespace rift::sweep
