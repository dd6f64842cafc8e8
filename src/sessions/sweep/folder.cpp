#include "rift/sessions/sweep/folder.hpp"

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"

namespace rift::sessions {

namespace fs = std::filesystem;

experiment::Experiment SavedExperiment(const fs::path& folder) {
  return experiment::LoadExperiment((folder / "experiment.yaml").string(), {},
                                    [](const std::string& path) { return files::ReadFile(path); });
}

bool HoldsOtherExperiment(const fs::path& folder, const experiment::Experiment& experiment) {
  const bool goes_on = IsComputed(experiment) && experiment.goal != experiment::Goal::kCalibrate &&
                       fs::exists(folder / kJournalName);
  const fs::path saved = folder / "experiment.yaml";
  if (goes_on || !fs::exists(saved)) return false;
  return files::ReadFile(saved) != experiment::WriteExperiment(experiment);
}

void RemoveReport(const fs::path& folder) {
  for (const char* name :
       {"report.html", "explanation.json", "likeness.json", "programs.json", "figures"}) {
    fs::remove_all(folder / name);
  }
}

void RemoveFindings(const fs::path& folder) {
  RemoveReport(folder);
  for (const char* name : {"shrunk", "shrunk.json", "rare_event.json"}) {
    fs::remove_all(folder / name);
  }
}

void SaveResult(const fs::path& folder, const sweep::Evaluator& evaluator,
                const sweep::SweepResult& result) {
  files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(evaluator.experiment()));
  files::WriteFile(folder / "inputs.txt", evaluator.InputsText());
  files::WriteFile(folder / "table.csv", report::TableCsv(result));
  files::WriteFile(folder / "summary.json", report::SummaryJson(result));
}

}  // namespace rift::sessions
