#include "rift/report/text/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "causes.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/report/text/trial_query.hpp"
#include "rift/sweep/explain/anatomy.hpp"
#include "rift/sweep/falsify/distinct_rows.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

std::string Metres(double value_m) { return fmt::format("{:.4f} m", value_m); }

std::string Count(long n, std::string_view noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

double FailureShare(const sweep::LevelSummary& level) {
  return level.told == 0 ? -1.0 : static_cast<double>(level.failures) / level.told;
}

void SayLevel(const std::string& parameter, const sweep::LevelSummary& level, Sentence* sentence) {
  const std::string query = TrialsWhere(parameter, level.level);
  sentence->Say(level.level + " (")
      .Link(std::to_string(level.failures), Both(query, FailingTrials()))
      .Say(" of ")
      .Link(fmt::format("{} trials", level.told), query)
      .Say(")");
}

/// How far the levels' shares of failures are from that of all, each by its trials.
double Apart(const std::vector<sweep::LevelSummary>& levels) {
  double failures = 0.0, told = 0.0;
  for (const sweep::LevelSummary& level : levels) failures += level.failures, told += level.told;
  double apart = 0.0;
  for (const sweep::LevelSummary& level : levels) {
    apart += level.told * std::pow(FailureShare(level) - failures / told, 2);
  }
  return apart;
}

/// The levels with the largest and the smallest share of failures, of the parameter whose levels
/// are furthest apart; of the main factor where they are as far.
void SayMostAndLeast(const sweep::SweepResult& result, Finding* finding) {
  const int main = sweep::SplitFactors(result.parameters).main_factor;
  std::vector<int> factors{main};
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) {
    if (i != main) factors.push_back(i);
  }
  int furthest = main;
  std::vector<sweep::LevelSummary> levels;
  for (const int factor : factors) {
    if (!sweep::HasLevels(result.parameters[factor])) continue;
    std::vector<sweep::LevelSummary> own = sweep::SummariseBy(result, {factor});
    std::erase_if(own, [](const auto& level) { return level.told == 0; });
    constexpr double kMore = 1.0 + 1e-9;  // than rounding
    if (own.size() < 2 || (!levels.empty() && Apart(own) <= kMore * Apart(levels))) continue;
    furthest = factor;
    levels = std::move(own);
  }
  if (levels.empty()) return;
  const auto [least, most] =
      std::minmax_element(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
        return std::pair(FailureShare(a), a.mean_gap_m) < std::pair(FailureShare(b), b.mean_gap_m);
      });
  if (FailureShare(*least) == FailureShare(*most)) return;
  const std::string name = result.parameters[furthest].Name();
  Sentence sentence(fmt::format("Most often at {} ", name));
  SayLevel(name, *most, &sentence);
  sentence.Say(", least often at ");
  SayLevel(name, *least, &sentence);
  finding->sentences.push_back(sentence.Say("."));
}

void SayWorstSetting(const sweep::SweepResult& result, Finding* finding) {
  const std::vector<const sweep::SettingResult*> settings = sweep::WorstSettings(result);
  const auto worst = std::find_if(settings.begin(), settings.end(),
                                  [](const auto* setting) { return setting->verdict.repeats > 0; });
  if (worst == settings.end()) return;
  const sweep::SettingResult& setting = **worst;
  const auto with_gap = static_cast<int>(GapsOf(result, setting).size());
  std::string mean = "none has a gap";
  if (with_gap > 0) mean = "the mean gap is " + Metres(setting.mean_gap_m);
  if (with_gap > 0 && with_gap < static_cast<int>(setting.rows.size())) {
    mean += fmt::format(", over the {} with a gap", with_gap);
  }
  Sentence sentence("The worst setting is ");
  sentence.Link(SettingLabel(result, setting.theta), TrialsOf(result, setting.theta))
      .Say(fmt::format(": {} of {} failed, {}.", setting.verdict.above,
                       Count(setting.verdict.repeats, "trial"), mean));
  finding->sentences.push_back(sentence);
}

