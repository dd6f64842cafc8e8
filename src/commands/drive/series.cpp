#include "series.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "console.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/sessions/drive/identification.hpp"
#include "rift/sessions/drive/series.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using experiment::Experiment;

/// What `rift sweep --suggest` wrote into the folder of its sweep.
sessions::SeriesPlan PlanSuggested(const Experiment& experiment, const fs::path& folder) {
  std::vector<sessions::ChosenSetting> settings;
  for (const sessions::SuggestedExperiment& one : sessions::ReadSuggested(folder, experiment)) {
    settings.push_back({fmt::format("experiment {}", one.number), one.parameters, one.values});
    for (int trial = 1; trial <= one.repeats; ++trial) {
      settings.back().folders.push_back(sessions::SuggestedDrive(folder, one.number, trial));
    }
  }
  if (!settings.empty()) return sessions::PlanChosen(experiment, settings);
  throw std::invalid_argument(
      fmt::format("{} has no experiments to drive: rift sweep {} --out {} --suggest 3 writes them",
                  sessions::SuggestedFile(folder).string(), (folder / "experiment.yaml").string(),
                  folder.string()));
}

sessions::SeriesPlan PlanOf(const DriveRequest& request, const Experiment& experiment,
                            const fs::path& out) {
  if (!request.suggested.empty()) return PlanSuggested(experiment, request.suggested);
  if (request.grid) return sessions::PlanGrid(experiment, out);
  if (!request.identify) return sessions::PlanRepeats(experiment, request.repeat, out);
  const int runs = request.repeat > 0 ? request.repeat : sessions::kIdentificationRuns;
  sessions::SeriesPlan plan = sessions::PlanRepeats(experiment, runs, out);
  plan.sweep = sessions::IdentificationFit(std::move(plan.sweep));
  return plan;
}

/// The drives are there, whatever becomes of the sweep.
int RunSweep(const fs::path& out, bool json) {
  return terminal::ReportErrors([&] { return SweepFile(out / "sweep.yaml", out / "sweep", json); });
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

int DriveSeries(const DriveRequest& request, const Experiment& experiment, const fs::path& out) {
  const sessions::DriveSeries series{.out = out,
                                     .plan = PlanOf(request, experiment, out),
                                     .before_each = WordsOf(request.before_each),
                                     .setup = request.setup};
  int reported = terminal::kDone;
  const sessions::SeriesEnd end =
      sessions::DriveAll(series, TerminalConsole(request.setup.yes), [&] {
        if (request.grid) reported = RunSweep(out, request.json);
        SayWhatNext(request, out);
      });
  return end == sessions::SeriesEnd::kDone ? reported : terminal::kNotReached;
}

}  // namespace rift::commands
