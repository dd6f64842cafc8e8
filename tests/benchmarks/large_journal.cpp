// Writes the journal of a whole grid without driving it, so that what the end of a large sweep
// costs (reading, judging, explaining, report) can be measured with `rift sweep` itself:
//
//   large_journal EXPERIMENT.yaml OUT && /usr/bin/time -v rift sweep EXPERIMENT.yaml --out OUT
//
// Rows are those of a straight drive; the gap is drawn about a mean that the setting decides.
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/statistics/random.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"
#include "support/inputs/paths.hpp"

namespace rift {
namespace {

constexpr int kPaths = sweep::TrialRunner::kMostPaths;

sweep::TrialRow MadeUpRow(const experiment::Experiment& experiment,
                          const sweep::TrialRequest& request, double mean, double noise) {
  static const sweep::Recording path{.source = "simulation",
                                     .trajectory = test::StraightPath(0.7, 40)};
  static const sweep::TrialRow kept = sweep::CompareTrial(
      experiment, request, path, {.source = "nominal", .trajectory = test::StraightPath(0.7, 40)});
  sweep::TrialRow row = kept;
  row.seed = request.seed;
  row.comparison.gap_m = experiment.gap.threshold_m * (0.3 + 0.8 * mean + 0.2 * noise);
  row.falsified = row.comparison.gap_m > experiment.gap.threshold_m;
  return row;
}

int Write(const std::string& file, const std::filesystem::path& out) {
  const experiment::Experiment experiment = commands::ReadExperiment(file, {});
  sweep::Evaluator evaluator(experiment, file, commands::FileInputs());
  std::filesystem::create_directories(out);
  sweep::Journal journal(out / sessions::kJournalName, sessions::FactsOf(experiment));
  statistics::Random random(experiment.seed, 1);
  int rows = 0;
  for (const experiment::Theta& theta : experiment::GridPoints(experiment.space.parameters)) {
    const double mean = random.Uniform();
    for (const sweep::TrialRequest& request : sweep::TrialsAt(experiment, theta)) {
      sweep::TrialRow row = MadeUpRow(experiment, request, mean, random.Uniform());
      if (rows >= kPaths) row.evidence.path_m = {};
      row.evidence.fingerprint = static_cast<std::uint64_t>(rows) + 1;  // no two paths are one
      journal.Add(evaluator.KeyOf(request), {.status = "ok",
                                             .gap_m = row.comparison.gap_m,
                                             .falsified = row.falsified,
                                             .bytes = sweep::EncodeFindings(row)});
      ++rows;
    }
  }
  journal.Close();
  fmt::print("{} rows\n", rows);
  return 0;
}

}  // namespace
}  // namespace rift

int main(int argc, char** argv) try {
  if (argc != 3) {
    fmt::print(stderr, "large_journal EXPERIMENT.yaml OUT\n");
    return 2;
  }
  return rift::Write(argv[1], argv[2]);
} catch (const std::exception& error) {
  fmt::print(stderr, "large_journal: {}\n", error.what());
  return 1;
}
