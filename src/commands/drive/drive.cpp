#include "rift/commands/drive/drive.hpp"

#include <fmt/format.h>

#include <utility>

#include "console.hpp"
#include "exit_code.hpp"
#include "request.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/drive/identification.hpp"
#include "rift/sessions/drive/replay.hpp"
#include "rift/sessions/drive/series.hpp"
#include "rift/sessions/drive/session.hpp"
#include "rift/sessions/sweep/suggested.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/view/film.hpp"
#include "rift/view/window.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

int PingRobot(const DriveRequest& request) {
  hardware::HardwareOptions options;
  if (!request.experiment.empty())
    options = ReadExperiment(request.experiment, request.overrides).hardware;
  hardware::SerialPort port(request.setup.address.port, options.line.baud,
                            options.line.write_timeout_s);
  hardware::SteadyClock clock;
  const hardware::PingResult ping = hardware::MeasureLink(port, clock, options);
  request.json ? terminal::PrintData(report::PingJson(ping, options))
               : terminal::PrintText(report::PingText(ping, options));
  const bool is_good = ping.IsMeasured() && hardware::BrokenBudget(ping, options.ping).empty();
  return is_good ? terminal::kDone : terminal::kNotReached;
}

/// The experiment as the request changes it; throws std::invalid_argument, naming the file, when it
/// is no task to drive.
experiment::Experiment LoadTask(const DriveRequest& request) {
  const fs::path suggested = request.series.suggested;
  const fs::path file =
      suggested.empty() ? fs::path(request.experiment) : suggested / "experiment.yaml";
  experiment::Experiment experiment = ReadExperiment(file, request.overrides);
  if (request.series.identify) experiment = sessions::IdentificationDrive(std::move(experiment));
  if (request.countdown_s) experiment.hardware.start.countdown_s = *request.countdown_s;
  if (request.seconds) experiment.trial.timeout_s = *request.seconds;
  RequireTask(experiment, file.string());
  if (!request.any_waypoints) RequireReachableWaypoints(experiment, file.string());
  SayTaskNotes(experiment, file.string());
  return experiment;
}

/// Where its runs go. What a folder holds of a run already, the drive itself refuses.
fs::path FolderOf(const DriveRequest& request, const experiment::Experiment& experiment) {
  if (!request.series.suggested.empty()) {
    return sessions::SuggestedFolder(request.series.suggested);
  }
  fs::path folder =
      request.out.empty() ? OutputOf("", experiment.name + "_drive") : fs::path(request.out);
  RefuseSweepFolder(folder);
  if (!request.series.IsSeries()) return folder;
  Refuse({{fs::exists(folder / "trajectory.csv"),
           folder.string() + " holds a run already, and a series is a folder of its own: choose "
                             "another --out"}});
  return folder;
}

int DriveOnce(const DriveRequest& request, const experiment::Experiment& experiment,
              const fs::path& folder) {
  sessions::DriveSession session(request.setup, TerminalConsole(request.setup.yes));
  const hardware::DriveRun run = session.DriveInto(folder, experiment);
  const bool is_whole = session.LogFailure().empty();
  if (run.has_begun && is_whole) {
    terminal::Say("log: " + (folder / "trajectory.csv").string());
    request.copies.Write(run.trial.trajectory);
  }
  const auto state = is_whole ? report::RunState::kFinished : report::RunState::kInterrupted;
  request.json ? terminal::PrintData(report::DriveJson(experiment, run, state))
               : terminal::PrintText(report::DriveText(experiment, run));
  for (const std::string& line : sessions::SteeringLines(experiment, run)) terminal::Say(line);
  session.RequireLog();
  return ExitCodeOf(run);
}

/// Into `out`; of a grid, `rift sweep` of the drives as well, which are there whatever becomes of
/// it.
int DriveSeries(const DriveRequest& request, const experiment::Experiment& experiment,
                const fs::path& out) {
  const sessions::DriveSeries series{.out = out,
                                     .plan = sessions::PlanSeries(request.series, experiment, out),
                                     .before_each = WordsOf(request.series.before_each),
                                     .setup = request.setup};
  int reported = terminal::kDone;
  const auto sweep = [&] {
    return SweepFile(out / "sweep.yaml", out / "sweep", request.any_waypoints, request.json);
  };
  const sessions::SeriesEnd end =
      sessions::DriveAll(series, TerminalConsole(request.setup.yes), [&] {
        if (request.series.grid) reported = terminal::ReportErrors(sweep);
        if (!series.plan.next.empty()) terminal::Say(series.plan.next);
      });
  return end == sessions::SeriesEnd::kDone ? reported : terminal::kNotReached;
}

/// In a window, or as a video. Returns the exit code.
int ShowDrive(const DriveRequest& request) {
  sessions::RequireDrive(request.replay);
  const bool has_files = !request.video.empty() || !request.copies.Files().empty();
  const bool window = !has_files || request.setup.view;
  if (window) view::RequireDisplay();
  const view::Run shown = sessions::LoadDrive(request.replay, terminal::Say);
  const trajectory::Trajectory& seen = shown.logged;
  terminal::PrintText(fmt::format("{}\n{} poses over {:.2f} s\n", shown.outcome, seen.poses.size(),
                                  seen.Duration_s()));
  terminal::FlushResults();
  request.copies.Write(seen);
  if (!window && request.video.empty()) return terminal::kDone;
  view::ShowFilm(view::MakeFilm(shown), request.video, window, terminal::Say);
  return terminal::kDone;
}

}  // namespace

int Drive(const DriveRequest& request) {
  if (!request.replay.empty()) return ShowDrive(request);
  if (request.ping) return PingRobot(request);
  const experiment::Experiment experiment = LoadTask(request);
  const fs::path out = FolderOf(request, experiment);
  return request.series.IsSeries() ? DriveSeries(request, experiment, out)
                                   : DriveOnce(request, experiment, out);
}

}  // namespace rift::commands
