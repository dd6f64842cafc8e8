#pragma once

#include <string>
#include <vector>

#include "rift/sweep/result.hpp"

namespace rift::report {

/// A question everybody asks of a sweep, and the answer its data give.
struct Finding {
  std::string question;
  std::vector<std::string> sentences;
};

enum class Outcome { kFails, kHolds, kUnknown };

struct Headline {
  Outcome outcome = Outcome::kUnknown;
  std::string sentence;
};

Headline Summary(const sweep::SweepResult& result);

/// Where, because of what, how sure, beside what noise, what share is the start, what is missing.
std::vector<Finding> Findings(const sweep::SweepResult& result);

/// One line for each trial without a gap: setting, trial, status, reason.
std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result);

}  // namespace rift::report
