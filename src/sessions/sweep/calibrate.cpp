#include "rift/sessions/sweep/calibrate.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "cluster.hpp"
#include "kept_calibration.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/journal.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;

/// The fit by a job of the cluster, or by one of an earlier run. Nothing when it was told to stop.
std::optional<sweep::CalibrationReport> FitOnCluster(sweep::Evaluator& evaluator,
                                                     const FitRequest& request,
                                                     const SweepObserver& observer,
                                                     const sweep::Say& say) {
  const GoOn go_on = observer.watch_for_stop();
  const fs::path file = request.out / kJournalName;
  const sweep::Facts facts = FactsOf(evaluator.experiment());
  sweep::Journal journal(file, facts);
  journal.SetNote("name", evaluator.experiment().name);
  Cluster cluster(evaluator, facts, *request.cluster, observer, go_on);
  if (!cluster.Resume(request.out, journal)) return std::nullopt;
  KeptCalibration kept(evaluator);
  std::optional<sweep::CalibrationReport> found = kept.Find(journal, say);
  if (!found) {
    sweep::KeysHash keys;
    keys.Add(kept.key());
    if (!cluster.RunAsOne({.kind = sweep::ShardKind::kCalibration, .keys = keys.Text()})) {
      return std::nullopt;
    }
    found = kept.Find(journal, say);
  }
  if (!found) {
    throw std::runtime_error(fmt::format(
        "{}: what the job brought back is damaged; run the same command again", file.string()));
  }
  journal.SetNote("state", "done");
  journal.Close();
  return found;
}

}  // namespace

std::optional<sweep::CalibrationReport> Fit(sweep::Evaluator& evaluator, const FitRequest& request,
                                            const SweepObserver& observer, const sweep::Say& say) {
  if (request.fresh) {
    RemoveFindings(request.out);
    sweep::SlurmShards::Forget(request.out, say);
    sweep::Journal::Remove(request.out / kJournalName);
  }
  if (request.cluster != nullptr) return FitOnCluster(evaluator, request, observer, say);
  ReadPictures(evaluator);
  return sweep::Identify(evaluator, request.jobs, say);
}

bool IsNote(const std::string& line) {
  return line.starts_with("note: ") || line.starts_with("warning: ");
}

void SaveCalibration(const fs::path& folder, const sweep::Evaluator& evaluator,
                     const sweep::CalibrationReport& found) {
  const experiment::Experiment& experiment = evaluator.experiment();
  files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(folder / "inputs.txt", evaluator.InputsText());
  files::WriteFile(folder / "calibration.json", report::CalibrationJson(experiment, found));
}

bool SaveCalibrationFigure(const fs::path& folder, const std::string& name,
                           const sweep::CalibrationReport& found) {
  const std::optional<report::Figure> figure = report::CalibrationFigure(name, found);
  if (figure) report::WriteFigureFiles(folder / "figures", *figure);
  return figure.has_value();
}

}  // namespace rift::sessions
