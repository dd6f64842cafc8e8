#include "rift/report/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "rift/files/shell_word.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/text/findings.hpp"
#include "rift/sweep/explain/worst_trial.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::report {
namespace {

/// Of a long table the values with the largest means, since a terminal is not for thousands.
std::string LevelTable(const std::string& head, std::vector<sweep::LevelSummary> levels) {
  constexpr size_t kMostLevels = 40;
  const size_t omitted = levels.size() - std::min(levels.size(), kMostLevels);
  if (omitted > 0) {
    std::stable_sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) {
      return std::isnan(b.mean_gap_m) ? !std::isnan(a.mean_gap_m) : a.mean_gap_m > b.mean_gap_m;
    });
    levels.resize(kMostLevels);
  }
  size_t width = head.size();
  for (const sweep::LevelSummary& level : levels) width = std::max(width, level.level.size());
  std::string text =
      fmt::format("{:<{}}  mean_gap_m  failures  trials  without_gap\n", head, width);
  for (const sweep::LevelSummary& level : levels) {
    const std::string mean =
        std::isnan(level.mean_gap_m) ? "-" : fmt::format("{:.4f}", level.mean_gap_m);
    text += fmt::format("{:<{}}  {:>10}  {:>8}  {:>6}  {:>11}\n", level.level, width, mean,
                        level.failures, level.told, level.not_ok);
  }
  if (omitted > 0) text += fmt::format("and {} more, all of them in summary.json\n", omitted);
  return text + '\n';
}

std::string RowText(const sweep::SweepResult& result, size_t index) {
  const sweep::TrialRow& row = result.rows[index];
  const std::string end =
      row.IsOk() ? fmt::format("{:.4f} m at u = {:.2f}", row.comparison.gap_m, row.comparison.gap_u)
                 : std::string(yaml::NameOf(row.status));
  return fmt::format("row {}, {} ({}, trial {})\n", index + 1, end,
                     sweep::SettingText(result.parameters, row.theta), row.trial);
}

/// The row that `worst` names for --shrink and --replay, and the largest gap where that is another:
/// of a sweep that fails by runs without a gap, or above the threshold at the goal alone.
std::string WorstText(const sweep::SweepResult& result) {
  const std::optional<size_t> worst = WorstTrialOf(result);
  if (!worst) return "";
  const std::string text = "worst: " + RowText(result, *worst);
  const std::optional<int> largest = WorstRow(result);
  if (!largest || static_cast<size_t>(*largest) == *worst) return text;
  return text + "largest gap: " + RowText(result, static_cast<size_t>(*largest));
}

std::string NotOkText(const sweep::SweepResult& result) {
  constexpr int kMostShown = 3;
  std::string text;
  int without_gap = 0;
  const sweep::TrialRow* last_shown = nullptr;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    const sweep::TrialRow& row = result.rows[i];
    if (row.IsOk() || ++without_gap > kMostShown) continue;
    text += fmt::format("without gap: row {}: {}\n", i + 1, row.reason);
    last_shown = &row;
  }
  if (without_gap <= kMostShown) return text;
  const std::string kinds =
      StatusCounts(result, [&](const auto& row) { return !row.IsOk() && &row > last_shown; });
  return text + fmt::format("without gap: {} more: {}\n", without_gap - kMostShown, kinds);
}

std::string FalsificationText(const sweep::SweepResult& result, const sweep::Falsification& found) {
  std::string text =
      fmt::format("{}: {} settings tried of {} ({}, ended by {})\n", yaml::NameOf(found.verdict),
                  found.evaluations, found.budget, found.strategy, found.ended);
  if (found.first_evaluation) {
    text += fmt::format("first falsified setting: number {}\n", *found.first_evaluation);
  }
  if (found.worst_setting) {
    const sweep::SettingResult& worst = result.settings.at(*found.worst_setting);
    const std::string gap = std::isnan(worst.mean_gap_m)
                                ? "no run arrived"
                                : fmt::format("mean gap {:.4f} m", worst.mean_gap_m);
    text +=
        fmt::format("worst setting: {}, {} of {} trials failed ({})\n", gap, worst.verdict.above,
                    worst.verdict.repeats, sweep::SettingText(result.parameters, worst.theta));
  }
  return text;
}

