#include "rift/sessions/drive/series.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "before_each.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/json/stop_text.hpp"
#include "rift/sessions/drive/session.hpp"
#include "rift/twin/options.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using experiment::Experiment;

/// What a drive depends on; limits of the line or the camera may change from day to day. The wheels
/// are what a program takes its powers and times from.
bool ChangesDrives(const std::string& key, bool is_program) {
  for (const char* block :
       {"control.", "trial.", "space", "waypoints", "program.", "reference.path"}) {
    if (key.starts_with(block)) return true;
  }
  return is_program && key.starts_with("hardware.odometry.drive.");
}

/// Drives of two experiments must not end up in one table. --repeat may be given a larger number.
void CheckSameSeries(const fs::path& file, const Experiment& sweep) {
  if (!fs::exists(file)) return;
  const Experiment before = experiment::LoadExperiment(file.string(), {}, files::ReadFile);
  std::map<std::string, std::string> old_values = experiment::FlatValues(before);
  const bool is_program = !sweep.program.segments.empty();
  for (const auto& [key, value] : experiment::FlatValues(sweep)) {
    if (!ChangesDrives(key, is_program) || old_values[key] == value) continue;
    throw std::invalid_argument(fmt::format(
        "{} is the table of other drives: {} was {} and is {} now; choose another --out",
        file.string(), key, old_values[key].empty() ? "not there" : old_values[key], value));
  }
}

/// The plan's sweep, with the listener that heard the drives so far where it was made for them: one
/// that speaks rift's protocol is src/firmware, any other is as the experiment tells.
Experiment SweepOfDriven(const SeriesPlan& plan) {
  if (!plan.sweeps_drives) return plan.sweep;
  std::size_t framed = 0, others = 0;
  for (const PlannedTrial& trial : plan.trials) {
    const std::string summary = files::ReadIfThere(trial.folder / "summary.json").value_or("");
    const std::optional<hardware::Protocol> spoken = report::DriveProtocol(summary);
    if (spoken) ++(*spoken == hardware::Protocol::kFramed ? framed : others);
  }
  Experiment sweep = plan.sweep;
  if (framed > 0 && others == 0) sweep.simulation.link = twin::WithFirmware(sweep.simulation.link);
  return sweep;
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

class Driver {
 public:
  /// `series` and `console` must outlive it.
  Driver(const DriveSeries& series, const Console& console)
      : series_(series), console_(console), session_(series.setup, console) {}

  /// Drives the trial unless it is done.
  SeriesEnd Drive(const PlannedTrial& trial);
  bool StopWasAsked() const { return session_.StopWasAsked(); }
  /// Before a sweep takes the processors.
  void Close() {
    session_.Close();
    scene_.reset();
  }

 private:
  std::optional<SeriesEnd> AskAboutUnfinished(const PlannedTrial& trial) const;
  bool EndsSeries(const hardware::DriveRun& run) const;
  bool LayFloor(const PlannedTrial& trial);
  void SetScene(const PlannedTrial& trial);

  const DriveSeries& series_;
  const Console& console_;
  std::optional<SceneCommand> scene_;  // it outlives the port and the camera that it may serve
  DriveSession session_;
  std::optional<std::string> floor_;
};

SeriesEnd Driver::Drive(const PlannedTrial& trial) {
  for (int tries = 0;; ++tries) {
    if (fs::exists(trial.Unfinished())) {
      if (tries > 0 && series_.setup.yes) return SeriesEnd::kLeft;  // or it would go on for ever
      if (const std::optional<SeriesEnd> end = AskAboutUnfinished(trial)) return *end;
    }
    if (!LayFloor(trial)) return SeriesEnd::kQuit;
    SetScene(trial);
    const hardware::DriveRun run = session_.DriveInto(trial.Unfinished(), trial.experiment);
    if (scene_) Close();
    console_.say(fmt::format("{}: {}", trial.label, run.trial.reason));
    for (const std::string& line : SteeringLines(trial.experiment, run)) console_.say(line);
    const bool may_drive_on = run.evidence.stop_acknowledged == false;
    if (may_drive_on) console_.say(report::StopText(false));
    session_.RequireLog();
    if (!run.has_begun) return SeriesEnd::kQuit;
    if (run.trial.outcome == trial::Outcome::kReached) {
      fs::rename(trial.Unfinished(), trial.folder);
      return may_drive_on ? SeriesEnd::kQuit : SeriesEnd::kDone;
    }
    if (may_drive_on || EndsSeries(run)) return SeriesEnd::kQuit;
  }
}

// A person who stopped the robot wants it to stand. After a fault somebody has to look at the
// scene, unless a command puts it back.
bool Driver::EndsSeries(const hardware::DriveRun& run) const {
  if (WasEndedByPerson(run)) return true;
  if (!WasEndedByFault(run)) return false;
  if (!series_.setup.yes || !series_.before_each.empty()) return false;
  console_.say(
      "the series ends with this fault: with --yes nobody looks before the next drive, and no "
      "--before-each puts the scene back");
  return true;
}

std::optional<SeriesEnd> Driver::AskAboutUnfinished(const PlannedTrial& trial) const {
  const bool has_log = fs::exists(trial.Unfinished() / "trajectory.csv");
  const char answer = console_.ask(
      fmt::format("{} was begun and did not reach the end: {}s: skip, q: quit", trial.label,
                  has_log ? "Enter: again, k: keep it as it is, " : "Enter: again, "),
      has_log ? "aks" : "as");
  switch (answer) {
    case 'a':
      SetAside(trial.Unfinished());
      return std::nullopt;
    case 'k':
      fs::rename(trial.Unfinished(), trial.folder);
      return SeriesEnd::kDone;
    case 's':
      return SeriesEnd::kLeft;
    default:
      return SeriesEnd::kQuit;
  }
}

bool Driver::LayFloor(const PlannedTrial& trial) {
  const std::string& floor = trial.experiment.simulation.terrain.surface;
  if (!series_.plan.has_floors || floor_ == floor) return true;
  if (console_.ask(fmt::format("lay the {}; Enter (q: quit)", floor), "y") == 'q') return false;
  floor_ = floor;
  return true;
}

void Driver::SetScene(const PlannedTrial& trial) {
  if (series_.before_each.empty()) return;
  std::vector<std::string> words = series_.before_each;
  for (std::string& word : words) {
    try {
      word = experiment::FillTemplate(word, series_.plan.parameters, trial.theta, trial.trial);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(fmt::format("--before-each: {}", error.what()));
    }
  }
  scene_.emplace(words);
  session_.MoveTo(scene_->address().value_or(DriveAddress{}));
}

}  // namespace

