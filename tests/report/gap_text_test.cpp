#include <catch2/catch.hpp>
#include <cmath>

#include "rift/report/text/text.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

/// Trials whose comparisons hold nothing but what a test sets.
gap::GapResult Trials(size_t count) {
  gap::GapResult result;
  result.trials.resize(count);
  for (size_t i = 0; i < count; ++i)
    result.trials[i].path = std::string(1, 'a' + static_cast<char>(i));
  return result;
}

TEST_CASE("Standing still is told from one per cent of the real way on, unless it was taken out") {
  for (const auto& [share, text] : {std::pair{0.0099, ""}, {0.0101, "1.0 %"}, {0.25, "25.0 %"}}) {
    gap::GapResult result = Trials(2);
    // The mean of the two.
    result.trials[0].comparison.real_standstill_share = share - 0.005;
    result.trials[1].comparison.real_standstill_share = share + 0.005;
    result.trials[0].comparison.sim_standstill_share = 0.9;
    const std::string said = std::string("standing still makes ") + text +
                             " of the real arc length; --trim-standstill takes it out\n";
    if (share < 0.01) {
      CHECK_THAT(GapText(result), !Contains("standing still"));
    } else {
      CHECK_THAT(GapText(result), Contains(said));
    }
    result.options.trim_standstill = true;
    CHECK_THAT(GapText(result), !Contains("standing still"));
  }
}

TEST_CASE(
    "A way that a robot may have driven within the standstill radius is not told as standing") {
  gap::GapResult result = Trials(1);
  result.trials[0].comparison.real_length_m = 0.5;
  result.trials[0].comparison.real_standstill_share = 0.04;  // 20 mm, 10 at either end
  CHECK_THAT(GapText(result), !Contains("standing still"));
  result.trials[0].comparison.real_standstill_share = 0.05;
  CHECK_THAT(GapText(result), Contains("standing still makes 5.0 % of the real arc length"));
}

TEST_CASE("Standing still is told of the side that stood, and of both where both did") {
  const auto text = [](double sim_share, double real_share) {
    gap::GapResult result = Trials(1);
    gap::Comparison& comparison = result.trials[0].comparison;
    comparison.sim_length_m = comparison.real_length_m = 2.0;
    comparison.sim_standstill_share = sim_share;
    comparison.real_standstill_share = real_share;
    return GapText(result);
  };
  const std::string end = " arc length; --trim-standstill takes it out\n";
  const std::string of_sim = "standing still makes 25.2 % of the simulated" + end,
                    of_real = "standing still makes 30.0 % of the real" + end;
  CHECK_THAT(text(0.252, 0.0), Contains(of_sim) && !Contains("real arc length"));
  CHECK_THAT(text(0.0, 0.3), Contains(of_real) && !Contains("simulated arc length"));
  CHECK_THAT(text(0.252, 0.3), Contains(of_sim + of_real));
  CHECK_THAT(text(0.0, 1.0), Contains("standing still makes 100.0 % of the real arc length; it "
                                      "never leaves --standstill-radius, 0.01 m\n"));
}

TEST_CASE("Yaw errors are the mean and the largest of the trials that tell their yaw") {
  gap::GapResult result = Trials(3);
  CHECK_THAT(GapText(result), !Contains("yaw error"));
  const double means_rad[] = {0.1, NAN, 0.3}, largest_rad[] = {0.9, 5.0, 0.8};
  for (size_t i = 0; i < 3; ++i) {
    result.trials[i].comparison.mean_yaw_error_rad = means_rad[i];
    result.trials[i].comparison.max_yaw_error_rad = largest_rad[i];
  }
  CHECK_THAT(GapText(result), Contains("yaw error: 0.200 rad in the mean, 0.900 rad at most\n"));
}

TEST_CASE("What would be left of the gap without its start and without any motion is a mean") {
  gap::GapResult result = Trials(2);
  for (size_t i = 0; i < 2; ++i) {
    result.trials[i].comparison.start_aligned_gap_m = 0.03 + 0.02 * static_cast<double>(i);
    result.trials[i].comparison.shape_gap_m = 0.01 + 0.01 * static_cast<double>(i);
  }
  CHECK_THAT(GapText(result), Contains("with the starts laid together the gap is 0.0400 m; after "
                                       "the best rigid motion 0.0150 m of shape are left\n"));
  result.noise_floor_m = NAN;
  CHECK_THAT(GapText(result), !Contains("noise floor"));
  result.noise_floor_m = 0.0123;
  CHECK_THAT(GapText(result), Contains("the real trials are 0.0123 m apart from each other\n"));
}

TEST_CASE("The table of a gap is as wide as its words where the logs' names are short") {
  gap::GapResult result = Trials(1);
  gap::Comparison& c = result.trials[0].comparison;
  c.gap_m = 0.0512;
  c.gap_u = 0.25;
  c.length_ratio = 1.03;
  const std::string text = GapText(result);
  INFO(text);
  CHECK_THAT(text, Contains("\n\nreal   gap_m    at_u  exact_m  mean_m   rms_m  median_m   p95_m  "
                            "start_m   end_m  length  hausdorff_m  frechet_m   dtw_m  "
                            "equal_time_m\na     0.0512   0.250        -"));
  result.trials[0].path = "robot";
  CHECK_THAT(GapText(result), Contains("\n\nreal    gap_m ") && Contains("\nrobot  0.0512 "));
}

}  // namespace
}  // namespace rift::report
