// "Where does it fail?": what is said where no trial has a gap, and where no value stands out.
#include <catch2/catch.hpp>

#include "rift/report/text/findings.hpp"
#include "synthetic_sweep.hpp"

namespace rift::report {
namespace {

/// A sweep over "a" and "b"; `fails(a, b)`: whether the two trials of a setting do, without a gap.
template <class Fails>
sweep::SweepResult Sweep(bool has_gaps, const Fails& fails) {
  sweep::SweepResult result;
  result.gap.threshold_m = 0.07;
  for (const char* name : {"a", "b"}) {
    result.parameters.push_back(
        {.key = name, .levels = {synthetic::Numeric("0"), synthetic::Numeric("1")}});
  }
  for (int i = 0; i < 8; ++i) {
    const int a = i / 4, b = i / 2 % 2;
    sweep::TrialRow row;
    row.theta = {result.parameters[0].levels[a], result.parameters[1].levels[b]};
    row.trial = std::to_string(1 + i % 2);
    row.falsified = fails(a, b);
    if (has_gaps) {
      row.comparison.gap_m = row.falsified ? 0.09 + 0.001 * i : 0.02;
    } else {
      row.status = row.falsified ? sweep::TrialStatus::kTimedOut : sweep::TrialStatus::kCrashed;
    }
    result.rows.push_back(row);
  }
  sweep::Summarise(result);
  return result;
}

std::string Where(const sweep::SweepResult& result) {
  std::string text;
  for (const Finding& finding : Findings(result, sweep::Explain(result))) {
    if (finding.question != "Where does it fail?") continue;
    for (const Sentence& sentence : finding.sentences) text += sentence.Text() + "\n";
  }
  return text;
}

TEST_CASE("Runs that never arrive fail somewhere, though none has a gap") {
  const std::string text = Where(Sweep(false, [](int a, int) { return a == 1; }));
  CHECK_THAT(text, Catch::Contains("One kind of failure"));
  CHECK_THAT(text, Catch::Contains("4 ended as 'timed_out'"));
  CHECK_THAT(text, !Catch::Contains("Not known") && !Catch::Contains("largest gap"));
  CHECK(Where(Sweep(false, [](int, int) { return false; })) == "Not known: no trial has a gap.\n");
}

/// The first sentence that answers the question.
std::string Answer(const sweep::SweepResult& result, const std::string& question) {
  for (const Finding& finding : Findings(result, sweep::Explain(result))) {
    if (finding.question == question) return finding.sentences.at(0).Text();
  }
  return "";
}

TEST_CASE("The robot's own scatter is told without a gap, and without a ratio where it has none") {
  const std::string question = "How much is the robot's own scatter?";
  sweep::SweepResult result = Sweep(false, [](int, int) { return true; });
  result.settings[0].noise_floor_m = 0.02;
  CHECK(Answer(result, question) ==
        "Repeats of one setting are 0.0200 m apart from each other (noise floor, mean of 1 "
        "setting); no trial has a gap to hold against that.");
  result = Sweep(true, [](int, int) { return true; });
  REQUIRE(result.all.mean_gap_m > 0.0);
  result.settings[0].noise_floor_m = 0.0;
  CHECK_THAT(Answer(result, question),
             Catch::Contains("setting); the mean gap to the candidate") && Catch::EndsWith(" m."));
}

TEST_CASE("A gap of nothing is made of nothing, and no share of it goes") {
  sweep::SweepResult result = Sweep(true, [](int, int) { return false; });
  for (sweep::TrialRow& row : result.rows) {
    row.comparison.gap_m = row.comparison.start_aligned_gap_m = row.comparison.shape_gap_m = 0.0;
  }
  sweep::Summarise(result);
  CHECK(Answer(result, "What is the gap made of?") ==
        "Mean gap over the settings 0.0000 m; with the first points laid together 0.0000 m; 0.0000 "
        "m is shape, left after the best rigid motion.");
}

TEST_CASE("Most and least are said of values that fail unequally often alone") {
  CHECK_THAT(Where(Sweep(true, [](int a, int b) { return a == 1 && b == 0; })),
             Catch::Contains("Most often at 1 (2 of 4 trials), least often at 0 (0 of 4 trials)") ||
                 Catch::Contains("Most often at a 1 (2 of 4 trials), least often at 0 (0 of 4"));
  const std::string all = Where(Sweep(true, [](int, int) { return true; }));
  CHECK_THAT(all, !Catch::Contains("Most often") && Catch::Contains("The largest gap"));
}

}  // namespace
}  // namespace rift::report
