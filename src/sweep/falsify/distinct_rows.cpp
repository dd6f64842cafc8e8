#include "rift/sweep/falsify/distinct_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <unordered_map>

#include "rift/sweep/falsify/copy_sets.hpp"

namespace rift::sweep {
namespace {

/// Rows that agree in it are copies: their noise, how they ended, and their setting but for the
/// parameter `without`, where there is one.
struct CopyKey {
  std::optional<size_t> without;
  experiment::Theta theta;
  std::string trial;
  std::optional<std::uint64_t> seed;
  TrialStatus status = TrialStatus::kOk;
  bool falsified = false;
  double gap_m = 0.0;

  bool operator<(const CopyKey& other) const { return Tied() < other.Tied(); }

 private:
  auto Tied() const
      -> std::tuple<const std::optional<size_t>&, const experiment::Theta&, const std::string&,
                    const std::optional<std::uint64_t>&, TrialStatus, bool, double> {
    return {without, theta, trial, seed, status, falsified, gap_m};
  }
};

CopyKey EndOf(const TrialRow& row) {
  return {.status = row.status,
          .falsified = row.falsified,
          .gap_m = row.IsOk() ? row.comparison.gap_m : 0.0};
}

bool AreSameRuns(const TrialRow& a, const TrialRow& b) {
  const CopyKey of_a = EndOf(a), of_b = EndOf(b);
  return a.evidence.fingerprint == b.evidence.fingerprint && !(of_a < of_b) && !(of_b < of_a);
}

/// Finds the copies among rows of one path.
class CopyFinder {
 public:
  CopyFinder(std::span<const TrialRow> rows, const std::vector<int>& indices,
             bool chance_repeats_runs)
      : rows_(rows),
        indices_(indices),
        chance_repeats_runs_(chance_repeats_runs),
        sets_(indices.size()) {
    for (size_t place = 0; place < indices.size(); ++place) {
      const TrialRow& row = At(place);
      const auto [found, is_new] = setting_of_.try_emplace(row.theta, settings_.size());
      if (is_new) settings_.emplace_back();
      Setting& setting = settings_[found->second];
      ++setting.repeats;
      setting.places.try_emplace({row.trial, row.seed}, place);
    }
  }

  void Find(const std::vector<size_t>& places) {
    std::map<std::pair<experiment::Theta, CopyKey>, std::vector<size_t>> by_setting;
    for (const size_t place : places) {
      const TrialRow& row = At(place);
      by_setting[{row.theta, EndOf(row)}].push_back(place);
    }
    Seen seen;
    for (const auto& [setting, repeats] : by_setting) {
      const bool are_all = repeats.size() == SettingOf(repeats.front()).repeats;
      for (const size_t place : repeats) {
        if (are_all && !chance_repeats_runs_) sets_.Join(repeats.front(), place);
        JoinByKeys(place, seen);
      }
    }
  }

  bool IsFirst(size_t place) { return sets_.IsFirst(place); }

 private:
  /// The rows of a setting.
  struct Setting {
    size_t repeats = 0;
    std::map<std::pair<std::string, std::optional<std::uint64_t>>, size_t> places;  ///< by noise
  };
  /// Of the rows with one key the first of each set.
  using Seen = std::map<CopyKey, std::vector<size_t>>;

  const TrialRow& At(size_t place) const { return rows_[indices_[place]]; }
  const Setting& SettingOf(size_t place) const {
    return settings_[setting_of_.at(At(place).theta)];
  }

  /// Whether no trial that the settings of both rows have parts them.
  bool AreSameSettings(size_t a, size_t b) {
    const std::pair<size_t, size_t> pair =
        std::minmax(setting_of_.at(At(a).theta), setting_of_.at(At(b).theta));
    const auto known = are_same_.find(pair);
    if (known != are_same_.end()) return known->second;
    const auto& others = settings_[pair.second].places;
    bool are_same = true;
    for (const auto& [noise, place] : settings_[pair.first].places) {
      const auto other = others.find(noise);
      are_same = are_same && (other == others.end() || AreSameRuns(At(place), At(other->second)));
    }
    return are_same_[pair] = are_same;
  }

  void JoinByKeys(size_t place, Seen& seen) {
    const TrialRow& row = At(place);
    CopyKey key = EndOf(row);
    key.theta = row.theta;
    key.seed = row.seed;
    Join(key, place, seen);  // another repeat of the setting, with the same seed or none
    key.trial = row.trial;
    for (size_t i = 0; i < row.theta.size(); ++i) {
      key.without = i;
      key.theta = row.theta;
      key.theta.erase(key.theta.begin() + static_cast<std::ptrdiff_t>(i));
      Join(key, place, seen);
    }
  }

  void Join(const CopyKey& key, size_t place, Seen& seen) {
    std::vector<size_t>& firsts = seen[key];
    for (const size_t first : firsts) {
      if (!AreSameSettings(first, place)) continue;
      sets_.Join(first, place);
      return;
    }
    firsts.push_back(place);
  }

  std::span<const TrialRow> rows_;
  const std::vector<int>& indices_;
  bool chance_repeats_runs_;
  CopySets sets_;
  std::map<experiment::Theta, size_t> setting_of_;
  std::vector<Setting> settings_;
  std::map<std::pair<size_t, size_t>, bool> are_same_;
};

/// Places in `indices` of the rows that share their path with another, by path.
std::unordered_map<std::uint64_t, std::vector<size_t>> SharedPaths(
    std::span<const TrialRow> rows, const std::vector<int>& indices) {
  std::unordered_map<std::uint64_t, std::vector<size_t>> by_path;
  for (size_t i = 0; i < indices.size(); ++i) {
    const std::uint64_t path = rows[indices[i]].evidence.fingerprint;
    if (path != 0) by_path[path].push_back(i);
  }
  std::erase_if(by_path, [](const auto& entry) { return entry.second.size() < 2; });
  return by_path;
}

}  // namespace

std::vector<int> DistinctRows(std::span<const TrialRow> rows, const std::vector<int>& indices,
                              bool chance_repeats_runs) {
  const auto shared = SharedPaths(rows, indices);
  if (shared.empty()) return indices;
  CopyFinder finder(rows, indices, chance_repeats_runs);
  for (const auto& [path, places] : shared) finder.Find(places);
  std::vector<int> distinct;
  for (size_t i = 0; i < indices.size(); ++i) {
    if (finder.IsFirst(i)) distinct.push_back(indices[i]);
  }
  return distinct;
}

std::vector<int> RowsThatCount(const SweepResult& result) {
  std::vector<int> rows;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    if (std::isfinite(Loss_m(result.rows[i], result.gap.threshold_m))) {
      rows.push_back(static_cast<int>(i));
    }
  }
  return DistinctRows(result.rows, rows, result.chance_repeats_runs);
}

}  // namespace rift::sweep
