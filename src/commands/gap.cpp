#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>

#include "odometry.hpp"
#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/gap/doubts.hpp"
#include "rift/gap/result.hpp"
#include "rift/limits/limits.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/falsify/recorded_logs.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

using trajectory::Format;

struct GapRequest {
  std::string sim;
  std::vector<std::string> reals;
  std::vector<std::string> sim_repeats;
  gap::LikenessOptions likeness;
  std::uint64_t seed = 1;
  gap::GapOptions options;
  gap::VerdictOptions verdict;
  double tag_offset_m = 0.0;
  Format sim_format = Format::kAuto;
  Format real_format = Format::kAuto;
  /// Of both sides, and of one; see trajectory::ReadOptions.
  std::string columns, sim_columns, real_columns, units, sim_units, real_units;
  std::string json, profile, figure;
  bool exit_code = false;
  bool force = false;
  bool odometry = false;
  OdometryRequest runs;  ///< with --odometry or --program

  trajectory::ReadOptions SimLogs() const {
    return LogsOf(sim_format, sim_columns, sim_units, "--sim-columns ");
  }
  trajectory::ReadOptions RealLogs() const {
    return LogsOf(real_format, real_columns, real_units, "--real-columns ");
  }
  bool IsOdometry() const { return odometry || runs.calibrate || !runs.program.empty(); }

 private:
  /// What holds for both sides is not meant for the one that has a format.
  trajectory::ReadOptions LogsOf(Format format, const std::string& own_columns,
                                 const std::string& own_units, const char* flag) const {
    const bool is_dialect = format != Format::kAuto;
    const auto either = [&](const std::string& own, const std::string& both) {
      return own.empty() && !is_dialect ? both : own;
    };
    const bool is_of_both = own_columns.empty() && own_units.empty() && !is_dialect &&
                            !(columns.empty() && units.empty());
    return {format, either(own_columns, columns), either(own_units, units),
            is_of_both ? "--columns " : flag, options.IsInSpace()};
  }
};

/// What was mended, and why there may be no yaw errors.
void SayNotes(const trajectory::Log& log, const std::string& path, const std::string& flag) {
  for (const std::string& note : log.notes) terminal::Say(fmt::format("note: {}: {}", path, note));
  for (const std::string& doubt : log.doubts) {
    terminal::Say(fmt::format("warning: {}: {}", path, doubt));
  }
  if (log.line_without_yaw) {
    terminal::Say(fmt::format("note: {}:{}: has no yaw: yaw errors are told where it is logged",
                              path, *log.line_without_yaw));
  }
  if (log.unknown_angles.empty()) return;
  terminal::Say(
      fmt::format("note: {}: yaw errors are left out: {}: set {}", path, log.unknown_angles, flag));
}

bool IsNamed(const std::string& path, std::initializer_list<std::string_view> words) {
  const std::string name = std::filesystem::path(path).filename().string();
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return name.find(word) != name.npos; });
}
bool IsNamedSimulated(const std::string& path) {
  return IsNamed(path, {"sim", "webots", "gazebo", "mujoco"});
}
bool IsNamedReal(const std::string& path) {
  return IsNamed(path, {"real", "robot", "tracker", "mocap"});
}

/// The true path of a simulated run is held against its log on purpose.
void SayIfSwapped(const GapRequest& request, const gap::GapResult& result) {
  const std::string& real = request.reals.front();
  const bool by_name = IsNamedReal(request.sim) && !IsNamedSimulated(request.sim) &&
                       IsNamedSimulated(real) && !IsNamedReal(real);
  const bool by_format =
      request.sim_format == Format::kTracker || request.real_format == Format::kWebots;
  const bool by_noise =
      !IsNamed(real, {"truth"}) && gap::LookSwapped(result.sim, result.reals.front());
  if (!by_name && !by_format && !by_noise) return;
  terminal::Say(fmt::format(
      "warning: {} and {}: by their {} the two are swapped: the simulator's log comes first",
      request.sim, real,
      by_name     ? "names"
      : by_format ? "formats"
                  : "noise"));
}

void SayDoubts(const gap::GapResult& result) {
  for (size_t i = 0; i < result.reals.size(); ++i) {
    for (const std::string& doubt : gap::Doubts(result.sim, result.reals[i], result.options)) {
      const double threshold_m = result.options.threshold_m;
      const bool is_above = result.trials[i].comparison.gap_m > threshold_m;
      terminal::Say(fmt::format(
          "warning: SIM {} and REAL {}{}: {}", result.sim_path, result.trials[i].path,
          is_above ? fmt::format(", whose gap is above {:g} m", threshold_m) : "", doubt));
    }
  }
}

