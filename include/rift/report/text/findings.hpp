#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "rift/sweep/explain/explanation.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {

/// A part of a sentence, with the trials it speaks of as a query of the trials table:
/// "surface=ground&result=above%20threshold"; empty for words alone.
struct Piece {
  std::string text;
  std::string query;
};

/// Words of which the numbers lead to their rows.
class Sentence {
 public:
  Sentence() = default;
  Sentence(std::string text) { Say(std::move(text)); }  // NOLINT: a plain sentence is one
  Sentence& Say(std::string text) {
    pieces_.push_back({std::move(text), ""});
    return *this;
  }
  Sentence& Link(std::string text, std::string query) {
    pieces_.push_back({std::move(text), std::move(query)});
    return *this;
  }
  const std::vector<Piece>& pieces() const { return pieces_; }
  /// Without the links.
  std::string Text() const;

 private:
  std::vector<Piece> pieces_;
};

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

/// What the robot did at the settings that were suggested, and how many predicted failures it
/// confirmed; empty before any drive came back.
std::string RobotSentence(const sweep::SweepResult& result, const sweep::Explanation& explanation);

Headline Summary(const sweep::SweepResult& result);

/// How many trials of those counted ended how: "3 timed_out, 1 crashed".
std::string StatusCounts(const sweep::SweepResult& result,
                         const std::function<bool(const sweep::TrialRow&)>& is_counted);

/// How many settings are falsified, passed, not seen to fail, undecided, and by which rule.
Sentence VerdictCounts(const sweep::SweepResult& result);

/// Where, because of what, how sure, what next; then what the gap is made of, the noise, what is
/// missing.
std::vector<Finding> Findings(const sweep::SweepResult& result,
                              const sweep::Explanation& explanation);

/// One line for each trial without a gap: setting, trial, status, reason.
std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result);

}  // namespace rift::report
