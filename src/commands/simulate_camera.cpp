#include <fmt/format.h>

#include <stdexcept>

#include "rift/commands/command.hpp"
#include "rift/sessions/simulate/pictures.hpp"
#include "rift/sessions/simulate/twin.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "rift/view/window.hpp"
#include "simulate.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// Writes the twin's camera and experiment. Throws std::invalid_argument when there is no
/// experiment, or when the folder's files would replace an input.
sessions::PreparedTwin Prepare(const SimulateRequest& request) {
  std::vector<fs::path> inputs;
  const experiment::Experiment experiment = LoadFor(request, inputs);
  SayTaskNotes(experiment, request.experiment);
  WarnOfTilt(experiment);
  const fs::path folder = OutputOf(request.out, experiment.name);
  RefuseSweepFolder(folder);
  RequireFolderName(request.out, "a twin's run");
  sessions::CheckTwinNames(folder, inputs, request.force);
  return sessions::PrepareTwin(experiment, request.experiment, folder, FileInputs());
}

/// Says in one line of JSON on stdout where port, camera and calibration are.
int RunTwin(const SimulateRequest& request) {
  const sessions::PreparedTwin prepared = Prepare(request);
  const terminal::StopSignal stop;
  const twin::TwinRun run = sessions::ServeTwin(
      prepared,
      // At once: whoever started the twin waits for it.
      [&](const twin::TwinAddress& address) {
        terminal::PrintData(sessions::AddressJson(prepared, address));
        if (terminal::FlushResults() == 0) return;
        throw std::runtime_error("cannot write to stdout: nobody can learn where the twin is");
      },
      [&] { return stop.IsAsked(); });
  terminal::Say(fmt::format("{}; {} pictures at {:.1f} ms of one core each; true path: {}",
                            sessions::EndingOf(run), run.pictures, 1e3 * run.picture_cpu_s,
                            (prepared.folder / "truth.csv").string()));
  return terminal::kDone;
}

}  // namespace

int SimulateWithCamera(const SimulateRequest& request) {
  if (request.twin) return RunTwin(request);
  return Simulate(request, [&request](const sessions::Simulated& made) {
    view::ShowFilm(sessions::FilmOf(made), request.video, request.window, terminal::Say);
  });
}

}  // namespace rift::commands