/// The table of a parameter, unless every setting has a value of its own.
std::string LevelTables(const sweep::SweepResult& result) {
  const sweep::FactorSplit split = sweep::SplitFactors(result.parameters);
  const auto is_range = [&](int i) { return !sweep::HasLevels(result.parameters[i]); };
  std::string text;
  if (!is_range(split.main_factor)) {
    text += LevelTable(result.parameters[split.main_factor].Name(),
                       sweep::SummariseBy(result, {split.main_factor}));
  }
  const bool has_range = std::any_of(split.others.begin(), split.others.end(), is_range);
  if (!split.others.empty() && !has_range) {
    text += LevelTable(split.others_name, sweep::SummariseBy(result, split.others));
  }
  return text;
}

std::string SuggestionsText(const sweep::Explanation& explanation) {
  const sweep::Suggestions& suggestions = explanation.suggestions;
  std::string text;
  if (!suggestions.list.empty()) text = "\nnext experiments on the robot, the best first:\n";
  int number = 0;
  for (const sweep::Suggestion& suggestion : suggestions.list) {
    text += fmt::format("{}. {}\n", ++number, suggestion.sentence);
  }
  if (suggestions.list.empty() && suggestions.note.empty()) {
    return "\nno experiment can be suggested: no trial tells\n";
  }
  return suggestions.note.empty() ? text : text + fmt::format("\n{}\n", suggestions.note);
}

std::string OutcomeText(const sweep::TrialRow& row) {
  return row.IsOk() ? fmt::format("gap {:.4f} m", row.comparison.gap_m)
                    : std::string(yaml::NameOf(row.status));
}

std::string ReplacedText(const sweep::SweepResult& result) {
  std::string text;
  for (const sweep::ReplacedReference& replaced : result.replaced) {
    text += fmt::format("reference: the nominal run with seed {} failed ({}): seed {} instead\n",
                        replaced.seed, replaced.reason, replaced.used);
  }
  return text;
}

}  // namespace

std::string SweepText(const sweep::SweepResult& result) {
  std::string text =
      fmt::format("gap: {}; above {:g} m falsifies\n\n",
                  gap::DefinitionText(result.gap, result.tag_offset_m), result.gap.threshold_m);
  if (!result.parameters.empty()) text += LevelTables(result);
  text += LevelTable("", {result.all});
  text += WorstText(result) + NotOkText(result) + ReplacedText(result);
  if (result.falsification) text += FalsificationText(result, *result.falsification);
  return text + "settings: " + VerdictCounts(result).Text() + "\n";
}

std::string ExplanationText(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                            bool suggest) {
  std::string text;
  for (const Finding& finding : Findings(result, explanation)) {
    const bool is_shown =
        finding.question == "Because of what?" || finding.question == "How sure is that?";
    if (!is_shown) continue;
    text += fmt::format("\n{}\n", finding.question);
    for (const Sentence& sentence : finding.sentences) {
      text += fmt::format("- {}\n", sentence.Text());
    }
  }
  const std::string robot = RobotSentence(result, explanation);
  if (!robot.empty()) text += fmt::format("\nrobot: {}\n", robot);
  return suggest ? text + SuggestionsText(explanation) : text;
}

namespace {

/// The settings of which the largest share of runs failed, worst first.
std::string WorstSettingsText(const sweep::SweepResult& result) {
  constexpr size_t kMostNamed = 3;
  std::vector<const sweep::SettingResult*> failing = sweep::WorstSettings(result);
  std::erase_if(failing, [](const auto* setting) { return setting->verdict.above == 0; });
  if (failing.empty()) return "nowhere: no run failed";
  std::string text;
  for (size_t i = 0; i < std::min(kMostNamed, failing.size()); ++i) {
    text += fmt::format("{}{} ({} of {} failed)", i == 0 ? "" : "; ",
                        sweep::SettingText(result.parameters, failing[i]->theta),
                        failing[i]->verdict.above, failing[i]->verdict.repeats);
  }
  if (failing.size() <= kMostNamed) return text;
  return text + fmt::format("; {} more settings saw a failure", failing.size() - kMostNamed);
}

std::string FirstSentence(const std::vector<Finding>& findings, const std::string& question) {
  for (const Finding& finding : findings) {
    if (finding.question == question && !finding.sentences.empty()) {
      return finding.sentences.front().Text();
    }
  }
  return "not known";
}

}  // namespace