void SayKinds(const sweep::Explanation& explanation, Finding* finding) {
  constexpr std::size_t kMostKinds = 3;
  const std::vector<sweep::FailureCluster>& clusters = explanation.clusters;
  if (clusters.empty()) return;
  finding->sentences.push_back(fmt::format(
      "{} of failure by where and how the paths part:",
      clusters.size() == 1 ? std::string("One kind") : fmt::format("{} kinds", clusters.size())));
  for (std::size_t i = 0; i < std::min(kMostKinds, clusters.size()); ++i) {
    const std::string count = std::to_string(clusters[i].rows.size());
    Sentence sentence;
    sentence.Link(count, TrialsNumbered(clusters[i].rows));
    finding->sentences.push_back(sentence.Say(clusters[i].sentence.substr(count.size()) + "."));
  }
}

Finding Where(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  Finding finding{"Where does it fail?", {}};
  const std::optional<int> worst = WorstRow(result);
  if (!worst && result.all.failures == 0) {
    finding.sentences.push_back(Sentence("Not known: no trial has a gap."));
    return finding;
  }
  if (!result.parameters.empty() && result.all.failures > 0) SayMostAndLeast(result, &finding);
  if (worst) {
    const sweep::TrialRow& row = result.rows[*worst];
    Sentence largest("The largest gap, ");
    largest.Link(Metres(row.comparison.gap_m), TrialsNumbered({*worst}))
        .Say(fmt::format(", is {}, trial {}, at u = {:.2f} of the path.",
                         SettingLabel(result, row.theta), row.trial, row.comparison.gap_u));
    finding.sentences.push_back(largest);
  }
  SayWorstSetting(result, &finding);
  SayKinds(explanation, &finding);
  return finding;
}

/// Which settings their repeats leave open, for as many as can be read.
void SayUndecided(const sweep::SweepResult& result, Finding* finding) {
  constexpr int kMostNamed = 12;
  Sentence sentence("Undecided: ");
  int named = 0;
  for (const sweep::SettingResult& setting : result.settings) {
    const gap::RepeatVerdict& verdict = setting.verdict;
    if (verdict.verdict != gap::Verdict::kUndecided || verdict.repeats == 0) continue;
    if (named == kMostNamed) {
      sentence.Say(" and more in the table of settings");
      ++named;
      break;
    }
    sentence.Say(named++ == 0 ? "" : "; ")
        .Link(SettingLabel(result, setting.theta), TrialsOf(result, setting.theta))
        .Say(fmt::format(" ({} of {} failed)", verdict.above, verdict.repeats));
  }
  if (named > 0) finding->sentences.push_back(sentence.Say("."));
}

Finding HowSure(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  Finding finding{"How sure is that?", {}};
  finding.sentences.push_back(VerdictCounts(result).Say("."));
  SayUndecided(result, &finding);
  if (result.chance_repeats_runs) {
    finding.sentences.push_back(Sentence(
        "Chance picks among a few fixed runs here: repeats that are the same are draws, and "
        "each counts."));
  }
  finding.sentences.push_back(explanation.probability.sentence + ".");
  return finding;
}

Finding Next(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  constexpr std::size_t kMostShown = 3;
  Finding finding{"What to test next?", {}};
  const std::string robot = RobotSentence(result, explanation);
  if (!robot.empty()) finding.sentences.push_back(Sentence(robot));
  const std::vector<sweep::Suggestion>& suggestions = explanation.suggestions.list;
  for (std::size_t i = 0; i < std::min(kMostShown, suggestions.size()); ++i) {
    const sweep::Suggestion& suggestion = suggestions[i];
    const std::size_t colon = suggestion.sentence.find(':');
    Sentence sentence;
    sentence.Link(suggestion.sentence.substr(0, colon), TrialsNumbered(suggestion.rows))
        .Say(suggestion.sentence.substr(colon) + ".");
    finding.sentences.push_back(sentence);
  }
  if (!explanation.suggestions.note.empty()) {
    finding.sentences.push_back(Sentence(Capital(explanation.suggestions.note) + "."));
  }
  if (finding.sentences.empty()) {
    finding.sentences.push_back(Sentence("Nothing can be said: no trial tells."));
  }
  return finding;
}

