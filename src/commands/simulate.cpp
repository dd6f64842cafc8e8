#include "simulate.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sessions/sweep/replay.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/trajectory/log.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::commands {

namespace {

constexpr double kGroundStep_m = 0.002;  // the edge of a bump shows

/// The ground under the robot's path, from end to end.
std::vector<Eigen::Vector2d> GroundProfile(const simulation::Terrain& terrain,
                                           const trajectory::Trajectory& truth) {
  const auto by_x = [](const auto& a, const auto& b) { return a.x_m < b.x_m; };
  const auto [left, right] = std::minmax_element(truth.poses.begin(), truth.poses.end(), by_x);
  std::vector<Eigen::Vector2d> profile;
  for (double x_m = left->x_m - 0.1; x_m <= right->x_m + 0.1; x_m += kGroundStep_m) {
    const double z_m = terrain.HeightAt(x_m, left->y_m);
    if (std::isfinite(z_m)) profile.emplace_back(x_m, z_m);
  }
  return profile;
}

}  // namespace

void AddPictureFlags(CLI::App& app, PictureRequest& request) {
  app.add_option("--figure", request.figure, "draw path, heights, speed and powers")
      ->type_name("FILE.svg|FILE.png");
  app.add_option("--video", request.video, "film the run from above and from the side")
      ->type_name("FILE.mp4");
  app.add_flag("--view", request.window, "play that film in a window");
}

void CheckPictureNames(const PictureRequest& request) {
  if (!request.figure.empty()) RequireFigureName(request.figure);
  if (request.video.empty() || request.video.ends_with(".mp4")) return;
  throw std::invalid_argument(fmt::format("--video {}: the name must end in .mp4", request.video));
}

std::vector<geometry::FloorArea> AreasOf(const simulation::TerrainOptions& terrain) {
  std::vector<geometry::FloorArea> areas;
  for (const simulation::PatchOptions& patch : terrain.patches) {
    areas.push_back({fmt::format("mu {:g}", patch.mu), patch.x_min_m, patch.x_max_m, patch.y_min_m,
                     patch.y_max_m});
  }
  return areas;
}

void DrawFigure(const std::string& path, const experiment::Experiment& experiment,
                const sweep::SimulatedTrial& trial, const sweep::SimulatedRun& run) {
  const simulation::Terrain terrain(trial.simulation.terrain, trial.image);
  report::SimulatedTrial drawn{.name = experiment.name,
                               .truth = run.truth,
                               .logged = run.result.trajectory,
                               .areas = AreasOf(trial.simulation.terrain),
                               .ground_xz_m = GroundProfile(terrain, run.truth)};
  for (const control::Waypoint& waypoint : trial.task.waypoints) {
    drawn.waypoints.push_back({waypoint.name, waypoint.Position()});
  }
  WriteFigure(path, report::SimulationFigure(drawn));
}

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

/// The start and the seed become part of the experiment, so that what is saved is what was run.
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

/// DIR/trajectory.csv, DIR/summary.json ...; or, where a CSV file was named, FILE.csv with
/// FILE.summary.json ... beside it.
struct RunFiles {
  explicit RunFiles(const fs::path& out) {
    const bool is_file = out.extension() == ".csv";
    const std::string stem = is_file ? fs::path(out).replace_extension().string() + "." : "";
    trajectory = is_file ? out : out / "trajectory.csv";
    for (const auto& [path, name] : {std::pair{&truth, "truth.csv"},
                                     {&commands, "commands.csv"},
                                     {&encoders, "encoders.csv"},
                                     {&experiment, "experiment.yaml"},
                                     {&summary, "summary.json"}}) {
      *path = is_file ? fs::path(stem + name) : out / name;
    }
  }

  fs::path trajectory, truth, commands, encoders, experiment, summary;
};

/// The run of the same experiment again comes out the same, and replacing it does no harm.
bool IsSaved(const experiment::Experiment& experiment, const fs::path& path) {
  return fs::is_regular_file(path) &&
         files::ReadFile(path) == experiment::WriteExperiment(experiment);
}

/// The log alone, for a pipe.
bool IsStdout(const SimulateRequest& request) { return request.out == "-"; }

