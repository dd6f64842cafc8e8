#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figure.hpp"
#include "rift/yaml/bind.hpp"
#include "simulate.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// `-0.28,-0.06,10`: metres, metres, degrees; the schema of the waypoints says what is allowed.
void PutStart(const std::string& text, experiment::Experiment& experiment) {
  const std::vector<std::string> words = CLI::detail::split(text, ',');
  if (words.size() != 3) {
    throw std::invalid_argument(
        fmt::format("--start '{}': give X,Y,YAW_DEG, such as -0.28,-0.06,10", text));
  }
  std::vector<yaml::KeyValue> values;
  for (size_t i = 0; i < words.size(); ++i) {
    yaml::Node value = yaml::Node::Scalar(words[i]);
    value.origin.source = "--start";
    constexpr std::array<const char*, 3> kKeys{"x", "y", "heading"};
    values.push_back({fmt::format("waypoints[0].{}", kKeys[i]), value});
  }
  yaml::SetValues(experiment, values);
}

/// Adds --figure, --video and --view.
void AddPictureFlags(CLI::App& app, PictureRequest& request) {
  app.add_option("--figure", request.figure, "draw path, heights, speed and powers")
      ->type_name("FILE.svg|FILE.png");
  app.add_option("--video", request.video, "film the run from above and from the side")
      ->type_name("FILE.mp4");
  app.add_flag("--view", request.window, "play that film in a window");
}

/// What cannot be asked of a robot in real time is refused beside --twin.
void ExcludeFromTwin(CLI::App& app) {
  CLI::Option* twin = app.get_option("--twin");
  for (const char* other :
       {"--replay", "--tum", "--mcap", "--json", "--video", "--figure", "--view"}) {
    twin->excludes(app.get_option(other));
  }
}

}  // namespace

experiment::Experiment LoadFor(const SimulateRequest& request, std::vector<fs::path>& inputs) {
  if (request.experiment.empty()) {
    throw std::invalid_argument("EXPERIMENT is missing: name a YAML file with waypoints");
  }
  std::vector<std::string> overrides = request.overrides;
  if (!request.seed.empty()) overrides.push_back("seed=" + request.seed);
  const auto read = [&inputs](const std::string& path) {
    inputs.emplace_back(path);
    return files::ReadFile(path);
  };
  experiment::Experiment experiment =
      experiment::LoadExperiment(request.experiment, overrides, read);
  RequireTask(experiment, request.experiment);
  if (!request.start.empty()) PutStart(request.start, experiment);
  if (!request.any_waypoints) RequireReachableWaypoints(experiment, request.experiment);
  return experiment;
}

void CheckNames(const SimulateRequest& request, const fs::path& out,
                const experiment::Experiment& experiment, const std::vector<fs::path>& inputs) {
  const PictureRequest& pictures = request.pictures;
  if (!pictures.figure.empty()) report::RequireFigureName(pictures.figure);
  if (!pictures.video.empty() && !pictures.video.ends_with(".mp4")) {
    throw std::invalid_argument(
        fmt::format("--video {}: the name must end in .mp4", pictures.video));
  }
  RefuseSweepFolder(out);
  if (request.IsStdout() && request.json) {
    throw std::invalid_argument("--out - and --json are both stdout: name a file for the log");
  }
  if (!request.IsStdout() && out.extension() != ".csv") {
    RequireFolderName(out.string(), "what has no name ending in .csv");
  }
  std::vector<fs::path> others = request.copies.Files();
  for (const std::string& name : {pictures.figure, pictures.video}) {
    if (!name.empty()) others.emplace_back(name);
  }
  sessions::CheckRunNames(out, experiment, inputs, others, request.force);
}

void AddSimulate(CLI::App& app, int& exit_code, const CameraUses& camera) {
  const auto request = std::make_shared<SimulateRequest>();
  app.add_option("EXPERIMENT", request->experiment, "YAML file with at least the waypoints");
  AddSetFlag(app, request->overrides, "control.v_min=0.2");
  app.add_option("--start", request->start, "where the robot stands, instead of the first waypoint")
      ->type_name("X,Y,YAW_DEG");
  app.add_option("--seed", request->seed, "of all random numbers, instead of the file's")
      ->type_name("N");
  app.add_option(
         "--out", request->out,
         "where the log goes; its commands, true path, experiment and summary go beside it; "
         "- for stdout, the log alone [out/NAME]")
      ->type_name("FILE.csv|DIR|-");
  AddForceFlag(app, request->force);
  AddAnyWaypointsFlag(app, request->any_waypoints);
  AddLogCopyFlags(app, request->copies);
  app.add_option("--replay", request->replay,
                 "simulate a row of a sweep's table again, bit for bit: the sweep's folder and the "
                 "row's id, or worst")
      ->type_name("DIR ID|worst")
      ->expected(2);
  AddPictureFlags(app, request->pictures);
  app.add_flag(
      "--twin", request->twin,
      "run the robot in real time, behind a serial port and an http camera that rift drive "
      "can open; prints where they are");
  AddKeysFlag(app);
  app.add_flag("--json", request->json, "print the summary as JSON instead of text");
  app.footer(
      "Ends with 1 when the robot does not reach the last waypoint.\n"
      "Example: rift simulate configs/waypoints/paper.yaml --seed 7 --out sim.csv\n"
      "         rift simulate --replay out/paper worst --video worst.mp4\n"
      "         rift simulate configs/twin.yaml --twin --out out/twin");
  ExcludeFromTwin(app);
  app.callback([request, with_camera = camera.simulate, &exit_code] {
    request->experiment = FindInput(request->experiment);
    const PictureRequest& pictures = request->pictures;
    const bool needs_camera = request->twin || pictures.window || !pictures.video.empty();
    exit_code = needs_camera ? with_camera(*request) : Simulate(*request, {});
  });
}

}  // namespace rift::commands