Finding BesideNoise(const sweep::SweepResult& result) {
  Finding finding{"How much is the robot's own scatter?", {}};
  double sum_m = 0.0;
  long n = 0;
  for (const sweep::SettingResult& setting : result.settings) {
    if (!std::isfinite(setting.noise_floor_m)) continue;
    sum_m += setting.noise_floor_m;
    ++n;
  }
  if (n == 0) {
    finding.sentences.push_back(
        Sentence("Not known: no setting has two references to compare with each other."));
    return finding;
  }
  const double floor_m = sum_m / static_cast<double>(n), gap_m = result.all.mean_gap_m;
  std::string text =
      fmt::format("Repeats of one setting are {} apart from each other (noise floor, mean of {}); ",
                  Metres(floor_m), Count(n, "setting"));
  if (std::isnan(gap_m)) {
    text += "no trial has a gap to hold against that";
  } else {
    text += fmt::format("the mean gap to the candidate is {}", Metres(gap_m));
    if (floor_m > 0.0) text += fmt::format(", {:.2f} times that", gap_m / floor_m);
  }
  finding.sentences.push_back(text + ".");
  return finding;
}

Finding Missing(const sweep::SweepResult& result) {
  Finding finding{"What was not measured?", {}};
  if (result.all.not_ok == 0) {
    finding.sentences.push_back(fmt::format("Nothing: all {} have a gap.",
                                            Count(static_cast<long>(result.rows.size()), "trial")));
    return finding;
  }
  finding.sentences.push_back(
      fmt::format("Without a gap: {} of {} ({}). They are in no mean on this page.",
                  result.all.not_ok, Count(static_cast<long>(result.rows.size()), "trial"),
                  StatusCounts(result, [](const auto& row) { return !row.IsOk(); })));
  const long fewer =
      std::count_if(result.settings.begin(), result.settings.end(), [&](const auto& setting) {
        return setting.verdict.repeats > 0 && NotMeasured(result, setting) > 0;
      });
  if (fewer > 0) {
    finding.sentences.push_back(
        fmt::format("{} judged by fewer repeats than asked for.", Count(fewer, "setting")));
  }
  return finding;
}

}  // namespace

std::string Sentence::Text() const {
  std::string text;
  for (const Piece& piece : pieces_) text += piece.text;
  return text;
}

std::string StatusCounts(const sweep::SweepResult& result,
                         const std::function<bool(const sweep::TrialRow&)>& is_counted) {
  std::map<sweep::TrialStatus, long> counts;
  for (const sweep::TrialRow& row : result.rows) {
    if (is_counted(row)) ++counts[row.status];
  }
  std::string text;
  for (const auto& [status, n] : counts) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, yaml::NameOf(status));
  }
  return text;
}

Sentence VerdictCounts(const sweep::SweepResult& result) {
  const int settings = std::max(result.judged_settings, static_cast<int>(result.settings.size()));
  const std::string wrong =
      result.falsification && sweep::IsChosenByResults(*result.falsification)
          ? "results chose which were tried, so confirm what is falsified with another seed"
          : fmt::format("at most {:g} % of the decided ones are wrong on average",
                        100.0 * (1.0 - result.judged_by.confidence));
  return fmt::format(
      "{} of {} falsified, {} passed, {} not seen to fail, {} undecided (falsified: more than {:g} "
      "% of its runs are shown to fail, passed: fewer; {} judged together: {})",
      result.Count(gap::Verdict::kFalsified), result.settings.size(),
      result.Count(gap::Verdict::kPassed), result.Count(gap::Verdict::kNotSeenToFail),
      result.Count(gap::Verdict::kUndecided), 100.0 * result.judged_by.share, settings, wrong);
}

