#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/commands/arguments/arguments.hpp"
#include "rift/commands/command.hpp"
#include "rift/files/files.hpp"
#include "rift/limits/limits.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sessions/gap/measure.hpp"
#include "rift/sessions/gap/odometry.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

/// What `rift gap` was asked for.
struct GapRequest {
  sessions::GapJob job;
  sessions::OdometryJob odometry;  ///< of runs held together with their encoders
  std::string json, profile, figure;
  bool exit_code = false;
  bool force = false;
};

void CheckNames(const GapRequest& request) {
  if (!request.figure.empty()) report::RequireFigureName(request.figure);
  std::vector<fs::path> inputs{request.job.sim}, outputs;
  for (const auto* logs : {&request.job.reals, &request.job.sim_repeats}) {
    inputs.insert(inputs.end(), logs->begin(), logs->end());
  }
  Refuse({{request.json == "-" && request.profile == "-",
           "--json - and --profile - are both stdout: name a file for one"}});
  for (const std::string& output : {request.json, request.profile}) {
    if (!output.empty() && output != "-") outputs.emplace_back(output);
  }
  if (!request.figure.empty()) outputs.emplace_back(request.figure);
  CheckOutputs(inputs, {.files = outputs, .force = request.force});
}

/// To stdout or a file; true where the text for people is to be printed beside it.
bool SaveJson(const std::string& name, const std::string& json) {
  if (name == "-") {
    terminal::PrintData(json);
    return false;
  }
  files::WriteFile(name, json);
  return true;
}

int MeasureLogs(const GapRequest& request) {
  limits::Require(limits::Amount::kSamples, request.job.options.samples, "--samples");
  const gap::GapResult result = sessions::MeasureGap(request.job, terminal::Say);
  const bool is_piped = request.profile == "-";
  if (is_piped) terminal::PrintData(report::ProfileCsv(result));
  if (!request.profile.empty() && !is_piped) {
    files::WriteFile(request.profile, report::ProfileCsv(result));
  }
  if (!request.figure.empty()) report::WriteFigure(request.figure, report::GapFigure(result));
  const bool has_text = request.json.empty() || SaveJson(request.json, report::GapJson(result));
  if (has_text && !is_piped) terminal::PrintText(report::GapText(result));
  return request.exit_code && result.verdict.MayFail() ? terminal::kFalsified : terminal::kDone;
}

int MeasureOdometry(const GapRequest& request) {
  std::vector<std::string> names = request.job.reals;
  names.insert(names.begin(), request.job.sim);
  sessions::RefuseTwins(names);
  for (const std::string& other : {request.profile, request.figure}) {
    Refuse({{!other.empty(),
             other + ": --profile and --figure are of two logs, leave them out with --odometry"}});
  }
  std::vector<sessions::LoadedRun> runs;
  std::vector<fs::path> inputs, outputs;
  for (const std::string& name : names) {
    runs.push_back(sessions::LoadRun(name, request.odometry.program));
    inputs.insert(inputs.end(), runs.back().files.begin(), runs.back().files.end());
  }
  if (!request.odometry.program.empty()) inputs.emplace_back(request.odometry.program);
  if (!request.json.empty() && request.json != "-") outputs.emplace_back(request.json);
  CheckOutputs(inputs, {.files = outputs, .force = request.force});
  sessions::OdometryJob job = request.odometry;
  job.calibration.confidence = request.job.verdict.confidence;
  for (const sessions::LoadedRun& run : runs) {
    for (const std::string& note : run.notes) terminal::Say(note);
  }
  sessions::LeaveOutCopies(runs, terminal::Say);
  const odometry::OdometryResult result = sessions::MeasureOdometry(runs, job);
  const bool has_text =
      request.json.empty() || SaveJson(request.json, report::OdometryJson(result));
  if (has_text) terminal::PrintText(report::OdometryText(result));
  return terminal::kDone;
}

void RefuseOdometryFlags(const CLI::App& app) {
  for (const char* flag : {"--slip-bins", "--moved-share", "--tag-ahead", "--window"}) {
    Refuse({{app.count(flag) > 0,
             fmt::format("{} is for runs held together with their encoders: give --odometry, "
                         "--program or --calibrate-odometry as well, or leave it out",
                         flag)}});
  }
}

/// The other way about: what two logs are compared by.
void RefuseGapFlags(const CLI::App& app) {
  const std::set<std::string> taken{
      "--odometry",  "--program", "--calibrate-odometry", "--slip-bins", "--moved-share",
      "--tag-ahead", "--window",  "--confidence",         "--json",      "--force",
      "--profile",   "--figure",  "--large-inputs"};
  for (const CLI::Option* option : app.get_options()) {
    const std::string flag = option->get_name();
    Refuse({{option->count() > 0 && flag.starts_with("--") && !taken.contains(flag),
             flag + " is for the gap of two logs, and runs are held together with their encoders "
                    "here: leave it out, or --odometry, --program and --calibrate-odometry"}});
  }
}

}  // namespace

void AddGap(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<GapRequest>();
  app.add_option("SIM", request->job.sim, "log of the simulator (CSV)")->required();
  app.add_option("REAL", request->job.reals, "logs of the robot, one a repeat");
  AddFlags(app, request->job);
  FlagMaker flags(app);
  flags("json", request->json, "FILE|-",
        "write everything as JSON; - for stdout, without the text");
  flags("profile", request->profile, "FILE.csv|-",
        "write the error along the path; - for stdout, without the text");
  flags("figure", request->figure, "FILE.svg|FILE.png",
        "draw paths, error over u and its distribution");
  flags("exit_code", request->exit_code,
        "end with 1 when the verdict is falsified, or undecided with a failure");
  AddForceFlag(app, request->force);
  AddFlags(app, request->odometry);
  app.footer(
      "Example: rift gap out/square1 out/square2 --odometry --calibrate-odometry\n"
      "         rift gap sim.csv real1.csv real2.csv --real-format tracker --tag-offset 0.03\n"
      "         rift gap sim.csv real.csv --real-columns t=time,x=pose_x,y=pose_y,yaw=theta:deg "
      "--real-units mm,ms");
  app.callback([request, &app, &exit_code] {
    if (request->odometry.IsAsked()) {
      RefuseGapFlags(app);
      exit_code = MeasureOdometry(*request);
      return;
    }
    RefuseOdometryFlags(app);
    Refuse({{request->job.reals.empty(),
             "REAL is required: name logs of the robot (or --odometry for the encoders of run "
             "folders)"}});
    request->job.sim = files::FindInput(request->job.sim);
    for (std::string& real : request->job.reals) real = files::FindInput(real);
    request->job.Check();
    CheckNames(*request);
    exit_code = MeasureLogs(*request);
  });
}

}  // namespace rift::commands
