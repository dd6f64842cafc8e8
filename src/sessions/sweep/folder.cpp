#include "rift/sessions/sweep/folder.hpp"

#include <algorithm>
#include <array>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"

namespace rift::sessions {

namespace fs = std::filesystem;

namespace {

/// Beside experiment.yaml, which is the first that is there.
constexpr std::array<const char*, 5> kWritten{"table.csv", "summary.json", "inputs.txt",
                                              "report.html", "calibration.json"};

}  // namespace

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

bool HoldsOthersFiles(const fs::path& folder) {
  if (fs::exists(folder / "experiment.yaml") || fs::exists(folder / kJournalName)) return false;
  return std::any_of(kWritten.begin(), kWritten.end(),
                     [&](const char* name) { return fs::exists(folder / name); });
}

void RemoveFigures(const fs::path& folder) {
  const fs::path figures = folder / "figures";
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator(figures, no_folder)) {
    const std::string stem = entry.path().stem().string();
    const std::string extension = entry.path().extension().string();
    const bool is_named =
        stem.starts_with("fig") || stem.starts_with("gap_over_") || stem == "calibration";
    if (is_named && (extension == ".svg" || extension == ".png")) fs::remove(entry.path());
  }
  fs::remove(figures, no_folder);  // unless it holds files of others
}

void RemoveReport(const fs::path& folder) {
  for (const char* name : {"report.html", "explanation.json", "likeness.json", "programs.json"}) {
    fs::remove(folder / name);
  }
  RemoveFigures(folder);
}

void RemoveFindings(const fs::path& folder) {
  RemoveReport(folder);
  for (const char* name : {"table.csv", "summary.json", "calibration.json", "inputs.txt", "shrunk",
                           "shrunk.json", "rare_event.json"}) {
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
