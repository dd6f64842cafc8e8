#pragma once

#include <span>
#include <vector>

#include "rift/sweep/falsify/chance_among_runs.hpp"
#include "rift/sweep/falsify/options.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {

/// How many of the distinct trials that tell fail, judged alone. A setting of which several trials
/// with different seeds are identical does not depend on chance: every further trial would be the
/// same, and the one there is decides; unless `chance_repeats_runs` (ChanceAmongRuns).
gap::RepeatVerdict CountFailures(std::span<const TrialRow> rows, const gap::VerdictOptions& options,
                                 bool chance_repeats_runs = false);

/// How many trials of a setting, all of them failing, it takes to falsify the first of so many
/// settings.
int TrialsToFalsify(const gap::VerdictOptions& options, int settings);

/// Threshold minus mean loss: below zero is a failure. NaN when no row tells.
double Robustness_m(std::span<const TrialRow> rows, double threshold_m);

/// The settings of a search as they are tried: which of them are decided, and how many further
/// trials the others are worth. What it says depends on the trials alone.
class RepeatPlan {
 public:
  /// `settings`: how many are judged together, known before the first trial.
  RepeatPlan(const FalsifyOptions& options, int settings, double threshold_m)
      : options_(options), settings_(settings), threshold_m_(threshold_m) {}

  using Settings = std::vector<std::span<const TrialRow>>;

  /// Further trials of each setting of a batch: 0 for one that is decided, that has had
  /// most_repeats, or that no number of trials left could decide.
  std::vector<int> More(const Settings& batch);
  /// The settings of a batch are done.
  void Add(const Settings& batch);
  bool HasFalsified() const;

 private:
  /// Evidence about the share of failures, or what is needed of it.
  struct Evidence {
    std::vector<double> above, below;
    void Note(const gap::RepeatVerdict& verdict, double least);
  };
  /// Settings that were decided since their repeats are the same are open again once chance among
  /// a few runs is seen.
  void LookForChance(const Settings& batch);
  double Least() const;  ///< less decides nothing, however many others are decided
  double Needed(std::vector<double> evidence) const;  ///< by one more decision
  int Worth(std::span<const TrialRow> rows, const gap::RepeatVerdict& verdict, double above,
            double below) const;

  FalsifyOptions options_;
  int settings_;
  double threshold_m_;
  Evidence done_;
  ChanceAmongRuns chance_;
};

}  // namespace rift::sweep
