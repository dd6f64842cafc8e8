#include "rift/sessions/sweep/folder.hpp"

#include <array>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"

namespace rift::sessions {

namespace fs = std::filesystem;

namespace {

/// The report, which tells of the table beside it.
constexpr std::array<const char*, 4> kReport{"report.html", "explanation.json", "likeness.json",
                                             "programs.json"};
/// What else a sweep or a fit writes beside experiment.yaml, which is the first that is there.
constexpr std::array<const char*, 8> kFound{"table.csv",        "summary.json", "inputs.txt",
                                            "calibration.json", "shrunk",       "shrunk.json",
                                            "rare_event.json",  kLivePageName};

/// Whether report::SweepFigures() or CalibrationFigure() gives a figure such a name.
bool IsFigureName(const fs::path& file) {
  const std::string stem = file.stem().string(), extension = file.extension().string();
  if (extension != ".svg" && extension != ".png") return false;
  const auto is_digit = [](char c) { return '0' <= c && c <= '9'; };
  const bool has_number = stem.starts_with("fig") && stem.size() > 5 && is_digit(stem[3]) &&
                          is_digit(stem[4]) && stem[5] == '_';  // fig07_gap_by_setting
  return has_number || stem.starts_with("gap_over_") || stem == "calibration";
}

std::vector<fs::path> FiguresIn(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code no_folder;
  for (const auto& entry : fs::directory_iterator(folder / "figures", no_folder)) {
    if (IsFigureName(entry.path())) files.push_back(entry.path());
  }
  return files;
}

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

fs::path OthersFile(const fs::path& folder) {
  if (fs::exists(folder / "experiment.yaml") || fs::exists(folder / kJournalName)) return {};
  std::vector<fs::path> files;
  for (const char* name : kFound) files.push_back(folder / name);
  for (const char* name : kReport) files.push_back(folder / name);
  for (const fs::path& file : files) {
    if (fs::exists(file)) return file;
  }
  const std::vector<fs::path> figures = FiguresIn(folder);
  return figures.empty() ? fs::path() : figures.front();
}

void RemoveFigures(const fs::path& folder) {
  for (const fs::path& file : FiguresIn(folder)) fs::remove(file);
  std::error_code no_folder;
  fs::remove(folder / "figures", no_folder);  // unless it holds files of others
}

void RemoveReport(const fs::path& folder) {
  for (const char* name : kReport) fs::remove(folder / name);
  RemoveFigures(folder);
}

void RemoveFindings(const fs::path& folder) {
  RemoveReport(folder);
  for (const char* name : kFound) fs::remove_all(folder / name);
}

void SaveResult(const fs::path& folder, const sweep::Evaluator& evaluator,
                const sweep::SweepResult& result) {
  files::WriteFile(folder / "experiment.yaml", experiment::WriteExperiment(evaluator.experiment()));
  files::WriteFile(folder / "inputs.txt", evaluator.InputsText());
  files::WriteFile(folder / "table.csv", report::TableCsv(result));
  files::WriteFile(folder / "summary.json", report::SummaryJson(result));
}

}  // namespace rift::sessions
