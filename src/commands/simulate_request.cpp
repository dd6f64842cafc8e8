#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figure.hpp"
#include "simulate.hpp"

namespace rift::commands {

namespace fs = std::filesystem;

experiment::Experiment LoadFor(const SimulateRequest& request, std::vector<fs::path>& inputs) {
  Refuse({{request.experiment.empty(), "EXPERIMENT is missing: name a YAML file with waypoints"}});
  std::vector<std::string> overrides = request.overrides;
  if (!request.seed.empty()) overrides.push_back("seed=" + request.seed);
  const auto read = [&inputs](const std::string& path) {
    inputs.emplace_back(path);
    return files::ReadFile(path);
  };
  experiment::Experiment experiment =
      experiment::LoadExperiment(request.experiment, overrides, read);
  const simulation::SurfaceOptions& ground = experiment.simulation.terrain.Chosen();
  if (!ground.image.empty()) inputs.emplace_back(ground.image);
  RequireTask(experiment, request.experiment);
  if (!request.start.empty()) sessions::PutStart(request.start, experiment);
  if (!request.any_waypoints) RequireReachableWaypoints(experiment, request.experiment);
  return experiment;
}

void RequireRunName(const fs::path& out) {
  RefuseSweepFolder(out);
  if (out != "-" && out.extension() != ".csv") {
    RequireFolderName(out.string(), "what has no name ending in .csv");
  }
}

void CheckNames(const SimulateRequest& request, const fs::path& out,
                const experiment::Experiment& experiment, const std::vector<fs::path>& inputs) {
  if (!request.figure.empty()) report::RequireFigureName(request.figure);
  Refuse({{!request.video.empty() && !request.video.ends_with(".mp4"),
           "--video " + request.video + ": the name must end in .mp4"}});
  RequireRunName(out);
  Refuse({{request.IsStdout() && request.json,
           "--out - and --json are both stdout: name a file for the log"}});
  std::vector<fs::path> others = request.copies.Files();
  for (const std::string& name : {request.figure, request.video}) {
    if (!name.empty()) others.emplace_back(name);
  }
  sessions::CheckRunNames(out, experiment, inputs, others, request.force);
}

void AddSimulate(CLI::App& app, int& exit_code, const CameraUses& camera) {
  const auto request = std::make_shared<SimulateRequest>();
  FlagMaker flags(app);
  app.add_option("EXPERIMENT", request->experiment, "YAML file with at least the waypoints");
  AddSetFlag(app, request->overrides, "control.v_min=0.2");
  flags("start", request->start, "X,Y,YAW_DEG",
        "where the robot stands, instead of the first waypoint");
  flags("seed", request->seed, "N", "of all random numbers, instead of the file's");
  flags("out", request->out, "FILE.csv|DIR|-",
        "where the log goes; its commands, true path, experiment and summary go beside it; - for "
        "stdout, the log alone [out/NAME]");
  AddForceFlag(app, request->force);
  AddAnyWaypointsFlag(app, request->any_waypoints);
  AddFlags(app, request->copies);
  app.add_option("--replay", request->replay,
                 "simulate a row of a sweep's table again, bit for bit: the sweep's folder and the "
                 "row's id, or worst")
      ->type_name("DIR ID|worst")
      ->expected(2);
  flags("figure", request->figure, "FILE.svg|FILE.png", "draw path, heights, speed and powers");
  flags("video", request->video, "FILE.mp4", "film the run from above and from the side");
  flags("view", request->window, "play that film in a window");
  flags("twin", request->twin,
        "run the robot in real time, behind a serial port and an http camera that rift drive can "
        "open; prints where they are");
  AddKeysFlag(app);
  flags("json", request->json, "print the summary as JSON instead of text");
  app.footer(
      "Ends with 1 when the robot does not reach the last waypoint.\n"
      "Example: rift simulate configs/waypoints/paper.yaml --seed 7 --out sim.csv\n"
      "         rift simulate --replay out/paper worst --video worst.mp4\n"
      "         rift simulate configs/twin.yaml --twin --out out/twin");
  // What cannot be asked of a robot in real time.
  flags::Exclude(app, "--twin",
                 {"--replay", "--tum", "--mcap", "--json", "--video", "--figure", "--view"});
  app.callback([request, with_camera = camera.simulate, &exit_code] {
    request->experiment = files::FindInput(request->experiment);
    const bool needs_camera = request->twin || request->window || !request->video.empty();
    exit_code = needs_camera ? with_camera(*request) : Simulate(*request, {});
  });
}

}  // namespace rift::commands