namespace {

/// The gap beside the scatter of the repeats of its reference; empty without repeats.
std::string BesideScatter(const sweep::SweepResult& result) {
  /// A mean gap that exceeds the scatter by less than this share of it makes no difference.
  constexpr double kSlight = 0.25;
  const sweep::Anatomy anatomy = sweep::Dissect(result);
  const sweep::Estimate& beyond = anatomy.removable_m;
  if (std::isnan(beyond.low)) return "";
  const bool is_robot = result.reference_kind == "logs";
  const std::string it = is_robot ? "the robot" : "the nominal run";
  const std::string numbers = fmt::format(
      "over the settings a mean gap of {} against {} between its own runs, difference {:+.4f} m "
      "({:.4f} to "
      "{:.4f})",
      Metres(anatomy.gap_m.mean), Metres(anatomy.noise_m.mean), beyond.mean, beyond.low,
      beyond.high);
  if (beyond.low > 0.0) {
    return fmt::format("Further from {} than {} from itself: {}. ", it, it, numbers);
  }
  if (beyond.high <= kSlight * anatomy.noise_m.mean) {
    return fmt::format("As near to {} as {} to itself: {}. ", it, it, numbers);
  }
  return fmt::format("It cannot be told whether it is further from {} than {} from itself: {}. ",
                     it, it, numbers);
}

/// Runs that are the same to the last bit are one run, and counting them all would say too much.
std::string DistinctText(const sweep::SweepResult& result) {
  const std::vector<int> distinct = sweep::RowsThatCount(result);
  if (static_cast<int>(distinct.size()) == result.all.told) return "";
  const long failures = std::count_if(distinct.begin(), distinct.end(),
                                      [&](int row) { return result.rows[row].falsified; });
  return fmt::format(" Of these trials {} are different runs, of which {} fail.", distinct.size(),
                     failures);
}

std::string HowTheyFail(const sweep::SweepResult& result) {
  const long ended = std::count_if(result.rows.begin(), result.rows.end(),
                                   [](const auto& row) { return row.falsified && !row.IsOk(); });
  const std::string above = fmt::format("exceed {} m", Number(result.gap.threshold_m));
  if (ended == 0) return above;
  if (ended == result.all.failures) return "do not arrive";
  return fmt::format("fail, {} as they {} and {} as they do not arrive",
                     result.all.failures - ended, above, ended);
}

}  // namespace

Headline Summary(const sweep::SweepResult& result) {
  const sweep::LevelSummary& all = result.all;
  if (all.told == 0) {
    return {Outcome::kUnknown, Sentence("Not known whether it fails: no trial has a gap.")};
  }
  Sentence sentence(BesideScatter(result));
  if (all.failures == 0) {
    const bool is_above_at_goal = sweep::Dissect(result).only_at_goal > 0;
    sentence.Say(fmt::format("No failure: none of {} exceeds {} m{}; mean gap {}.",
                             Count(all.told, "measured trial"), Number(result.gap.threshold_m),
                             is_above_at_goal ? " on its way to the goal" : "",
                             Metres(all.mean_gap_m)));
    return {Outcome::kHolds, sentence};
  }
  const std::string mean =
      std::isnan(all.mean_gap_m) ? "" : fmt::format("; mean gap {}", Metres(all.mean_gap_m));
  sentence.Say("It fails: ")
      .Link(std::to_string(all.failures), FailingTrials())
      .Say(fmt::format(" of {} {} ({}){}.", Count(all.told, "measured trial"), HowTheyFail(result),
                       sweep::PercentText(FailureShare(all)), mean))
      .Say(DistinctText(result));
  return {Outcome::kFails, sentence};
}

std::vector<Finding> Findings(const sweep::SweepResult& result,
                              const sweep::Explanation& explanation) {
  return {Where(result, explanation),
          Because(explanation),
          HowSure(result, explanation),
          Next(result, explanation),
          MadeOf(explanation),
          BesideNoise(result),
          Missing(result)};
}

std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result) {
  std::vector<std::string> lines;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) continue;
    lines.push_back(fmt::format("{}, trial {}: {} – {}", SettingLabel(result, row.theta), row.trial,
                                yaml::NameOf(row.status), row.reason));
  }
  return lines;
}

}  // namespace rift::report
