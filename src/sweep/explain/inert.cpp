#include "rift/sweep/explain/inert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "expansion.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

constexpr double kPower = 0.8;

/// A key of the controller that is an upper limit, what it counts and what it cuts.
struct UpperLimit {
  std::string_view name;
  size_t trial::LimitCounts::*bound;
  double trial::LimitCounts::*largest_raw;
};
constexpr std::array<UpperLimit, 3> kUpperLimits{{
    {"v_max", &trial::LimitCounts::v_max, &trial::LimitCounts::largest_raw_v},
    {"cruise_speed", &trial::LimitCounts::cruise_cap, &trial::LimitCounts::largest_raw_v},
    {"w_max", &trial::LimitCounts::w_max, &trial::LimitCounts::largest_raw_w},
}};

const UpperLimit* LimitOf(const experiment::Parameter& parameter) {
  const auto found =
      std::find_if(kUpperLimits.begin(), kUpperLimits.end(),
                   [&](const UpperLimit& limit) { return limit.name == parameter.Name(); });
  return found == kUpperLimits.end() ? nullptr : &*found;
}

/// Everything of a row but one parameter: its repeat and the other values.
std::pair<std::string, experiment::Theta> RestOf(const TrialRow& row, int parameter) {
  experiment::Theta others = row.theta;
  others.erase(others.begin() + parameter);
  return {row.trial, std::move(others)};
}

/// A path and how it ended.
using Driven = std::pair<std::uint64_t, TrialStatus>;

void ComparePaths(const SweepResult& result, int parameter, Inertness& inert) {
  std::map<std::pair<std::string, experiment::Theta>, std::map<experiment::ParameterValue, Driven>>
      paths;
  for (const TrialRow& row : result.rows) {
    if (row.evidence.fingerprint == 0) continue;
    paths[RestOf(row, parameter)].emplace(row.theta[parameter],
                                          Driven{row.evidence.fingerprint, row.status});
  }
  const experiment::Theta& levels = result.parameters[parameter].levels;
  for (size_t i = 0; i + 1 < levels.size(); ++i) {
    ValuePair pair{levels[i].text, levels[i + 1].text};
    for (const auto& [rest, by_level] : paths) {
      const auto a = by_level.find(levels[i]), b = by_level.find(levels[i + 1]);
      if (a == by_level.end() || b == by_level.end()) continue;
      ++pair.compared;
      pair.identical += a->second == b->second;
    }
    inert.compared += pair.compared;
    inert.identical += pair.identical;
    inert.pairs.push_back(std::move(pair));
  }
}

std::vector<LimitUse> UseOf(const SweepResult& result, int parameter, const UpperLimit& limit,
                            std::optional<trial::LimitCounts> TrialEvidence::*side) {
  std::vector<LimitUse> uses;
  for (const experiment::ParameterValue& level : result.parameters[parameter].levels) {
    if (!level.number) return {};
    LimitUse use{.level = level.text, .value = *level.number};
    for (const TrialRow& row : result.rows) {
      const std::optional<trial::LimitCounts>& counts = row.evidence.*side;
      if (!counts || row.theta[parameter] != level) continue;
      ++use.runs;
      use.runs_bound += (*counts).*limit.bound > 0;
      use.decisions += static_cast<long>(counts->decisions);
      use.bound += static_cast<long>((*counts).*limit.bound);
      use.largest_raw = std::max(use.largest_raw, (*counts).*limit.largest_raw);
    }
    if (use.runs > 0) uses.push_back(use);
  }
  return uses;
}

std::string Joined(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  }
  return text;
}

/// "0.4, 0.5 and 0.6"; of many the first.
std::string SomeJoined(std::vector<std::string> names) {
  constexpr size_t kMost = 6;
  if (names.size() <= kMost) return Joined(names);
  const size_t more = names.size() - (kMost - 1);
  names.resize(kMost - 1);
  names.push_back(fmt::format("{} more", more));
  return Joined(names);
}

/// Values that follow each other in the list, between which no path changed.
struct SameValues {
  std::vector<std::string> names;
  int pairs = 0;
};

std::vector<SameValues> FindSame(const std::vector<ValuePair>& pairs) {
  constexpr int kFewestPairs = 3;  // two equal paths may be chance, or two that hardly moved
  std::vector<SameValues> found;
  bool follows = false;
  for (const ValuePair& pair : pairs) {
    const bool is_same = pair.compared >= kFewestPairs && pair.identical == pair.compared;
    if (is_same && !follows) found.push_back({{pair.a}, 0});
    if (is_same) {
      found.back().names.push_back(pair.b);
      found.back().pairs += pair.compared;
    }
    follows = is_same;
  }
  return found;
}