std::string BriefText(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  const std::vector<Finding> findings = Findings(result, explanation);
  const auto failing = [&](bool is_ok) {
    return std::count_if(result.rows.begin(), result.rows.end(), [&](const sweep::TrialRow& row) {
      return row.falsified && row.IsOk() == is_ok;
    });
  };
  std::string fails =
      fmt::format("{} of {} settings; {} of {} runs exceed {:g} m, and {} fail by not arriving",
                  result.Count(gap::Verdict::kFalsified), result.settings.size(), failing(true),
                  result.all.told, result.gap.threshold_m, failing(false));
  const long lost = static_cast<long>(result.rows.size()) - result.all.told;
  if (lost > 0) {
    fails += fmt::format("; {} more tell nothing ({})", lost,
                         StatusCounts(result, [](const auto& row) { return !row.Tells(); }));
  }
  std::string text;
  for (const auto& [label, answer] :
       {std::pair<const char*, std::string>{"what fails:", fails},
        {"where:", WorstSettingsText(result)},
        {"why:", FirstSentence(findings, "Because of what?")},
        {"how sure:", FirstSentence(findings, "How sure is that?")},
        {"what next:", FirstSentence(findings, "What to test next?")}}) {
    text += fmt::format("{:<11} {}\n", label, answer);
  }
  return text;
}

size_t CountChanges(const experiment::Theta& theta, const experiment::Theta& nominal) {
  size_t changes = 0;
  for (size_t i = 0; i < theta.size(); ++i) changes += !SameValue(theta[i], nominal[i]);
  return changes;
}

std::string ReplayCommand(const std::string& folder, size_t row) {
  return fmt::format("rift simulate --replay {} {}", files::ShellWord(folder), row + 1);
}

std::string ShrunkText(const sweep::SweepResult& result, const sweep::ShrunkRow& found,
                       const std::string& folder) {
  const std::vector<experiment::Parameter>& parameters = result.parameters;
  const sweep::TrialRow& failing = found.rows[0];
  const sweep::TrialRow& least = found.rows[1];
  const size_t changes = CountChanges(failing.theta, found.nominal);
  std::string text = fmt::format(
      "\nshrunk: row {} ({}; {}) still fails with {} of its {} {} from the experiment's own values "
      "({}{}; {} trials)\n",
      found.id, sweep::SettingText(parameters, failing.theta), OutcomeText(failing),
      found.shrunk.changed.size(), changes, changes == 1 ? "change" : "changes", OutcomeText(least),
      least.IsOk() ? fmt::format(", above {:g} m", result.gap.threshold_m) : "",
      found.shrunk.evaluations);
  if (found.shrunk.changed.empty()) {
    text += "  it fails with none of them: the experiment's own values do\n";
  }
  for (size_t i = 0; i < found.shrunk.changed.size(); ++i) {
    const int parameter = found.shrunk.changed[i];
    text += fmt::format("  {}: {} instead of {}; taken back, {}\n", parameters[parameter].Name(),
                        found.shrunk.theta[parameter].text, found.nominal[parameter].text,
                        OutcomeText(found.rows[2 + i]));
  }
  text += found.shrunk.is_minimal ? "  none of these changes can be left out (each was tried)\n"
                                  : "  there may be less to it: no more trials are spent on it\n";
  if (found.shrunk.is_fewest)
    text += "  no smaller set of the row's changes fails (all were tried)\n";
  return text + fmt::format("  again: {}\n", ReplayCommand(folder, 1));
}

std::string RareEventSentence(const sweep::RareEvent& event) {
  constexpr const char* kUntold = "do not tell and are taken to hold";
  if (!event.is_reached) {
    return fmt::format(
        "no failure was reached in {} levels: a run at a setting drawn at random fails with a "
        "probability of {:.3g} at most, with 95 % confidence{}",
        event.levels, event.high,
        event.untold > 0
            ? fmt::format(" ({} of {} runs {})", event.untold, event.evaluations, kUntold)
            : "");
  }
  std::string runs =
      fmt::format("{} runs in {} levels of subset simulation", event.evaluations, event.levels);
  if (event.untold > 0) runs += fmt::format("; {} of them {}", event.untold, kUntold);
  if (event.levels == 1) {
    runs = fmt::format("{} runs in 1 level: it is not rare", event.evaluations - event.untold);
    if (event.untold > 0) runs += fmt::format("; {} more do not tell", event.untold);
  }
  return fmt::format(
      "a run at a setting drawn at random fails with a probability of {:.2g}, between {:.2g} and "
      "{:.2g} with 95 % confidence ({})",
      event.probability, event.low, event.high, runs);
}

}  // namespace rift::report
