#include "rift/sweep/explain/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "first_rows.hpp"
#include "rift/experiment/settable.hpp"
#include "rift/statistics/inference.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sweep {
namespace {

using experiment::Parameter;
using experiment::Theta;

/// Probability of `failures` of `trials` where the share of failing runs lies evenly in [low,
/// high].
double Likelihood(int failures, int trials, double low, double high) {
  const double a = failures + 1.0, b = trials - failures + 1.0;
  const double inside = statistics::BetaCdf(a, b, high) - statistics::BetaCdf(a, b, low);
  return inside / (trials + 1.0) / (high - low);
}

/// Whether more than a share q of the runs fail.
struct Belief {
  double fails = 0.5;  ///< probability
  double q = 0.1;

  double Wrong() const { return std::min(fails, 1.0 - fails); }

  Belief After(int failures, int trials) const {
    const double above = fails * Likelihood(failures, trials, q, 1.0);
    const double below = (1.0 - fails) * Likelihood(failures, trials, 0.0, q);
    return {above + below > 0.0 ? above / (above + below) : fails, q};
  }

  /// Expected risk after so many trials.
  double WrongAfter(int trials) const {
    double risk = 0.0;
    for (int k = 0; k <= trials; ++k) {
      risk += std::min(fails * Likelihood(k, trials, q, 1.0),
                       (1.0 - fails) * Likelihood(k, trials, 0.0, q));
    }
    return risk;
  }
};

/// Fingerprint of a path and its loss: what is the same for runs that are to the last bit.
using Run = std::pair<std::uint64_t, double>;

/// The rows of a sweep that one experiment on the robot stands for.
struct Candidate {
  Theta values;
  std::vector<int> rows;  ///< distinct ones that tell, of each setting the first
  std::vector<Run> runs;  ///< of all its paths, sorted
  int failures = 0;
  double mean_loss_m = gap::kNotComputed;
};

std::vector<int> SettableParameters(const SweepResult& result) {
  std::vector<int> settable;
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    if (experiment::IsSettable(result.parameters[i])) settable.push_back(i);
  }
  return settable;
}

void Describe(const SweepResult& result, Candidate& candidate) {
  for (const int row : candidate.rows) {
    const TrialRow& trial = result.rows[row];
    const std::uint64_t path = trial.evidence.fingerprint;
    if (path != 0) candidate.runs.emplace_back(path, Loss_m(trial, result.gap.threshold_m));
  }
  std::sort(candidate.runs.begin(), candidate.runs.end());
  candidate.rows = FirstOfEachSetting(result, DistinctRows(result.rows, candidate.rows,
                                                           result.chance_repeats_runs))
                       .rows;
  double sum_m = 0.0;
  for (const int row : candidate.rows) {
    candidate.failures += result.rows[row].falsified;
    sum_m += Loss_m(result.rows[row], result.gap.threshold_m);
  }
  candidate.mean_loss_m = sum_m / static_cast<double>(candidate.rows.size());
}

/// In the order of their first rows; of those that are the same runs to the last bit the first.
std::vector<Candidate> CandidatesOf(const SweepResult& result, const std::vector<int>& settable,
                                    int* identical) {
  std::map<Theta, size_t> index_of;
  std::vector<Candidate> all;
  for (size_t row = 0; row < result.rows.size(); ++row) {
    if (!result.rows[row].Tells()) continue;
    const Theta values = SettableValues(result, settable, result.rows[row].theta);
    const auto [found, is_new] = index_of.emplace(values, all.size());
    if (is_new) all.push_back({.values = values});
    all[found->second].rows.push_back(static_cast<int>(row));
  }
  std::set<std::vector<Run>> seen;
  std::vector<Candidate> candidates;
  for (Candidate& candidate : all) {
    Describe(result, candidate);
    const bool is_known = !candidate.runs.empty() && !seen.insert(candidate.runs).second;
    *identical += is_known;
    if (!is_known) candidates.push_back(std::move(candidate));
  }
  return candidates;
}

/// Laplace's rule over the predictions that the robot's own trials tell of.
double TrustOf(const std::vector<RobotTrials>& robot, double q) {
  int told = 0, held = 0;
  for (const RobotTrials& checked : robot) {
    const Belief belief = Belief{0.5, q}.After(checked.failures, checked.trials);
    if (checked.trials == 0 || belief.fails == 0.5) continue;
    ++told;
    held += checked.is_predicted_to_fail == (belief.fails > 0.5);
  }
  return (1.0 + held) / (2.0 + told);
}

class Judge {
 public:
  Judge(const SweepResult& result, const std::vector<RobotTrials>& robot)
      : q_(result.judged_by.share),
        is_robot_(result.reference_kind == "logs"),
        trusted_(TrustOf(robot, q_)),
        robot_(robot) {}

  double trusted() const { return trusted_; }
  bool IsRobot() const { return is_robot_; }
  bool IsPredictedToFail(const Candidate& candidate) const {
    return candidate.failures > q_ * static_cast<double>(candidate.rows.size());
  }

  Belief Of(const Candidate& candidate) const {
    Belief belief =
        Belief{0.5, q_}.After(candidate.failures, static_cast<int>(candidate.rows.size()));
    if (!is_robot_) belief.fails = trusted_ * belief.fails + (1.0 - trusted_) * 0.5;
    for (const RobotTrials& driven : robot_) {
      const bool is_here = IsSameSetting(driven.values, candidate.values);
      if (is_here) belief = belief.After(driven.failures, driven.trials);
    }
    return belief;
  }

 private:
  double q_;
  bool is_robot_;
  double trusted_;
  const std::vector<RobotTrials>& robot_;
};

