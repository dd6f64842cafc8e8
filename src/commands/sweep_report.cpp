#include "sweep_report.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "files.hpp"
#include "rift/report/figures/sweep_figures.hpp"
#include "rift/report/page/page.hpp"
#include "sweep_explain.hpp"

namespace rift::commands {
namespace {

std::optional<report::ComparedPair> WorstPair(const sweep::SweepResult& result,
                                              sweep::Evaluator& evaluator) {
  const std::optional<int> worst = report::WorstRow(result);
  if (!worst) return std::nullopt;
  const sweep::TrialRow& row = result.rows[*worst];
  const sweep::TrialRequest request{.theta = row.theta, .trial = row.trial, .seed = row.seed};
  const sweep::Recording reference = evaluator.Reference(request);
  const sweep::Recording candidate = evaluator.Candidate(request, reference);
  const std::string name =
      result.reference_kind == "logs" ? "robot, trial " + row.trial : result.reference_kind;
  return report::ComparePair("simulator", candidate.trajectory, name, reference.trajectory,
                             result.gap);
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
                      const sweep::Explanation& explanation, sweep::Evaluator& evaluator) {
  const report::SweepFigureSet set = report::SweepFigures(result, WorstPair(result, evaluator));
  RemoveFigures(folder / "figures");
  for (const report::Figure& figure : set.figures) {
    const std::filesystem::path path = folder / "figures" / figure.name;
    WriteFile(path.string() + ".svg", report::Render(figure, report::FigureFormat::kSvg));
    WriteFile(path.string() + ".png", report::Render(figure, report::FigureFormat::kPng));
  }
  for (const report::OmittedFigure& omitted : set.omitted) {
    fmt::print(stderr, "note: {} is not drawn: {}\n", omitted.name, omitted.reason);
  }
  WriteFile(folder / "report.html",
            report::RenderPage(result, explanation,
                               {TypicalFailures(result, explanation, evaluator),
                                GapFlags(evaluator.experiment())}));
}

}  // namespace rift::commands
