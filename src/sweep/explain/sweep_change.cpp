#include "rift/sweep/explain/sweep_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/falsify/copy_sets.hpp"

namespace rift::sweep {
namespace {

/// Its name, and which of the trials with it: a search repeats one trial with other seeds.
using TrialName = std::pair<std::string, int>;
using Trials = std::map<TrialName, const TabledTrial*>;

struct Setting {
  std::string text;
  experiment::Theta theta;
  Trials trials;
  std::map<std::string, int> named;  ///< trials of each name
};

std::map<std::string, Setting> BySetting(const TabledSweep& sweep) {
  std::map<std::string, Setting> settings;
  for (const TabledTrial& trial : sweep.trials) {
    Setting& setting = settings[trial.key];
    setting.text = trial.setting;
    setting.theta = trial.theta;
    setting.trials[{trial.trial, setting.named[trial.trial]++}] = &trial;
  }
  return settings;
}

class Side {
 public:
  void Add(const Trials& trials) {
    for (const auto& [name, trial] : trials) {
      side_.told += trial->is_told;
      side_.failures += trial->is_told && trial->falsified;
      if (std::isfinite(trial->gap_m)) gaps_m_.push_back(trial->gap_m);
    }
  }
  ChangedSide Result(const std::string& verdict) {
    side_.mean_gap_m = statistics::Mean(gaps_m_);
    side_.verdict = verdict;
    return side_;
  }

 private:
  ChangedSide side_;
  std::vector<double> gaps_m_;
};

std::string VerdictOf(const TabledSweep& sweep, const std::string& key) {
  const auto found = sweep.verdicts.find(key);
  return found == sweep.verdicts.end() ? "" : found->second;
}

/// One trial in both sweeps.
struct Pair {
  const TabledTrial* before;
  const TabledTrial* after;
};

/// Those of one setting, by their names.
std::vector<Pair> PairsOf(const Trials& before, const Trials& after) {
  std::vector<Pair> pairs;
  for (const auto& [name, earlier] : before) {
    const auto found = after.find(name);
    if (found != after.end()) pairs.push_back({earlier, found->second});
  }
  return pairs;
}

/// How a trial ended in both sweeps.
using Ends = std::array<std::tuple<bool, bool, std::optional<double>>, 2>;

Ends EndsOf(const Pair& pair) {
  const auto end = [](const TabledTrial& trial) {
    const bool has_gap = !std::isnan(trial.gap_m);
    return std::tuple(trial.is_told, trial.falsified,
                      has_gap ? std::optional(trial.gap_m) : std::nullopt);
  };
  return {end(*pair.before), end(*pair.after)};
}

/// Whether all repeats of a setting are one run in both sweeps: nothing is left to chance there.
bool AreCopies(const std::vector<Pair>& pairs) {
  return std::all_of(pairs.begin(), pairs.end(),
                     [&](const Pair& pair) { return EndsOf(pair) == EndsOf(pairs.front()); });
}

/// A setting of both sweeps.
struct Both {
  const std::string& key;
  const Setting &before, &after;
  std::vector<Pair> pairs;
};

/// Settings that differ in one parameter and agree trial by trial in both sweeps: it does nothing
/// there.
CopySets CopiedSettings(const std::vector<Both>& settings) {
  using Trial = std::pair<std::string, Ends>;
  using Key = std::tuple<size_t, experiment::Theta, std::vector<Trial>>;
  std::map<Key, size_t> seen;
  CopySets sets(settings.size());
  for (size_t i = 0; i < settings.size(); ++i) {
    std::vector<Trial> trials;
    for (const Pair& pair : settings[i].pairs) {
      trials.emplace_back(pair.before->trial, EndsOf(pair));
    }
    if (trials.empty()) continue;
    const experiment::Theta& theta = settings[i].before.theta;
    for (size_t without = 0; without < theta.size(); ++without) {
      experiment::Theta others = theta;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(without));
      sets.Join(i, seen.try_emplace({without, std::move(others), trials}, i).first->second);
    }
  }
  return sets;
}

/// How many of the trials fail in one sweep only, copies once; none of a setting that is one.
void CountChanges(const std::vector<Pair>& pairs, bool is_copy, SweepChange* change) {
  const bool are_copies = AreCopies(pairs);
  for (const auto& [before, after] : pairs) {
    const bool has_changed =
        before->is_told && after->is_told && before->falsified != after->falsified;
    if (!has_changed) continue;
    if (is_copy || (are_copies && before != pairs.front().before)) {
      ++change->copies;
    } else {
      ++(before->falsified ? change->now_hold : change->now_fail);
    }
  }
}

std::vector<double> DifferencesOf(const std::vector<Pair>& pairs) {
  std::vector<double> differences_m;
  for (const auto& [before, after] : pairs) {
    const double difference_m = after->gap_m - before->gap_m;
    if (std::isfinite(difference_m)) differences_m.push_back(difference_m);
  }
  return differences_m;
}

void SetChange(const std::vector<double>& differences_m, SettingChange* change) {
  change->gap_change_m = statistics::Mean(differences_m);
  change->gap_change_95_m = statistics::MeanInterval(differences_m, 0.95);
}

double ShareChange(const SettingChange& change) {
  const auto share = [](const ChangedSide& side) {
    return side.told == 0 ? 0.0 : static_cast<double>(side.failures) / side.told;
  };
  return std::abs(share(change.after) - share(change.before));
}

}  // namespace

