#pragma once

#include <string>
#include <vector>

#include "rift/report/text/sentence.hpp"
#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A question everybody asks of a sweep, and the answer its data give.
struct Finding {
  std::string question;
  std::vector<Sentence> sentences;
};

enum class Outcome { kFails, kHolds, kUnknown };

struct Headline {
  Outcome outcome = Outcome::kUnknown;
  Sentence sentence;
};

Headline Summary(const sweep::SweepResult& result);

/// Where, because of what, how sure, what next; then what the gap is made of, the noise, what is
/// missing.
std::vector<Finding> Findings(const sweep::SweepResult& result,
                              const sweep::Explanation& explanation);

/// What matters, what does not, and why not.
Finding Because(const sweep::SweepResult& result, const sweep::Explanation& explanation);
/// Start, frame, shape, and what a better simulator could remove.
Finding MadeOf(const sweep::SweepResult& result, const sweep::Explanation& explanation);
/// The same part by part, in sentences of their own.
void SayParts(const sweep::Explanation& explanation, Finding* finding);
Finding BesideNoise(const sweep::SweepResult& result);
Finding NotMeasuredFinding(const sweep::SweepResult& result);

/// One line for each trial without a gap: setting, trial, status, reason.
std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result);

}  // namespace rift::report
