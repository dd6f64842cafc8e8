#include "sweep_report.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "files.hpp"
#include "rift/report/page.hpp"
#include "rift/report/sweep_figures.hpp"

namespace rift::commands {
namespace {

std::optional<report::ComparedPair> WorstPair(const sweep::SweepResult& result,
                                              const sweep::LogSource& source) {
  const std::optional<int> worst = report::WorstRow(result);
  if (!worst) return std::nullopt;
  const sweep::TrialRow& row = result.rows[*worst];
  const sweep::LoadedLog sim = source(row.candidate, sweep::Side::kCandidate);
  const sweep::LoadedLog real = source(row.reference, sweep::Side::kReference);
  return report::ComparePair("simulator", sim.trajectory, "robot, trial " + row.trial,
                             real.trajectory, result.gap);
}

}  // namespace

void WriteSweepReport(const std::filesystem::path& folder, const sweep::SweepResult& result,
                      const sweep::LogSource& source) {
  const report::SweepFigureSet set = report::SweepFigures(result, WorstPair(result, source));
  for (const report::Figure& figure : set.figures) {
    const std::filesystem::path path = folder / "figures" / figure.name;
    WriteFile(path.string() + ".svg", report::Render(figure, report::FigureFormat::kSvg));
    WriteFile(path.string() + ".png", report::Render(figure, report::FigureFormat::kPng));
  }
  for (const report::OmittedFigure& omitted : set.omitted) {
    fmt::print(stderr, "note: {} is not drawn: {}\n", omitted.name, omitted.reason);
  }
  WriteFile(folder / "report.html", report::RenderPage(result));
}

}  // namespace rift::commands