SweepChange CompareSweeps(const TabledSweep& before, const TabledSweep& after,
                          std::vector<ChangedKey> keys) {
  SweepChange change{.before = before.folder, .after = after.folder, .keys = std::move(keys)};
  const std::map<std::string, Setting> earlier = BySetting(before), later = BySetting(after);
  std::vector<Both> both;
  for (const auto& [key, setting] : earlier) {
    const auto found = later.find(key);
    if (found == later.end()) {
      ++change.only_before;
      continue;
    }
    both.push_back({key, setting, found->second, PairsOf(setting.trials, found->second.trials)});
  }
  CopySets copies = CopiedSettings(both);
  Side all_before, all_after;
  int pairs = 0;
  std::vector<double> by_trial_m, by_setting_m;
  for (size_t i = 0; i < both.size(); ++i) {
    const Both& setting = both[i];
    SettingChange one{.setting = setting.before.text};
    Side side_before, side_after;
    side_before.Add(setting.before.trials);
    side_after.Add(setting.after.trials);
    all_before.Add(setting.before.trials);
    all_after.Add(setting.after.trials);
    one.before = side_before.Result(VerdictOf(before, setting.key));
    one.after = side_after.Result(VerdictOf(after, setting.key));
    CountChanges(setting.pairs, !copies.IsFirst(i), &change);
    const std::vector<double> differences_m = DifferencesOf(setting.pairs);
    one.pairs = static_cast<int>(differences_m.size());
    pairs += one.pairs;
    SetChange(differences_m, &one);
    if (copies.IsFirst(i)) {
      if (one.pairs > 0) by_setting_m.push_back(one.gap_change_m);
      by_trial_m.insert(by_trial_m.end(), differences_m.begin(), differences_m.end());
    }
    change.settings.push_back(std::move(one));
  }
  if (change.settings.empty()) {
    throw std::invalid_argument(
        fmt::format("{} and {} have no setting in common: nothing can be "
                    "compared",
                    before.folder, after.folder));
  }
  change.only_after = static_cast<int>(later.size() - change.settings.size());
  change.all = {.setting = "all",
                .before = all_before.Result(""),
                .after = all_after.Result(""),
                .pairs = pairs};
  change.is_over_settings = by_setting_m.size() > 1;
  SetChange(change.is_over_settings ? by_setting_m : by_trial_m, &change.all);
  change.better_share_95 =
      statistics::ClopperPearson(change.now_hold, change.now_hold + change.now_fail, 0.95);
  std::stable_sort(change.settings.begin(), change.settings.end(),
                   [](const auto& a, const auto& b) { return ShareChange(a) > ShareChange(b); });
  return change;
}

}  // namespace rift::sweep