std::string ValuesText(const SweepResult& result, const std::vector<int>& settable,
                       const Theta& values) {
  std::vector<Parameter> parameters;
  for (const int i : settable) parameters.push_back(result.parameters[i]);
  return SettingText(parameters, values);
}

Suggestion SuggestionOf(const SweepResult& result, const std::vector<int>& settable,
                        const Candidate& candidate, const Judge& judge, int repeats) {
  const Belief belief = judge.Of(candidate);
  Suggestion suggestion{.values = candidate.values,
                        .repeats = repeats,
                        .rows = candidate.rows,
                        .failures = candidate.failures,
                        .is_predicted_to_fail = judge.IsPredictedToFail(candidate),
                        .mean_loss_m = candidate.mean_loss_m,
                        .fails_now = belief.fails,
                        .wrong_now = belief.Wrong(),
                        .wrong_after = belief.WrongAfter(repeats)};
  const double share = 100.0 * result.judged_by.share;
  suggestion.sentence = fmt::format(
      "{} of {}: {} of {} {} there; does the robot fail in more than {:g} % of its runs? {:.0f} % "
      "likely so far, and the risk of calling it wrongly falls from {:.0f} to {:.0f} %",
      repeats == 1 ? "1 trial" : fmt::format("{} trials", repeats),
      ValuesText(result, settable, candidate.values), candidate.failures, candidate.rows.size(),
      judge.IsRobot() ? "runs failed" : "simulated runs failed", share, 100.0 * belief.fails,
      100.0 * suggestion.wrong_now, 100.0 * suggestion.wrong_after);
  return suggestion;
}

double Gain(const Suggestion& suggestion) {
  return (suggestion.wrong_now - suggestion.wrong_after) / suggestion.repeats;
}

void SortByGain(std::vector<Suggestion>& suggestions) {
  std::stable_sort(suggestions.begin(), suggestions.end(),
                   [](const Suggestion& a, const Suggestion& b) {
                     if (Gain(a) != Gain(b)) return Gain(a) > Gain(b);
                     return a.mean_loss_m > b.mean_loss_m;
                   });
}

/// The best by gain, predicted failures for at least half of the places; the best first.
std::vector<Suggestion> Choose(std::vector<Suggestion> all, int most) {
  SortByGain(all);
  std::vector<Suggestion> chosen, others;
  int reserved = (most + 1) / 2;
  for (Suggestion& one : all) {
    const bool is_reserved = one.is_predicted_to_fail && reserved-- > 0;
    (is_reserved ? chosen : others).push_back(std::move(one));
  }
  std::move(others.begin(), others.end(), std::back_inserter(chosen));
  if (static_cast<int>(chosen.size()) > most) chosen.resize(static_cast<size_t>(most));
  SortByGain(chosen);
  return chosen;
}

std::string NoteOn(const SweepResult& result, const std::vector<int>& settable, size_t considered,
                   size_t worth, int identical, const SuggestOptions& options) {
  std::string fixed;
  for (size_t i = 0; i < result.parameters.size(); ++i) {
    if (std::find(settable.begin(), settable.end(), static_cast<int>(i)) != settable.end())
      continue;
    fixed += (fixed.empty() ? "" : ", ") + result.parameters[i].Name();
  }
  if (settable.empty()) {
    return fmt::format(
        "no parameter can be set on the robot ({}): mark one that can in space, with "
        "settable: true",
        fixed.empty() ? "there are none" : fixed);
  }
  std::string note;
  const auto add = [&](const std::string& text) { note += (note.empty() ? "" : "; ") + text; };
  if (worth == 0) {
    add(
        fmt::format("of {} settings that can be set none is worth a trial: each would take less "
                    "than {:g} points from the risk of a wrong call",
                    considered, 100.0 * options.least_gain));
  }
  if (!fixed.empty()) add(fmt::format("not set by a person, as they are on the robot: {}", fixed));
  if (identical > 0) add(fmt::format("{} left out as the same runs to the last bit", identical));
  return note;
}

}  // namespace

Theta SettableValues(const SweepResult& result, const std::vector<int>& settable,
                     const Theta& theta) {
  Theta values;
  for (const int i : settable) {
    values.push_back(experiment::NearestSettable(result.parameters[i], theta[i]));
  }
  return values;
}

std::vector<gap::RepeatVerdict> JudgeRobotTrials(const std::vector<RobotTrials>& robot,
                                                 const gap::VerdictOptions& options) {
  std::vector<gap::RepeatVerdict> verdicts;
  int driven = 0;
  for (const RobotTrials& trials : robot) {
    verdicts.push_back(gap::JudgeCounts(trials.failures, trials.trials, options));
    driven += trials.trials > 0;
  }
  gap::JudgeTogether(verdicts, std::max(driven, 1), options);
  return verdicts;
}

Suggestions SuggestExperiments(const SweepResult& result, const SuggestOptions& options,
                               const std::vector<RobotTrials>& robot) {
  Suggestions suggestions{.settable = SettableParameters(result)};
  const Judge judge(result, robot);
  suggestions.trusted = judge.IsRobot() ? 1.0 : judge.trusted();
  int identical = 0;
  std::vector<Candidate> candidates;
  if (!suggestions.settable.empty() || result.parameters.empty()) {
    candidates = CandidatesOf(result, suggestions.settable, &identical);
  }
  std::vector<Suggestion> worth;
  for (const Candidate& candidate : candidates) {
    const Suggestion one =
        SuggestionOf(result, suggestions.settable, candidate, judge, options.repeats);
    if (Gain(one) > 0.0 && Gain(one) >= options.least_gain) worth.push_back(one);
  }
  suggestions.note =
      NoteOn(result, suggestions.settable, candidates.size(), worth.size(), identical, options);
  suggestions.list = Choose(std::move(worth), options.experiments);
  return suggestions;
}

}  // namespace rift::sweep
