#include "gap.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <vector>

#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/limits/limits.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void Save(const GapRequest& request, const gap::GapResult& result) {
  const bool is_piped = request.profile == "-";
  if (is_piped) terminal::PrintData(report::ProfileCsv(result));
  if (!request.profile.empty() && !is_piped) {
    files::WriteFile(request.profile, report::ProfileCsv(result));
  }
  if (!request.figure.empty()) report::WriteFigure(request.figure, report::GapFigure(result));
  if (request.json == "-") {
    terminal::PrintData(report::GapJson(result));
    return;
  }
  if (!request.json.empty()) files::WriteFile(request.json, report::GapJson(result));
  if (!is_piped) terminal::PrintText(report::GapText(result));
}

}  // namespace

int MeasureLogs(const GapRequest& request) {
  limits::Require(limits::Amount::kSamples, request.job.options.samples, "--samples");
  const gap::GapResult result = sessions::MeasureGap(request.job, terminal::Say);
  Save(request, result);
  return request.exit_code && result.verdict.MayFail() ? terminal::kFalsified : terminal::kDone;
}

int MeasureOdometry(const GapRequest& request) {
  std::vector<std::string> names = request.job.reals;
  names.insert(names.begin(), request.job.sim);
  sessions::RefuseTwins(names);
  for (const std::string& other : {request.profile, request.figure}) {
    if (other.empty()) continue;
    throw std::invalid_argument(fmt::format(
        "{}: --profile and --figure are of two logs, leave them out with --odometry", other));
  }
  std::vector<sessions::LoadedRun> runs;
  std::vector<fs::path> inputs, outputs;
  for (const std::string& name : names) {
    runs.push_back(sessions::LoadRun(name, request.program));
    inputs.insert(inputs.end(), runs.back().files.begin(), runs.back().files.end());
  }
  if (!request.json.empty() && request.json != "-") outputs.emplace_back(request.json);
  CheckOutputs(inputs, {.files = outputs, .force = request.force});
  std::optional<odometry::CalibrationOptions> calibration;
  if (request.calibrate) {
    calibration = request.calibration;
    calibration->confidence = request.job.verdict.confidence;
  }
  const odometry::OdometryResult result =
      sessions::MeasureOdometry(runs, request.run_options, calibration);
  if (request.json == "-") {
    terminal::PrintData(report::OdometryJson(result));
    return terminal::kDone;
  }
  if (!request.json.empty()) files::WriteFile(request.json, report::OdometryJson(result));
  terminal::PrintText(report::OdometryText(result));
  return terminal::kDone;
}

}  // namespace rift::commands
