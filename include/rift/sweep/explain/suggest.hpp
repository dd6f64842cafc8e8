#pragma once

#include <string>
#include <vector>

#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

struct SuggestOptions {
  int experiments = 5;
  int repeats = 3;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("experiments", self.experiments, 1, 1000, "how many are suggested");
    field("repeats", self.repeats, 1, 100, "further trials of a setting in one experiment");
  }
};

/// Further trials of one setting, and what they would decide: on which side of the threshold its
/// mean gap lies.
struct Suggestion {
  int setting = 0;  ///< index into SweepResult::settings
  int repeats = 0;  ///< further trials
  double mean_gap_m = gap::kNotComputed;
  double above_now = gap::kNotComputed;    ///< probability that the mean gap is above the threshold
  double wrong_now = gap::kNotComputed;    ///< risk that the mean so far is on the wrong side
  double wrong_after = gap::kNotComputed;  ///< the same, expected after the trials
  double flip = gap::kNotComputed;         ///< probability that they change the side
  double width_now = gap::kNotComputed;    ///< of the interval for the share above the threshold
  double width_after = gap::kNotComputed;  ///< expected
  /// Trials in all at which the side is known with 95 % confidence and 80 % power, were the mean
  /// so far the true one; -1: more than 1000.
  int trials_to_decide = -1;
  std::string sentence;
};

/// The trials from which most is learnt, the best first: each choice is the one that takes most
/// away from the risk of calling a setting wrongly, given the choices before it. Gaps of a setting
/// are taken for normal with one scatter for all settings, that of the repeats. Where no repeats
/// differ, risks are NaN: then the worst setting, and those next to the threshold.
std::vector<Suggestion> SuggestExperiments(const SweepResult& result,
                                           const SuggestOptions& options = {});

/// Scatter of the gap between repeats of one setting, over all settings; NaN without repeats.
double RepeatScatter_m(const SweepResult& result);

}  // namespace rift::sweep
