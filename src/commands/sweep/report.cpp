#include "report.hpp"

#include <fmt/format.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/page/page.hpp"
#include "rift/terminal/print.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::commands {
namespace {

/// A value as the table of flags writes it; nothing for one that is the default.
class ChangedFlags {
 public:
  explicit ChangedFlags(std::vector<std::string> defaults) : defaults_(std::move(defaults)) {}

  template <class T>
  static std::string TextOf(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return std::string(yaml::NameOf(value));
    } else {
      return fmt::format("{}", value);
    }
  }

  template <class T>
  void Add(const char* key, const T& value) {
    const std::string text = TextOf(value);
    if (text == defaults_.at(at_++)) return;
    flags_ += " " + FlagName(key).flag;
    if constexpr (!std::is_same_v<T, bool>) flags_ += " " + text;
  }

  const std::string& Text() const { return flags_; }

 private:
  std::vector<std::string> defaults_;
  size_t at_ = 0;
  std::string flags_;
};

/// Those of the gap's options that are not the defaults, as flags of `rift gap`.
std::string ChangedGapFlags(const gap::GapOptions& options) {
  const gap::GapOptions standard;
  std::vector<std::string> defaults;
  gap::GapOptions::Fields(standard, [&](const char*, const auto& value, const auto&...) {
    defaults.push_back(ChangedFlags::TextOf(value));
  });
  ChangedFlags flags(std::move(defaults));
  gap::GapOptions::Fields(
      options, [&](const char* key, const auto& value, const auto&...) { flags.Add(key, value); });
  return flags.Text();
}

sweep::Recording Finished(sweep::Recording recording) {
  if (recording.status != sweep::TrialStatus::kOk) {
    throw std::runtime_error(fmt::format("a row that had a gap has none now: {}: {}",
                                         recording.source, recording.reason));
  }
  return recording;
}

/// The simulated and the reference path of a row, computed again.
report::ComparedPair PathsOf(const sweep::SweepResult& result, const sweep::TrialRow& row,
                             const std::string& name, sweep::Evaluator& evaluator) {
  const sweep::TrialRequest request{.theta = row.theta, .trial = row.trial, .seed = row.seed};
  const sweep::Recording reference = Finished(evaluator.Reference(request));
  const sweep::Recording candidate = Finished(evaluator.Candidate(request, reference));
  return report::ComparePair("simulator", candidate.trajectory, name, reference.trajectory,
                             result.gap);
}

std::string PathName(const experiment::Experiment& experiment) {
  return experiment.program.segments.empty() ? "waypoint path" : "program path";
}

std::vector<report::TypicalFailure> TypicalFailures(const sweep::SweepResult& result,
                                                    const sweep::Explanation& explanation,
                                                    sweep::Evaluator& evaluator) {
  std::vector<report::TypicalFailure> failures;
  for (size_t kind = 0; kind < explanation.clusters.size(); ++kind) {
    const int index = explanation.clusters[kind].rows.front();
    const sweep::TrialRow& row = result.rows.at(index);
    if (!row.IsOk()) continue;  // it ended early: there is no path to hold against the other
    const std::string name = result.reference_kind == "logs" ? "robot"
                             : result.reference_kind == "nominal"
                                 ? "nominal run"
                                 : PathName(evaluator.experiment());
    failures.push_back({index, static_cast<int>(kind), PathsOf(result, row, name, evaluator)});
  }
  return failures;
}

std::string GapFlags(const experiment::Experiment& experiment) {
  if (experiment.candidate.kind != experiment::CandidateKind::kLogs) return "";
  if (experiment.reference.kind != experiment::ReferenceKind::kLogs) return "";
  std::string flags;
  const auto add = [&flags](const std::string& flag, const std::string& value) {
    flags += fmt::format(" {} {}", flag, value);
  };
  add("--sim-format", std::string(yaml::NameOf(experiment.candidate.format)));
  add("--real-format", std::string(yaml::NameOf(experiment.reference.format)));
  const auto add_text = [&](const std::string& flag, const std::string& value) {
    if (!value.empty()) add(flag, "'" + value + "'");
  };
  add_text("--sim-columns", experiment.candidate.columns);
  add_text("--sim-units", experiment.candidate.units);
  add_text("--real-columns", experiment.reference.columns);
  add_text("--real-units", experiment.reference.units);
  if (experiment.reference.tag_offset_m != 0.0) {
    add("--tag-offset", fmt::format("{}", experiment.reference.tag_offset_m));
  }
  return flags + ChangedGapFlags(experiment.gap);
}

std::optional<report::ComparedPair> WorstPair(const sweep::SweepResult& result,
                                              sweep::Evaluator& evaluator) {
  const std::optional<int> worst = sweep::WorstRow(result);
  if (!worst) return std::nullopt;
  const sweep::TrialRow& row = result.rows[*worst];
  const std::string name =
      result.reference_kind == "logs" ? "robot, trial " + row.trial : result.reference_kind;
  return PathsOf(result, row, name, evaluator);
}

/// Figures of an earlier sweep into the same folder, which this one may not draw again.
void RemoveFigures(const std::filesystem::path& folder) {
  std::error_code no_folder;
  for (const auto& entry : std::filesystem::directory_iterator(folder, no_folder)) {
    const std::string extension = entry.path().extension().string();
    const bool is_ours = entry.path().filename().string().starts_with("fig") &&
                         (extension == ".svg" || extension == ".png");
    if (is_ours) std::filesystem::remove(entry.path());
  }
}

}  // namespace

void WriteSweepReport(const std::filesystem::path& folder, const sweep::SweepResult& result,
                      const sweep::Explanation& explanation,
                      const std::vector<sweep::ProgramCell>& programs,
                      sweep::Evaluator& evaluator) {
  const report::SweepFigureSet set = report::SweepFigures(result, WorstPair(result, evaluator));
  RemoveFigures(folder / "figures");
  for (const report::Figure& figure : set.figures) {
    WriteFigureFiles(folder / "figures", figure);
  }
  for (const report::OmittedFigure& omitted : set.omitted) {
    terminal::Say(fmt::format("note: {} is not drawn: {}", omitted.name, omitted.reason));
  }
  files::WriteFile(folder / "report.html",
                   report::RenderPage(result, explanation,
                                      {TypicalFailures(result, explanation, evaluator),
                                       GapFlags(evaluator.experiment()), programs}));
}

}  // namespace rift::commands