gap::GapResult Measure(const GapRequest& request) {
  limits::Require(limits::Amount::kSamples, request.options.samples, "--samples");
  gap::GapResult result{.options = request.options,
                        .tag_offset_m = request.tag_offset_m,
                        .sim_path = request.sim,
                        .judged_by = request.verdict};
  trajectory::Log sim =
      trajectory::ReadLog(files::ReadFile(request.sim), request.sim, request.SimLogs());
  SayNotes(sim, request.sim, "--sim-format");
  result.sim = std::move(sim.trajectory);
  const sweep::LogOptions real_logs{request.RealLogs(), request.tag_offset_m, "--real-format"};
  for (const std::string& path : request.reals) {
    trajectory::Log real = sweep::ReadMovedLog(files::ReadFile(path), path, real_logs);
    SayNotes(real, path, "--real-format");
    result.trials.push_back({path, gap::Compare(result.sim, real.trajectory, request.options)});
    result.reals.push_back(std::move(real.trajectory));
  }
  Judge(result);
  SayIfSwapped(request, result);
  SayDoubts(result);
  return result;
}

/// Every simulated run is held against every real one: nothing says that they belong together.
gap::Likeness MeasureRepeats(const GapRequest& request, const gap::GapResult& result) {
  gap::RepeatedSetting setting{.reals = result.reals, .sims = {{result.sim}}};
  for (const std::string& path : request.sim_repeats) {
    trajectory::Log sim = trajectory::ReadLog(files::ReadFile(path), path, request.SimLogs());
    SayNotes(sim, path, "--sim-format");
    setting.sims.front().push_back(std::move(sim.trajectory));
  }
  std::mt19937_64 generator(request.seed);
  return gap::MeasureLikeness({&setting, 1}, request.options, request.likeness, generator);
}

void Save(const GapRequest& request, const gap::GapResult& result) {
  const bool is_piped = request.profile == "-";
  if (is_piped) terminal::PrintData(report::ProfileCsv(result));
  if (!request.profile.empty() && !is_piped) {
    files::WriteFile(request.profile, report::ProfileCsv(result));
  }
  if (!request.figure.empty()) WriteFigure(request.figure, report::GapFigure(result));
  if (request.json == "-") {
    terminal::PrintData(report::GapJson(result));
    return;
  }
  if (!request.json.empty()) files::WriteFile(request.json, report::GapJson(result));
  if (!is_piped) terminal::PrintText(report::GapText(result));
}

/// A log that counts twice would pass for a repeat.
void RefuseTwins(const std::vector<std::string>& logs) {
  for (auto log = logs.begin(); log != logs.end(); ++log) {
    const auto twin = std::find_if(
        logs.begin(), log, [&](const auto& other) { return files::IsSameFile(*log, other); });
    if (twin == log) continue;
    throw std::invalid_argument(fmt::format(
        "{} and {} are one log, and each repeat is a run of its own: name it once", *twin, *log));
  }
}

/// What is measured in the plane alone.
void CheckDimension(const GapRequest& request) {
  request.options.Check();
  if (!request.options.IsInSpace()) return;
  if (request.tag_offset_m != 0.0) {
    throw std::invalid_argument(fmt::format(
        "--tag-offset is {:g}, which moves a path along its yaw in the plane, and --dimension is "
        "xyz: log the point that is to be compared, and leave --tag-offset out",
        request.tag_offset_m));
  }
  if (!request.sim_repeats.empty()) {
    throw std::invalid_argument(
        "--sim-repeats measures likeness, which is of paths in the plane, and --dimension is xyz: "
        "leave one of them out");
  }
}

void CheckInputs(const GapRequest& request) {
  CheckDimension(request);
  RefuseTwins(request.reals);
  trajectory::CheckColumns(request.SimLogs());
  trajectory::CheckColumns(request.RealLogs());
  std::vector<std::string> sims = request.sim_repeats;
  sims.insert(sims.begin(), request.sim);
  RefuseTwins(sims);
}

void CheckNames(const GapRequest& request) {
  if (!request.figure.empty()) RequireFigureName(request.figure);
  std::vector<std::filesystem::path> inputs{request.sim}, outputs;
  for (const auto* logs : {&request.reals, &request.sim_repeats}) {
    inputs.insert(inputs.end(), logs->begin(), logs->end());
  }
  if (request.json == "-" && request.profile == "-") {
    throw std::invalid_argument("--json - and --profile - are both stdout: name a file for one");
  }
  for (const std::string& output : {request.json, request.profile}) {
    if (!output.empty() && output != "-") outputs.emplace_back(output);
  }
  if (!request.figure.empty()) outputs.emplace_back(request.figure);
  CheckOutputs(inputs, {.files = outputs, .force = request.force});
}

void AddColumnFlags(CLI::App& app, GapRequest& request) {
  const auto add = [&](const char* flag, std::string& text, const char* help, const char* type) {
    app.add_option(flag, text, help)->type_name(type);
  };
  constexpr auto kColumns = "t=NAME,x=NAME,y=NAME,yaw=NAME:deg";
  constexpr auto kUnits = "mm,ms,deg";
  add("--columns", request.columns,
      "which columns of the logs hold what (docs/logs.md), for each side without a format",
      kColumns);
  add("--units", request.units, "the units of such logs, where they are not m, s and rad", kUnits);
  add("--sim-columns", request.sim_columns, "the same for SIM alone", kColumns);
  add("--sim-units", request.sim_units, "the same for SIM alone", kUnits);
  add("--real-columns", request.real_columns, "the same for REAL alone", kColumns);
  add("--real-units", request.real_units, "the same for REAL alone", kUnits);
}