SeriesEnd DriveAll(const DriveSeries& series, const Console& console,
                   const std::function<void()>& then) {
  const fs::path& out = series.out;
  const SeriesPlan& plan = series.plan;
  const files::FolderLock lock(
      out,
      fmt::format("another rift drive or sweep is at work in {}: wait for it, or choose another "
                  "folder with --out",
                  out.string()));
  CheckSameSeries(out / "sweep.yaml", plan.sweep);
  Experiment sweep;
  const auto write_sweep = [&] {
    sweep = SweepOfDriven(plan);
    files::WriteFile(out / "sweep.yaml", experiment::WriteExperiment(sweep));
  };
  write_sweep();

  const auto is_done = [](const PlannedTrial& trial) { return fs::exists(trial.folder); };
  const auto count = plan.trials.size();
  console.say(fmt::format("{} drive{} into {}, {} of them done", count, count == 1 ? "" : "s",
                          out.string(),
                          std::count_if(plan.trials.begin(), plan.trials.end(), is_done)));
  Driver driver(series, console);
  std::size_t left = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const PlannedTrial& trial = plan.trials[i];
    if (is_done(trial)) continue;
    console.say(fmt::format("drive {} of {}: {}", i + 1, count, trial.label));
    SeriesEnd end = driver.Drive(trial);
    write_sweep();
    // A stop that came when the robot had arrived is one of what follows.
    const bool is_last = std::all_of(plan.trials.begin(), plan.trials.end(), is_done);
    if (driver.StopWasAsked() && !is_last) end = SeriesEnd::kQuit;
    if (end == SeriesEnd::kQuit) {
      console.say("stopped; the same command goes on where it was");
      return end;
    }
    left += end == SeriesEnd::kLeft;
  }
  driver.Close();
  if (left > 0)
    console.say(
        fmt::format("{} of {} drives did not reach the end; the same command asks "
                    "about them again",
                    left, count));
  if (const double told_s = plan.sweep.simulation.link.poll_s;
      sweep.simulation.link.poll_s != told_s) {
    console.say(fmt::format(
        "the robot answers as src/firmware does, so sweep.yaml simulates a listener that reads at "
        "once (simulation.link.poll_s {:g}, {:g} in the experiment)",
        sweep.simulation.link.poll_s, told_s));
  }
  then();
  return left > 0 ? SeriesEnd::kLeft : SeriesEnd::kDone;
}

}  // namespace rift::sessions
