#include "series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "before_each.hpp"
#include "folder.hpp"
#include "identification.hpp"
#include "plan.hpp"
#include "prompt.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "session.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using experiment::Experiment;

/// What a drive depends on; limits of the line or the camera may change from day to day.
bool ChangesDrives(const std::string& key) {
  for (const char* block : {"control.", "trial.", "space", "waypoints", "reference.path"}) {
    if (key.starts_with(block)) return true;
  }
  return false;
}

/// Drives of two experiments must not end up in one table. --repeat may be given a larger number.
void CheckSameSeries(const fs::path& file, const Experiment& sweep) {
  if (!fs::exists(file)) return;
  const Experiment before = ReadExperiment(file);
  std::map<std::string, std::string> old_values = experiment::FlatValues(before);
  for (const auto& [key, value] : experiment::FlatValues(sweep)) {
    if (!ChangesDrives(key) || old_values[key] == value) continue;
    throw std::invalid_argument(fmt::format(
        "{} is the table of other drives: {} was {} and is {} now; choose another --out",
        file.string(), key, old_values[key].empty() ? "not there" : old_values[key], value));
  }
}

/// An earlier try is evidence as well.
void SetAside(const fs::path& folder) {
  for (int i = 1;; ++i) {
    const fs::path aside = folder.string() + std::to_string(i);
    if (fs::exists(aside)) continue;
    fs::rename(folder, aside);
    return;
  }
}

class Series {
 public:
  enum class End { kDone, kLeft, kQuit };

  Series(const DriveRequest& request, const SeriesPlan& plan)
      : request_(request), plan_(plan), session_(request) {}

  /// Drives the trial unless it is done.
  End Drive(const PlannedTrial& trial);
  /// Before a sweep takes the processors.
  void Close() {
    session_.Close();
    scene_.reset();
  }

 private:
  std::optional<End> AskAboutUnfinished(const PlannedTrial& trial) const;
  bool LayFloor(const PlannedTrial& trial);
  void SetScene(const PlannedTrial& trial);

  const DriveRequest& request_;
  const SeriesPlan& plan_;
  std::optional<SceneCommand> scene_;  // it outlives the port and the camera that it may serve
  DriveSession session_;
  std::optional<std::string> floor_;
};

Series::End Series::Drive(const PlannedTrial& trial) {
  for (int tries = 0;; ++tries) {
    if (fs::exists(trial.Unfinished())) {
      if (tries > 0 && request_.yes) return End::kLeft;  // or it would go on for ever
      if (const std::optional<End> end = AskAboutUnfinished(trial)) return *end;
    }
    if (!LayFloor(trial)) return End::kQuit;
    SetScene(trial);
    const hardware::DriveRun run = session_.DriveInto(trial.Unfinished(), trial.experiment);
    if (scene_) Close();
    terminal::Say(fmt::format("{}: {}", trial.label, run.trial.reason));
    SaySteering(trial.experiment, run);
    session_.RequireLog();
    if (!run.has_begun) {
      fs::remove_all(trial.Unfinished());
      return End::kQuit;
    }
    if (run.trial.outcome == trial::Outcome::kReached) {
      fs::rename(trial.Unfinished(), trial.folder);
      return End::kDone;
    }
    if (run.evidence.stop->reason == hardware::StopReason::kSignal) return End::kQuit;
  }
}

std::optional<Series::End> Series::AskAboutUnfinished(const PlannedTrial& trial) const {
  const bool has_log = fs::exists(trial.Unfinished() / "trajectory.csv");
  const char answer =
      Ask(fmt::format("{} was begun and did not reach the end: {}s: skip, q: quit", trial.label,
                      has_log ? "Enter: again, k: keep it as it is, " : "Enter: again, "),
          has_log ? "aks" : "as", request_.yes);
  switch (answer) {
    case 'a':
      SetAside(trial.Unfinished());
      return std::nullopt;
    case 'k':
      fs::rename(trial.Unfinished(), trial.folder);
      return End::kDone;
    case 's':
      return End::kLeft;
    default:
      return End::kQuit;
  }
}