void AddOdometryFlags(CLI::App& app, GapRequest& request) {
  app.add_flag("--odometry", request.odometry,
               "SIM and REAL are run folders: hold camera, encoders and program of each together");
  app.add_option("--program", request.runs.program,
                 "the same for runs of this experiment's program, with or without encoders")
      ->type_name("EXPERIMENT");
  app.add_flag(
      "--calibrate-odometry", request.runs.calibrate,
      "the same, and find wheel radii and track from all runs (squares both ways tell them "
      "best)");
  FlagMaker flags(app);
  odometry::RunOptions::Fields(request.runs.options, flags);
  flags("window_s", request.runs.calibration.window_s, 0.2, 1e4,
        "of --calibrate-odometry: runs are cut into pieces of this length, and each counts as one "
        "observation");
}

void RefuseOdometryFlags(const CLI::App& app) {
  for (const char* flag : {"--slip-bins", "--moved-share", "--tag-ahead", "--window"}) {
    if (app.count(flag) == 0) continue;
    throw std::invalid_argument(fmt::format(
        "{} is for runs held together with their encoders: give --odometry, --program or "
        "--calibrate-odometry as well, or leave it out",
        flag));
  }
}

OdometryRequest OdometryOf(const GapRequest& request) {
  OdometryRequest runs = request.runs;
  runs.runs = request.reals;
  runs.runs.insert(runs.runs.begin(), request.sim);
  runs.json = request.json;
  runs.force = request.force;
  runs.calibration.confidence = request.verdict.confidence;
  RefuseTwins(runs.runs);
  for (const std::string& other : {request.profile, request.figure}) {
    if (other.empty()) continue;
    throw std::invalid_argument(fmt::format(
        "{}: --profile and --figure are of two logs, leave them out with --odometry", other));
  }
  return runs;
}

}  // namespace

void AddGap(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<GapRequest>();
  app.add_option("SIM", request->sim, "log of the simulator (CSV)")->required();
  app.add_option("REAL", request->reals, "logs of the robot, one a repeat");
  AddFlags(app, request->options);
  AddFlags(app, request->verdict);
  FlagMaker flags(app);
  flags(
      "tag_offset_m", request->tag_offset_m, -1.0, 1.0,
      "moves the real path forward along its yaw, from the tag to the robot's front (paper: 0.03)");
  flags("sim_format", request->sim_format, "dialect of SIM");
  flags("real_format", request->real_format, "dialect of REAL");
  AddColumnFlags(app, *request);
  app.add_option("--sim-repeats", request->sim_repeats,
                 "further runs of the simulator: adds how like the robot they are")
      ->type_name("SIM...");
  app.add_option("--json", request->json,
                 "write everything as JSON; - for stdout, without the text")
      ->type_name("FILE|-");
  app.add_option("--profile", request->profile,
                 "write the error along the path; - for stdout, without the text")
      ->type_name("FILE.csv|-");
  app.add_option("--figure", request->figure, "draw paths, error over u and its distribution")
      ->type_name("FILE.svg|FILE.png");
  app.add_flag("--exit-code", request->exit_code,
               "end with 1 when the verdict is falsified, or undecided with a failure");
  AddForceFlag(app, request->force);
  AddOdometryFlags(app, *request);
  app.footer(
      "Example: rift gap out/square1 out/square2 --odometry --calibrate-odometry\n"
      "         rift gap sim.csv real1.csv real2.csv --real-format tracker --tag-offset 0.03\n"
      "         rift gap sim.csv real.csv --real-columns t=time,x=pose_x,y=pose_y,yaw=theta:deg "
      "--real-units mm,ms");
  app.callback([request, &app, &exit_code] {
    if (request->IsOdometry()) {
      exit_code = MeasureOdometry(OdometryOf(*request));
      return;
    }
    RefuseOdometryFlags(app);
    if (request->reals.empty()) {
      throw std::invalid_argument(
          "REAL is required: name logs of the robot (or --odometry for the encoders of run "
          "folders)");
    }
    request->sim = FindInput(request->sim);
    for (std::string& real : request->reals) real = FindInput(real);
    CheckInputs(*request);
    CheckNames(*request);
    gap::GapResult result = Measure(*request);
    if (!request->sim_repeats.empty()) result.likeness = MeasureRepeats(*request, result);
    Save(*request, result);
    const bool may_fail =
        result.verdict.verdict == gap::Verdict::kFalsified ||
        (result.verdict.verdict == gap::Verdict::kUndecided && result.verdict.above > 0);
    exit_code = request->exit_code && may_fail ? terminal::kFalsified : terminal::kDone;
  });
}

}  // namespace rift::commands
