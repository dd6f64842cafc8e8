#include "rift/sessions/sweep/findings.hpp"

#include <fmt/format.h>

#include <optional>

#include "page_evidence.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/page/page.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "rift/sweep/run/machine_trouble.hpp"
#include "robot_logs.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

/// The path of the worst trial for its picture, whose row may have none.
std::vector<Eigen::Vector2f> PathOf(const report::ComparedPair& worst) {
  const std::vector<Eigen::Vector2d>& samples_m = worst.profile.sim_m;
  std::vector<Eigen::Vector2f> path_m;
  for (size_t i = 0; i <= sweep::kPathSteps; ++i) {
    const Eigen::Vector2d& sample_m = samples_m[i * (samples_m.size() - 1) / sweep::kPathSteps];
    path_m.emplace_back(sample_m.cast<float>());
  }
  return path_m;
}

/// The figures, then the page with them.
void SavePage(const fs::path& folder, sweep::Evaluator& evaluator, const sweep::SweepResult& result,
              const SweepFindings& findings, const SweepObserver& observer) {
  const std::optional<WorstPaths> worst = WorstPair(result, evaluator, observer.say);
  std::optional<report::ComparedPair> pair;
  if (worst) pair = worst->pair;
  const report::SweepFigureSet set = report::SweepFigures(result, pair);
  report::PageEvidence evidence =
      EvidenceFor(result, evaluator, worst ? &worst->reference : nullptr);
  evidence.programs = findings.programs;
  if (pair) evidence.worst_path_m = PathOf(*pair);
  RemoveFigures(folder);
  for (const report::Figure& figure : set.figures) {
    report::WriteFigureFiles(folder / "figures", figure);
    evidence.figures.push_back(
        {figure.title, files::ReadFile(folder / "figures" / (figure.name + ".svg"))});
  }
  for (const report::OmittedFigure& omitted : set.omitted) {
    observer.say(fmt::format("note: {} is not drawn: {}", omitted.name, omitted.reason));
  }
  files::WriteFile(folder / "report.html",
                   report::RenderPage(result, findings.explanation, evidence));
}

}  // namespace

SweepFindings ExplainSweep(const fs::path& folder, sweep::Evaluator& evaluator,
                           const sweep::SweepResult& result, int suggest, int jobs) {
  sweep::ExplainOptions options;
  if (suggest > 0) options.suggest.experiments = suggest;
  options.robot = TakeRobotLogs(folder, evaluator);
  SweepFindings findings{.explanation = sweep::Explain(result, options)};
  if (suggest > 0) {
    const bool is_saved =
        SaveSuggested(folder, evaluator.experiment(), result, findings.explanation.suggestions);
    if (!is_saved) {
      findings.notes.push_back(
          "note: suggested.yaml is not written: candidate.kind is logs, and no drive sets the "
          "parameters of recorded logs");
    }
  }
  // Runs for the report alone are left out where this machine cannot make them, as where a program
  // is on the nodes of a cluster only: the trials are done.
  const auto try_to = [&](const char* what, auto& rows, auto&& measure) {
    try {
      rows = measure();
    } catch (const sweep::MachineTrouble& trouble) {
      findings.notes.push_back(fmt::format("note: {} is left out: {}", what, trouble.what()));
    }
  };
  try_to("likeness.json", findings.likeness,
         [&] { return sweep::MeasureSweepLikeness(evaluator, jobs); });
  try_to("programs.json", findings.programs, [&] { return sweep::MeasurePrograms(evaluator); });
  return findings;
}

void SaveReport(const fs::path& folder, sweep::Evaluator& evaluator,
                const sweep::SweepResult& result, const SweepFindings& findings,
                const SweepObserver& observer) {
  for (const std::string& note : findings.notes) observer.say(note);
  files::WriteFile(folder / "explanation.json",
                   report::ExplanationJson(result, findings.explanation));
  SavePage(folder, evaluator, result, findings, observer);
  if (!findings.programs.empty()) {
    files::WriteFile(folder / "programs.json",
                     report::ProgramsJson(result.parameters, findings.programs));
  }
  if (!findings.likeness.empty()) {
    files::WriteFile(folder / "likeness.json",
                     report::Dump(report::LikenessJson(findings.likeness)));
  }
}

}  // namespace rift::sessions