void SayPaths(Inertness& inert) {
  if (inert.NeverChangedAPath()) {
    inert.sentences.push_back(
        inert.compared == 1
            ? fmt::format("{} did not change the candidate's path in the one pair of trials that "
                          "differ in it alone: the two are the same to the last bit",
                          inert.parameter)
            : fmt::format("{} never changed the candidate's path: in all {} pairs of trials that "
                          "differ in it alone the paths are the same to the last bit",
                          inert.parameter, inert.compared));
    return;
  }
  std::string groups;
  int pairs = 0;
  for (const SameValues& same : FindSame(inert.pairs)) {
    groups += fmt::format("{}{}", groups.empty() ? "" : ", and with ", SomeJoined(same.names));
    pairs += same.pairs;
  }
  if (groups.empty()) return;
  inert.sentences.push_back(
      fmt::format("with {} {} the candidate drove the same path to the last bit in all {} pairs of "
                  "trials",
                  inert.parameter, groups, pairs));
}

/// What the controller of one side tells about the limit.
void SayLimit(Inertness& inert, const std::vector<LimitUse>& uses, std::string_view side) {
  std::vector<std::string> never, most;
  std::string rarely;
  for (const LimitUse& use : uses) {
    if (use.bound == 0) {
      never.push_back(use.level);
      most.push_back(fmt::format("{:.3g}", use.largest_raw));
    } else {
      rarely += fmt::format("; {} bound in {} of {} decisions of {} runs", use.level, use.bound,
                            use.decisions, use.runs);
    }
  }
  if (never.empty()) return;
  inert.is_explained = true;
  inert.sentences.push_back(
      fmt::format("{} {} never bound: the {}'s controller asked for {} at most{}", inert.parameter,
                  Joined(never), side, Joined(most), rarely));
}

/// From the smallest gap of the sweep to its largest.
double GapRange_m(const SweepResult& result) {
  double least_m = std::numeric_limits<double>::infinity(), most_m = -least_m;
  for (const TrialRow& row : result.rows) {
    if (!row.IsOk()) continue;
    least_m = std::min(least_m, row.comparison.gap_m);
    most_m = std::max(most_m, row.comparison.gap_m);
  }
  return std::max(0.0, most_m - least_m);
}

void SayEffect(Inertness& inert, double range_m) {
  if (std::isnan(inert.p) || inert.is_detected || std::isnan(inert.smallest_detectable_m)) return;
  if (inert.smallest_detectable_m > range_m) {
    inert.sentences.push_back(fmt::format(
        "the trials are too few to show a difference between two values of {}: all gaps lie within "
        "{:.4f} m, and only one of {:.4f} m would be seen with {:.0f} % probability",
        inert.parameter, range_m, inert.smallest_detectable_m, 100.0 * kPower));
    return;
  }
  inert.sentences.push_back(fmt::format(
      "a difference of {:.4f} m between two values of {} would have been seen with {:.0f} % "
      "probability",
      inert.smallest_detectable_m, inert.parameter, 100.0 * kPower));
}

/// Of the trials that effects come from: copies of a trial show no smaller difference.
std::vector<int> CountsOf(const Observations& data, int parameter) {
  std::map<experiment::ParameterValue, int> count_of;
  for (const TrialRow* row : data.rows) ++count_of[row->theta[parameter]];
  std::vector<int> counts;
  for (const auto& [value, count] : count_of) counts.push_back(count);
  return counts;
}

Inertness Look(const SweepResult& result, int parameter, const Effects& effects,
               const Observations& data) {
  Inertness inert{.parameter = result.parameters[parameter].Name()};
  ComparePaths(result, parameter, inert);
  if (const ParameterEffect* effect = effects.Of(parameter)) {
    inert.p = effect->p;
    inert.is_detected = effect->IsSeen();
    inert.smallest_detectable_m = SmallestDetectable(
        CountsOf(data, parameter), effects.residual_sd_m, effects.residual_df, kPower);
  }
  SayPaths(inert);
  if (const UpperLimit* limit = LimitOf(result.parameters[parameter])) {
    inert.candidate_limit = UseOf(result, parameter, *limit, &TrialEvidence::candidate_limits);
    inert.reference_limit = UseOf(result, parameter, *limit, &TrialEvidence::reference_limits);
    SayLimit(inert, inert.candidate_limit, "candidate");
    SayLimit(inert, inert.reference_limit, "reference");
  }
  SayEffect(inert, GapRange_m(result));
  return inert;
}

}  // namespace

std::vector<Inertness> FindInert(const SweepResult& result, const Effects& effects) {
  const Observations data = Observe(result, EffectOptions{}.most_trials);
  std::vector<Inertness> all;
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    if (result.parameters[i].levels.size() > 1) all.push_back(Look(result, i, effects, data));
  }
  return all;
}

}  // namespace rift::sweep
