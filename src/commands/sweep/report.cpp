#include "report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sweep/falsify/evidence.hpp"
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

std::string ReferenceName(const sweep::SweepResult& result, const sweep::TrialRow& row,
                          const experiment::Experiment& experiment) {
  if (result.reference_kind == "logs") return "robot, trial " + row.trial;
  if (result.reference_kind == "nominal") return "undisturbed run";
  if (result.reference_kind == "program") return "reference run " + row.trial;
  return PathName(experiment);
}

/// The references of a page by what they are, equal ones once.
class References {
 public:
  References(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
             report::PageEvidence& evidence)
      : result_(result), evaluator_(evaluator), evidence_(evidence) {
    evidence.reference_of_row.assign(result.rows.size(), -1);
  }

  /// Takes that of the row. False when there is none.
  bool Take(int index) {
    const sweep::TrialRow& row = result_.rows[index];
    if (row.status == sweep::TrialStatus::kInvalid) return false;
    const sweep::Recording reference =
        evaluator_.Reference({.theta = row.theta, .trial = row.trial, .seed = row.seed});
    if (reference.status != sweep::TrialStatus::kOk) return false;
    const auto [found, is_new] = known_.try_emplace(sweep::Fingerprint(reference.trajectory),
                                                    static_cast<int>(evidence_.references.size()));
    if (is_new) {
      evidence_.references.push_back({ReferenceName(result_, row, evaluator_.experiment()),
                                      sweep::EvenPath(reference.trajectory, result_.gap)});
    }
    evidence_.reference_of_row[index] = found->second;
    return true;
  }

 private:
  const sweep::SweepResult& result_;
  sweep::Evaluator& evaluator_;
  report::PageEvidence& evidence_;
  std::map<std::uint64_t, int> known_;
};

/// What the paths are drawn against. The path of a task is that of all repeats; of logs each is
/// read already; a reference that has to be computed is the worst trial's alone.
void TakeReferences(const sweep::SweepResult& result, sweep::Evaluator& evaluator, bool may_compute,
                    report::PageEvidence& evidence) {
  constexpr size_t kMostReferences = 100;
  if (evaluator.experiment().objective == experiment::Objective::kOdometry) return;
  References references(result, evaluator, evidence);
  if (result.reference_kind != "logs" && result.reference_kind != "path") {
    if (!may_compute) return;
    if (const std::optional<int> worst = sweep::WorstRow(result)) references.Take(*worst);
    return;
  }
  for (const sweep::SettingResult& setting : result.settings) {
    for (const int row : setting.rows) {
      if (evidence.references.size() >= kMostReferences) return;
      if (!references.Take(row)) continue;
      if (result.reference_kind == "logs") continue;
      for (const int repeat : setting.rows) {
        evidence.reference_of_row[repeat] = evidence.reference_of_row[row];
      }
      break;
    }
  }
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
  return PathsOf(result, row, ReferenceName(result, row, evaluator.experiment()), evaluator);
}

/// What a page is made of beside the result, the figures left out.
report::PageEvidence EvidenceFor(const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                 bool may_compute) {
  report::PageEvidence evidence;
  TakeReferences(result, evaluator, may_compute, evidence);
  evidence.gap_flags = GapFlags(evaluator.experiment());
  for (const control::Waypoint& waypoint : evaluator.experiment().waypoints) {
    evidence.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  return evidence;
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
  const std::optional<report::ComparedPair> worst = WorstPair(result, evaluator);
  const report::SweepFigureSet set = report::SweepFigures(result, worst);
  report::PageEvidence evidence = EvidenceFor(result, evaluator, true);
  evidence.programs = programs;
  if (worst) {
    const std::vector<Eigen::Vector2d>& samples_m = worst->profile.sim_m;
    for (size_t i = 0; i <= sweep::kPathSteps; ++i) {
      const Eigen::Vector2d& sample_m = samples_m[i * (samples_m.size() - 1) / sweep::kPathSteps];
      evidence.worst_path_m.emplace_back(sample_m.cast<float>());
    }
  }
  RemoveFigures(folder / "figures");
  for (const report::Figure& figure : set.figures) {
    WriteFigureFiles(folder / "figures", figure);
    evidence.figures.push_back(
        {figure.title, files::ReadFile(folder / "figures" / (figure.name + ".svg"))});
  }
  for (const report::OmittedFigure& omitted : set.omitted) {
    terminal::Say(fmt::format("note: {} is not drawn: {}", omitted.name, omitted.reason));
  }
  files::WriteFile(folder / "report.html", report::RenderPage(result, explanation, evidence));
}

std::string RunningReport(const sweep::SweepResult& result, sweep::Evaluator& evaluator) {
  report::PageEvidence evidence = EvidenceFor(result, evaluator, false);
  evidence.running =
      fmt::format("{} trials so far, {} of them failed", result.rows.size(), result.all.failures);
  return report::RenderPage(result, sweep::Explain(result), evidence);
}

}  // namespace rift::commands
