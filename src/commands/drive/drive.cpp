#include "rift/commands/drive/drive.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "folder.hpp"
#include "identification.hpp"
#include "replay.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/hardware/ping.hpp"
#include "rift/hardware/serial_port.hpp"
#include "rift/report/json/json.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "series.hpp"
#include "session.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

int PingRobot(const DriveRequest& request) {
  hardware::HardwareOptions options;
  if (!request.experiment.empty())
    options = ReadExperiment(request.experiment, request.overrides).hardware;
  hardware::SerialPort port(request.port, options.line.baud, options.line.write_timeout_s);
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
  const fs::path file = request.suggested.empty() ? fs::path(request.experiment)
                                                  : fs::path(request.suggested) / "experiment.yaml";
  experiment::Experiment experiment = ReadExperiment(file, request.overrides);
  if (request.identify) experiment = IdentificationDrive(std::move(experiment));
  if (request.countdown_s) experiment.hardware.start.countdown_s = *request.countdown_s;
  if (request.seconds) experiment.trial.timeout_s = *request.seconds;
  RequireTask(experiment, file.string());
  if (!request.any_waypoints) RequireReachableWaypoints(experiment, file.string());
  return experiment;
}

/// A dry run has nowhere to arrive: it is well when only time or a person ended it.
int ExitCodeOf(const hardware::DriveRun& run) {
  if (run.trial.outcome == trial::Outcome::kReached) return terminal::kDone;
  const bool is_whole = run.dry_run && run.has_begun && run.evidence.stop &&
                        (run.trial.outcome == trial::Outcome::kTimedOut ||
                         run.evidence.stop->reason == hardware::StopReason::kOperator ||
                         run.evidence.stop->reason == hardware::StopReason::kSignal);
  return is_whole ? terminal::kDone : terminal::kNotReached;
}

int DriveOnce(const DriveRequest& request, const experiment::Experiment& experiment) {
  const fs::path folder = NewFolder(request, experiment);
  DriveSession session(request);
  const hardware::DriveRun run = session.DriveInto(folder, experiment);
  const bool is_whole = session.LogFailure().empty();
  if (run.has_begun && is_whole) {
    terminal::Say("log: " + (folder / "trajectory.csv").string());
    WriteLogCopies(request.copies, run.trial.trajectory);
  }
  const auto state = is_whole ? report::RunState::kFinished : report::RunState::kInterrupted;
  request.json ? terminal::PrintData(report::DriveJson(experiment, run, state))
               : terminal::PrintText(report::DriveText(run));
  SaySteering(experiment, run);
  session.RequireLog();
  return ExitCodeOf(run);
}

}  // namespace

int Drive(const DriveRequest& request) {
  if (!request.replay.empty()) return ReplayDrive(request);
  if (request.ping) return PingRobot(request);
  const experiment::Experiment experiment = LoadTask(request);
  return request.IsSeries() ? DriveSeries(request, experiment) : DriveOnce(request, experiment);
}

}  // namespace rift::commands
