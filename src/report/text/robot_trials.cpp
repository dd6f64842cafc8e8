#include <fmt/format.h>

#include "rift/report/text/findings.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {
namespace {

/// Predictions of one kind, by what the robot's verdict says of them.
struct Tally {
  int predicted = 0, falsified = 0, passed = 0, unseen = 0, undecided = 0;

  void Add(const gap::RepeatVerdict& verdict) {
    ++predicted;
    falsified += verdict.verdict == gap::Verdict::kFalsified;
    passed += verdict.verdict == gap::Verdict::kPassed;
    unseen += verdict.verdict == gap::Verdict::kNotSeenToFail;
    undecided += verdict.verdict == gap::Verdict::kUndecided;
  }
};

std::string OthersText(const Tally& tally) {
  std::string text;
  const auto add = [&](int n, const char* words) {
    if (n > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, words);
  };
  add(tally.falsified, "falsified");
  add(tally.passed, "passed");
  add(tally.unseen, "not seen to fail");
  add(tally.undecided, "undecided");
  return text;
}

}  // namespace

std::string RobotSentence(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  Tally fails, holds;
  int trials = 0;
  const auto verdicts = sweep::JudgeRobotTrials(explanation.robot, result.judged_by);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const sweep::RobotTrials& driven = explanation.robot[i];
    if (driven.trials == 0) continue;
    trials += driven.trials;
    (driven.is_predicted_to_fail ? fails : holds).Add(verdicts[i]);
  }
  if (trials == 0) return "";
  std::string text;
  if (fails.predicted > 0) {
    const int confirmed = fails.falsified;
    fails.falsified = 0;
    const std::string others = OthersText(fails);
    text = fmt::format("{} of {} predicted failures confirmed by the robot (falsified){}{}",
                       confirmed, fails.predicted, others.empty() ? "" : ", the others: ", others);
  }
  if (holds.predicted > 0) {
    text += fmt::format("{}of {} predicted to hold: {}", text.empty() ? "" : "; ", holds.predicted,
                        OthersText(holds));
  }
  return fmt::format(
      "{}; {} drives in all; a prediction of the sweep holds with {:.0f} % probability", text,
      trials, 100.0 * explanation.suggestions.trusted);
}

}  // namespace rift::report
