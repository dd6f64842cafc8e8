#pragma once

#include <string>
#include <vector>

#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A question that everybody asks of a sweep, and what its data answer, a sentence each.
struct Answer {
  std::string question;
  std::vector<std::string> sentences;
};

/// What the first screen of the page says, as plain text: where, because of what, how sure, what to
/// test next, what the gap is made of, the noise, what is missing.
std::vector<Answer> Answers(const sweep::SweepResult& result,
                            const sweep::Explanation& explanation);

}  // namespace rift::report
