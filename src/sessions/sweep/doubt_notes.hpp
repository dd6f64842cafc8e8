#pragma once

#include <functional>
#include <map>
#include <set>
#include <string>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sessions {

/// Warns of each kind of doubt about a sweep's trajectories once: while it runs, when it is sure
/// enough, so that nobody waits for a night of trials in the wrong unit; the rest at its end.
class DoubtNotes {
 public:
  /// `kinds` tells what candidate and reference are; both arguments must outlive it.
  DoubtNotes(const sweep::SweepResult& kinds, std::function<void(const std::string&)> warn)
      : kinds_(kinds), warn_(std::move(warn)) {}

  void Seen(const sweep::TrialRow& row);
  void End(const sweep::SweepResult& result);

 private:
  const sweep::SweepResult& kinds_;
  std::function<void(const std::string&)> warn_;
  int told_ = 0;
  std::map<std::string, int> trials_;  ///< by kind
  std::set<std::string> said_;         ///< kinds
};

}  // namespace rift::sessions
