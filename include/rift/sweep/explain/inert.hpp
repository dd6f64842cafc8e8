#pragma once

#include <string>
#include <vector>

#include "rift/sweep/explain/effects.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// Two values of a parameter, one after the other in its list, with everything else equal.
struct ValuePair {
  std::string a, b;
  int compared = 0;
  int identical = 0;  ///< the candidate drove the same path to the last bit
};

/// What a limit of the controller did while it had one value.
struct LimitUse {
  std::string level;
  double value = 0.0;
  int runs = 0;
  int runs_bound = 0;  ///< runs in which it changed a decision at all
  long decisions = 0;
  long bound = 0;            ///< decisions that it changed
  double largest_raw = 0.0;  ///< the most that the loop asked for
};

/// Whether a parameter did anything, and why not.
struct Inertness {
  std::string parameter;
  std::vector<ValuePair> pairs;
  int compared = 0;  ///< pairs of trials that differ in this parameter alone
  int identical = 0;
  double p = gap::kNotComputed;                      ///< of its effect (ParameterEffect)
  bool is_detected = false;                          ///< ParameterEffect::IsSeen
  double smallest_detectable_m = gap::kNotComputed;  ///< with 80 % power
  std::vector<LimitUse> candidate_limit;             ///< by value; empty for what is no limit
  std::vector<LimitUse> reference_limit;
  std::vector<std::string> sentences;

  /// It was tried and not one candidate path changed.
  bool NeverChangedAPath() const { return compared > 0 && identical == compared; }
  /// No effect is seen and the controller tells why: a value that never bound, or equal paths.
  bool IsInert() const { return !is_detected && (NeverChangedAPath() || is_explained); }
  bool is_explained = false;
};

/// One for each parameter with a list of values, in their order.
std::vector<Inertness> FindInert(const SweepResult& result, const Effects& effects);

}  // namespace rift::sweep
