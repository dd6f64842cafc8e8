#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
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
  WarnOfTilt(experiment);
  const fs::path folder = OutputOf(request.out, experiment.name);
  RefuseSweepFolder(folder);
  RequireFolderName(request.out, "a twin's run");
  Outputs outputs{.folder = folder, .force = request.force};
  for (const char* name :
       {"experiment.yaml", "camera.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    outputs.files.push_back(folder / name);
  }
  CheckOutputs(inputs, outputs);
  return sessions::PrepareTwin(experiment, request.experiment, folder, FileInputs());
}

/// One line, at once: whoever started the twin waits for it.
void Announce(const twin::TwinAddress& address, const fs::path& calibration) {
  const nlohmann::ordered_json json{{"port", address.port},
                                    {"camera", address.camera},
                                    {"calibration", fs::absolute(calibration).string()}};
  terminal::PrintData(json.dump() + '\n');
  if (terminal::FlushResults() != 0) {
    throw std::runtime_error("cannot write to stdout: nobody can learn where the twin is");
  }
}

/// Says in one line of JSON on stdout where port, camera and calibration are.
int RunTwin(const SimulateRequest& request) {
  const sessions::PreparedTwin prepared = Prepare(request);
  const terminal::StopSignal stop;
  const twin::TwinRun run = sessions::ServeTwin(
      prepared,
      [&](const twin::TwinAddress& address) { Announce(address, prepared.Calibration()); },
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
    view::ShowFilm(sessions::FilmOf(made), request.pictures.video, request.pictures.window,
                   terminal::Say);
  });
}

}  // namespace rift::commands
