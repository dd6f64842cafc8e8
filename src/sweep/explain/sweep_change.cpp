#include "rift/sweep/explain/sweep_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <utility>

#include "rift/statistics/descriptive.hpp"

namespace rift::sweep {
namespace {

/// Its name, and which of the trials with it: a search repeats one trial with other seeds.
using TrialName = std::pair<std::string, int>;
using Trials = std::map<TrialName, const TabledTrial*>;

struct Setting {
  std::string text;
  Trials trials;
  std::map<std::string, int> named;  ///< trials of each name
};

std::map<std::string, Setting> BySetting(const TabledSweep& sweep) {
  std::map<std::string, Setting> settings;
  for (const TabledTrial& trial : sweep.trials) {
    Setting& setting = settings[trial.key];
    setting.text = trial.setting;
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

/// Whether all repeats of a setting are one run in both sweeps: nothing is left to chance there.
bool AreCopies(const std::vector<Pair>& pairs) {
  const auto are_same = [](const TabledTrial& a, const TabledTrial& b) {
    const bool have_same_gap = a.gap_m == b.gap_m || (std::isnan(a.gap_m) && std::isnan(b.gap_m));
    return have_same_gap && a.is_told == b.is_told && a.falsified == b.falsified;
  };
  return std::all_of(pairs.begin(), pairs.end(), [&](const Pair& pair) {
    return are_same(*pair.before, *pairs.front().before) &&
           are_same(*pair.after, *pairs.front().after);
  });
}

/// How many of the trials fail in one sweep only, copies once.
void CountChanges(const std::vector<Pair>& pairs, SweepChange* change) {
  const bool are_copies = AreCopies(pairs);
  for (const auto& [before, after] : pairs) {
    const bool has_changed =
        before->is_told && after->is_told && before->falsified != after->falsified;
    if (!has_changed) continue;
    if (are_copies && before != pairs.front().before) {
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
  Side all_before, all_after;
  std::vector<double> by_trial_m, by_setting_m;
  for (const auto& [key, setting] : earlier) {
    const auto found = later.find(key);
    if (found == later.end()) {
      ++change.only_before;
      continue;
    }
    SettingChange one{.setting = setting.text};
    Side side_before, side_after;
    side_before.Add(setting.trials);
    side_after.Add(found->second.trials);
    all_before.Add(setting.trials);
    all_after.Add(found->second.trials);
    one.before = side_before.Result(VerdictOf(before, key));
    one.after = side_after.Result(VerdictOf(after, key));
    const std::vector<Pair> pairs = PairsOf(setting.trials, found->second.trials);
    CountChanges(pairs, &change);
    const std::vector<double> differences_m = DifferencesOf(pairs);
    one.pairs = static_cast<int>(differences_m.size());
    SetChange(differences_m, &one);
    if (one.pairs > 0) by_setting_m.push_back(one.gap_change_m);
    by_trial_m.insert(by_trial_m.end(), differences_m.begin(), differences_m.end());
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
                .pairs = static_cast<int>(by_trial_m.size())};
  change.is_over_settings = by_setting_m.size() > 1;
  SetChange(change.is_over_settings ? by_setting_m : by_trial_m, &change.all);
  change.better_share_95 =
      statistics::ClopperPearson(change.now_hold, change.now_hold + change.now_fail, 0.95);
  std::stable_sort(change.settings.begin(), change.settings.end(),
                   [](const auto& a, const auto& b) { return ShareChange(a) > ShareChange(b); });
  return change;
}

}  // namespace rift::sweep