void CheckNames(const SimulateRequest& request, const fs::path& out,
                const experiment::Experiment& experiment, const std::vector<fs::path>& inputs) {
  CheckPictureNames(request.pictures);
  RefuseSweepFolder(out);
  if (IsStdout(request) && request.json) {
    throw std::invalid_argument("--out - and --json are both stdout: name a file for the log");
  }
  if (!IsStdout(request) && out.extension() != ".csv") {
    RequireFolderName(out.string(), "what has no name ending in .csv");
  }
  Outputs named{.folder = out.extension() == ".csv" ? fs::path() : out, .force = request.force};
  named.files = request.copies.Files();
  for (const std::string& name : {request.pictures.figure, request.pictures.video}) {
    if (!name.empty()) named.files.emplace_back(name);
  }
  const RunFiles files(out);
  const bool is_repeat = IsSaved(experiment, files.experiment);
  Outputs run{
      .files = {files.trajectory, files.truth, files.commands, files.encoders, files.summary},
      .folder = named.folder,
      .force = request.force || is_repeat};
  if (!is_repeat) run.files.push_back(files.experiment);
  std::vector<fs::path> all = inputs;
  if (!IsStdout(request)) {
    CheckOutputs(inputs, run);
    all.insert(all.end(), run.files.begin(), run.files.end());
  }
  CheckOutputs(all, named);
}

/// Its check, with those proposals alone with which the same trial arrives.
trial::SteeringCheck CheckOf(const Simulated& made) {
  trial::SteeringCheck check = report::SteeringOf(made.experiment, made.run);
  trial::TryProposals(check, [&made](const std::vector<trial::KeyProposal>& proposals) {
    experiment::Experiment experiment = made.experiment;
    std::vector<yaml::KeyValue> values;
    for (const trial::KeyProposal& proposal : proposals) {
      yaml::Node value = yaml::Node::Scalar(fmt::format("{:g}", proposal.value));
      value.origin.source = "proposal";
      values.push_back({proposal.key, value});
    }
    yaml::SetValues(experiment, values);
    sweep::SimulatedTrial trial = made.trial;
    trial.control = experiment.control;
    trial.trial = experiment.trial;
    sweep::SimulatedRun run = sweep::Simulate(trial);
    trial::SteeringCheck of_run = report::SteeringOf(experiment, run);
    return trial::TriedRun{std::move(run.result), std::move(of_run)};
  });
  return check;
}

void Save(const fs::path& out, const Simulated& made, const trial::SteeringCheck& check) {
  const experiment::Experiment& experiment = made.experiment;
  const sweep::SimulatedRun& run = made.run;
  const RunFiles files(out);
  files::WriteFile(files.experiment, experiment::WriteExperiment(experiment));
  files::WriteFile(files.truth, trajectory::WriteRift(run.truth));
  files::WriteFile(files.commands, report::CommandsCsv(run.result));
  if (!run.encoders.empty()) {
    files::WriteFile(files.encoders, odometry::EncodersCsv(run.encoders));
  }
  files::WriteFile(files.summary, report::SimulationJson(experiment, run, check));
  files::WriteFile(files.trajectory, trajectory::WriteRift(run.result.trajectory));
}

Simulated SimulateFile(const SimulateRequest& request) {
  std::vector<fs::path> inputs;
  Simulated made{.experiment = LoadFor(request, inputs)};
  const experiment::Experiment& experiment = made.experiment;
  made.out = OutputOf(request.out, experiment.name);
  CheckNames(request, made.out, experiment, inputs);
  made.trial =
      sweep::SimulatedTrialOf(experiment, {}, experiment.seed, request.experiment, FileInputs());
  made.trial.start = made.trial.task.Start();
  WarnOfTilt(experiment);
  made.run = sweep::Simulate(made.trial);
  return made;
}

void RequireNothingBesideReplay(const SimulateRequest& request) {
  if (request.replay.empty()) return;
  const bool is_changed = !request.experiment.empty() || !request.overrides.empty() ||
                          !request.start.empty() || !request.seed.empty();
  if (is_changed) {
    throw std::invalid_argument(
        "--replay takes everything from the sweep: leave EXPERIMENT, --set, --start, --seed out");
  }
}

std::vector<fs::path> SweepFiles(const fs::path& folder) {
  return {folder / "table.csv", folder / "experiment.yaml", folder / "journal.sqlite",
          folder / "inputs.txt", folder / "summary.json"};
}

