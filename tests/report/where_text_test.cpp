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

TEST_CASE("Most and least are said of values that fail unequally often alone") {
  CHECK_THAT(Where(Sweep(true, [](int a, int b) { return a == 1 && b == 0; })),
             Catch::Contains("Most often at 1 (2 of 4 trials), least often at 0 (0 of 4 trials)") ||
                 Catch::Contains("Most often at a 1 (2 of 4 trials), least often at 0 (0 of 4"));
  const std::string all = Where(Sweep(true, [](int, int) { return true; }));
  CHECK_THAT(all, !Catch::Contains("Most often") && Catch::Contains("The largest gap"));
}

}  // namespace
}  // namespace rift::report