bool Series::LayFloor(const PlannedTrial& trial) {
  const std::string& floor = trial.experiment.simulation.terrain.surface;
  if (!plan_.has_floors || floor_ == floor) return true;
  if (Ask(fmt::format("lay the {}; Enter (q: quit)", floor), "y", request_.yes) == 'q')
    return false;
  floor_ = floor;
  return true;
}

void Series::SetScene(const PlannedTrial& trial) {
  if (request_.before_each.empty()) return;
  std::vector<std::string> words = WordsOf(request_.before_each);
  for (std::string& word : words) {
    try {
      word = experiment::FillTemplate(word, plan_.parameters, trial.theta, trial.trial);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--before-each: {}", error.what()));
    }
  }
  scene_.emplace(words);
  const DriveAddress to = scene_->address().value_or(DriveAddress{});
  session_.MoveTo(to.port, to.camera, to.calibration);
}

/// The drives are there, whatever becomes of the sweep.
int RunSweep(const fs::path& out, bool json) {
  return terminal::ReportErrors([&] { return SweepFile(out / "sweep.yaml", out / "sweep", json); });
}

}  // namespace

namespace {

SeriesPlan PlanOf(const DriveRequest& request, const Experiment& experiment, const fs::path& out) {
  if (!request.suggested.empty()) return PlanSuggested(experiment, request.suggested);
  if (request.grid) return PlanGrid(experiment, out);
  if (!request.identify) return PlanRepeats(experiment, request.repeat, out);
  SeriesPlan plan =
      PlanRepeats(experiment, request.repeat > 0 ? request.repeat : kIdentificationRuns, out);
  plan.sweep = IdentificationFit(std::move(plan.sweep));
  return plan;
}

fs::path FolderOf(const DriveRequest& request, const Experiment& experiment) {
  if (!request.suggested.empty()) return sessions::SuggestedFolder(request.suggested);
  fs::path out = NewFolder(request, experiment);
  RefuseSweepFolder(out);
  return out;
}

/// What a person does with the drives, where they are not swept at once.
void SayWhatNext(const DriveRequest& request, const fs::path& out) {
  if (!request.suggested.empty()) {
    const fs::path sweep = request.suggested;
    terminal::Say(fmt::format("what they confirm: rift sweep {} --out {}",
                              (sweep / "experiment.yaml").string(), sweep.string()));
  } else if (request.identify) {
    terminal::Say(fmt::format("fit the simulated robot: rift sweep {} --out {} --write-robot {}",
                              (out / "sweep.yaml").string(), (out / "sweep").string(),
                              (out / "robot.yaml").string()));
  } else if (!request.grid) {
    terminal::Say(fmt::format("against the simulator: rift sweep {} --out {}",
                              (out / "sweep.yaml").string(), (out / "sweep").string()));
  }
}

}  // namespace

int DriveSeries(const DriveRequest& request, const Experiment& experiment) {
  const fs::path out = FolderOf(request, experiment);
  const SeriesPlan plan = PlanOf(request, experiment, out);
  const files::FolderLock lock(out);
  CheckSameSeries(out / "sweep.yaml", plan.sweep);
  files::WriteFile(out / "sweep.yaml", experiment::WriteExperiment(plan.sweep));

  const auto is_done = [](const PlannedTrial& trial) { return fs::exists(trial.folder); };
  const auto count = plan.trials.size();
  terminal::Say(fmt::format("{} drive{} into {}, {} of them done", count, count == 1 ? "" : "s",
                            out.string(),
                            std::count_if(plan.trials.begin(), plan.trials.end(), is_done)));
  Series series(request, plan);
  std::size_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const PlannedTrial& trial = plan.trials[i];
    if (is_done(trial)) continue;
    terminal::Say(fmt::format("drive {} of {}: {}", i + 1, count, trial.label));
    const Series::End end = series.Drive(trial);
    if (end == Series::End::kQuit) {
      terminal::Say("stopped; the same command goes on where it was");
      return terminal::kNotReached;
    }
    left += end == Series::End::kLeft;
  }
  series.Close();
  if (left > 0)
    terminal::Say(
        fmt::format("{} of {} drives did not reach the end; the same command asks "
                    "about them again",
                    left, count));
  const int reported = request.grid ? RunSweep(out, request.json) : terminal::kDone;
  SayWhatNext(request, out);
  return left > 0 ? terminal::kNotReached : reported;
}

}  // namespace rift::commands