/// The row's id, or that of the worst row.
std::string ReplayedId(const SimulateRequest& request) {
  if (request.replay[1] != "worst") return request.replay[1];
  const std::string table = (fs::path(request.replay[0]) / "table.csv").string();
  return report::WorstIdOf(files::ReadFile(table), table);
}

/// A row of a sweep over somebody else's simulator: its trajectory is all there is of it.
std::optional<int> ReplayProgram(const SimulateRequest& request) {
  if (request.replay.empty()) return std::nullopt;
  const fs::path folder = request.replay[0];
  const std::string id = ReplayedId(request);
  const std::optional<sessions::ProgramReplay> replay =
      sessions::ReplayProgramRow(folder, id, FileInputs());
  if (!replay) return std::nullopt;
  const bool has_more = request.json || !request.pictures.figure.empty() ||
                        !request.pictures.video.empty() || request.pictures.window;
  if (has_more) {
    throw std::invalid_argument(
        "--json, --figure, --video and --view are of rift's own simulator, and candidate.kind is "
        "program");
  }
  const fs::path out = (request.out.empty() ? folder / "replay" / id : fs::path(request.out));
  const fs::path log = out.extension() == ".csv" ? out : out / "trajectory.csv";
  // The same row gives the same bytes, in the place that is its own.
  CheckOutputs(
      SweepFiles(folder),
      {.files = {log}, .folder = log.parent_path(), .force = request.force || request.out.empty()});
  CheckOutputs({log}, {.files = request.copies.Files(), .force = request.force});
  if (!replay->trajectory.poses.empty()) {
    files::WriteFile(log, trajectory::WriteRift(replay->trajectory));
    WriteLogCopies(request.copies, replay->trajectory);
    terminal::Say("log: " + log.string());
  }
  terminal::PrintText(replay->verdict + "\n");
  return replay->has_arrived ? terminal::kDone : terminal::kNotReached;
}

Simulated ReplayFor(const SimulateRequest& request) {
  const fs::path folder = request.replay[0];
  const std::string id = ReplayedId(request);
  sessions::Replay replay = sessions::ReplayRow(folder, id, FileInputs());
  terminal::Say(replay.verdict);
  const fs::path out = request.out.empty() ? folder / "replay" / id : fs::path(request.out);
  CheckNames(request, out, replay.experiment, SweepFiles(folder));
  return {out, std::move(replay.experiment), std::move(replay.trial), std::move(replay.run)};
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

int Simulate(const SimulateRequest& request, const std::function<void(const Simulated&)>& show) {
  RequireNothingBesideReplay(request);
  if (const std::optional<int> exit_code = ReplayProgram(request)) return *exit_code;
  const Simulated made = request.replay.empty() ? SimulateFile(request) : ReplayFor(request);
  const trial::SteeringCheck check = CheckOf(made);
  if (!IsStdout(request)) Save(made.out, made, check);
  WriteLogCopies(request.copies, made.run.result.trajectory);
  if (!request.pictures.figure.empty()) {
    DrawFigure(request.pictures.figure, made.experiment, made.trial, made.run);
  }
  if (show) show(made);
  if (IsStdout(request)) {
    terminal::PrintData(trajectory::WriteRift(made.run.result.trajectory));
  } else {
    terminal::Say("log: " + RunFiles(made.out).trajectory.string());
    request.json ? terminal::PrintData(report::SimulationJson(made.experiment, made.run, check))
                 : terminal::PrintText(report::SimulationText(made.experiment, made.run));
  }
  for (const std::string& line : report::SteeringLines(check, made.run.result.limits)) {
    terminal::Say(line);
  }
  return made.run.result.outcome == trial::Outcome::kReached ? terminal::kDone
                                                             : terminal::kNotReached;
}

TwinJob LoadTwinJob(const SimulateRequest& request) {
  std::vector<fs::path> inputs;
  TwinJob job{.experiment = LoadFor(request, inputs)};
  WarnOfTilt(job.experiment);
  job.folder = OutputOf(request.out, job.experiment.name);
  RefuseSweepFolder(job.folder);
  RequireFolderName(request.out, "a twin's run");
  Outputs outputs{.folder = job.folder, .force = request.force};
  for (const char* name :
       {"experiment.yaml", "camera.yaml", "truth.csv", "trajectory.csv", "summary.json"}) {
    outputs.files.push_back(job.folder / name);
  }
  CheckOutputs(inputs, outputs);
  return job;
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
