#include "figure_file.hpp"
#include "gap_output.hpp"
#include "rift/report/figures/gap_figures.hpp"

namespace rift::commands {
void WriteGapFigure(const std::filesystem::path& path, const GapEvidence& evidence) {
  std::vector<report::ComparedPair> pairs;
  for (size_t i = 0; i < evidence.trials.size(); ++i) {
    const std::string name = std::filesystem::path(evidence.trials[i].path).stem().string();
    pairs.push_back(report::ComparePair(std::filesystem::path(evidence.sim_path).stem().string(),
                                        evidence.sim, name, evidence.reals[i], evidence.options));
  }
  const report::Figure figure = report::Stack("gap", "paths, error over u and its distribution",
                                              report::GapFigures(pairs, evidence.options));
  WriteFigure(path, figure);
}

}  // namespace rift::commands
