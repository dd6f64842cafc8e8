#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

#include "gap.hpp"
#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/command.hpp"
#include "rift/report/figures/figure.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;
using trajectory::Format;

/// What holds for both sides is not meant for the one that has a format.
trajectory::ReadOptions LogsOf(const GapRequest& request, Format format,
                               const std::string& own_columns, const std::string& own_units,
                               const char* flag) {
  const bool is_dialect = format != Format::kAuto;
  const auto either = [&](const std::string& own, const std::string& both) {
    return own.empty() && !is_dialect ? both : own;
  };
  const bool is_of_both = own_columns.empty() && own_units.empty() && !is_dialect &&
                          !(request.columns.empty() && request.units.empty());
  return {format, either(own_columns, request.columns), either(own_units, request.units),
          is_of_both ? "--columns " : flag, request.job.options.IsInSpace()};
}

/// What is measured in the plane alone.
void CheckDimension(const GapRequest& request) {
  request.job.options.Check();
  if (!request.job.options.IsInSpace()) return;
  if (request.job.tag_offset_m != 0.0) {
    throw std::invalid_argument(fmt::format(
        "--tag-offset is {:g}, which moves a path along its yaw in the plane, and --dimension is "
        "xyz: log the point that is to be compared, and leave --tag-offset out",
        request.job.tag_offset_m));
  }
  if (!request.job.sim_repeats.empty()) {
    throw std::invalid_argument(
        "--sim-repeats measures likeness, which is of paths in the plane, and --dimension is xyz: "
        "leave one of them out");
  }
}

void CheckInputs(const GapRequest& request) {
  CheckDimension(request);
  sessions::RefuseTwins(request.job.reals);
  trajectory::CheckColumns(request.SimLogs());
  trajectory::CheckColumns(request.RealLogs());
  std::vector<std::string> sims = request.job.sim_repeats;
  sims.insert(sims.begin(), request.job.sim);
  sessions::RefuseTwins(sims);
}

void CheckNames(const GapRequest& request) {
  if (!request.figure.empty()) report::RequireFigureName(request.figure);
  std::vector<fs::path> inputs{request.job.sim}, outputs;
  for (const auto* logs : {&request.job.reals, &request.job.sim_repeats}) {
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
  app.add_option("--program", request.program,
                 "the same for runs of this experiment's program, with or without encoders")
      ->type_name("EXPERIMENT");
  app.add_flag(
      "--calibrate-odometry", request.calibrate,
      "the same, and find wheel radii and track from all runs (squares both ways tell them "
      "best)");
  FlagMaker flags(app);
  odometry::RunOptions::Fields(request.run_options, flags);
  flags("window_s", request.calibration.window_s, 0.2, 1e4,
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

}  // namespace

trajectory::ReadOptions GapRequest::SimLogs() const {
  return LogsOf(*this, sim_format, sim_columns, sim_units, "--sim-columns ");
}

trajectory::ReadOptions GapRequest::RealLogs() const {
  return LogsOf(*this, real_format, real_columns, real_units, "--real-columns ");
}

void AddGap(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<GapRequest>();
  app.add_option("SIM", request->job.sim, "log of the simulator (CSV)")->required();
  app.add_option("REAL", request->job.reals, "logs of the robot, one a repeat");
  AddFlags(app, request->job.options);
  AddFlags(app, request->job.verdict);
  FlagMaker flags(app);
  flags(
      "tag_offset_m", request->job.tag_offset_m, -1.0, 1.0,
      "moves the real path forward along its yaw, from the tag to the robot's front (paper: 0.03)");
  flags("sim_format", request->sim_format, "dialect of SIM");
  flags("real_format", request->real_format, "dialect of REAL");
  AddColumnFlags(app, *request);
  app.add_option("--sim-repeats", request->job.sim_repeats,
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
      exit_code = MeasureOdometry(*request);
      return;
    }
    RefuseOdometryFlags(app);
    if (request->job.reals.empty()) {
      throw std::invalid_argument(
          "REAL is required: name logs of the robot (or --odometry for the encoders of run "
          "folders)");
    }
    request->job.sim = FindInput(request->job.sim);
    for (std::string& real : request->job.reals) real = FindInput(real);
    CheckInputs(*request);
    CheckNames(*request);
    request->job.sim_logs = request->SimLogs();
    request->job.real_logs = request->RealLogs();
    exit_code = MeasureLogs(*request);
  });
}

}  // namespace rift::commands
