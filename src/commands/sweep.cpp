#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "files.hpp"
#include "input_hashes.hpp"
#include "logs.hpp"
#include "rift/commands/command.hpp"
#include "rift/config/experiment.hpp"
#include "rift/sweep/log_sweep.hpp"
#include "sweep_output.hpp"
#include "sweep_report.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

struct SweepRequest {
  std::string experiment;
  std::vector<std::string> overrides;
  std::string out;
  bool json = false;
  bool exit_code = false;
};

/// Loads each log once, however many trials it takes part in.
class LogCache {
 public:
  LogCache(const config::Experiment& experiment, InputHashes& hashes)
      : experiment_(experiment), hashes_(hashes) {}

  sweep::LoadedLog operator()(const std::string& path, sweep::Side side) {
    const auto [found, is_new] = logs_.try_emplace({path, side});
    if (is_new) found->second = Load(path, side);
    return found->second;
  }

 private:
  sweep::LoadedLog Load(const std::string& path, sweep::Side side) {
    if (!fs::exists(path)) return {sweep::TrialStatus::kMissing, "no such file", {}};
    const bool is_reference = side == sweep::Side::kReference;
    try {
      hashes_.Add(path);
      trajectory::Log log = is_reference
                                ? LoadLog(path, experiment_.reference.format,
                                          experiment_.reference.tag_offset_m, "reference.format")
                                : LoadLog(path, experiment_.candidate.format);
      return {sweep::TrialStatus::kOk, "", std::move(log.trajectory)};
    } catch (const std::invalid_argument& bad_log) {  // a row of its own, not the sweep's end
      return {sweep::TrialStatus::kUnreadable, bad_log.what(), {}};
    }
  }

  const config::Experiment& experiment_;
  InputHashes& hashes_;
  std::map<std::pair<std::string, sweep::Side>, sweep::LoadedLog> logs_;
};

void RequirePath(const sweep::PathTemplate& path, const std::string& key,
                 const std::string& experiment) {
  if (!path.text.empty()) return;
  throw std::invalid_argument(
      fmt::format("{}: {} is missing: name the logs, such as {}: logs/{{surface}}_{{trial}}.csv",
                  experiment, key, key));
}

sweep::SweepResult Compare(const SweepRequest& request, const config::Experiment& experiment,
                           const sweep::LogSource& source) {
  RequirePath(experiment.candidate.path, "candidate.path", request.experiment);
  RequirePath(experiment.reference.path, "reference.path", request.experiment);
  const sweep::LogSweepPlan plan{.name = experiment.name,
                                 .parameters = experiment.space.parameters,
                                 .trials = experiment.reference.trials.names,
                                 .candidate_path = experiment.candidate.path.text,
                                 .reference_path = experiment.reference.path.text,
                                 .gap = experiment.gap};
  sweep::SweepResult result = sweep::CompareLogs(plan, source);
  if (result.all.n == 0) {
    throw std::invalid_argument(
        fmt::format("{}: not one of {} trials could be compared; the first: {}", request.experiment,
                    result.rows.size(), result.rows.front().reason));
  }
  return result;
}

}  // namespace

void AddSweep(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<SweepRequest>();
  app.add_option("EXPERIMENT", request->experiment, "YAML file of the experiment")->required();
  app.add_option("--set", request->overrides, "sets one key, such as gap.skip_start=0.1")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--out", request->out, "folder for table, summary, figures and report [out/NAME]")
      ->type_name("DIR");
  app.add_flag("--json", request->json, "print the summary as JSON instead of text");
  app.add_flag("--exit-code", request->exit_code, "end with 1 when any trial is falsified");
  app.footer("Example: rift sweep configs/paper_webots.yaml --out out/paper");
  app.callback([request, &exit_code] {
    const config::Experiment experiment =
        config::LoadExperiment(request->experiment, request->overrides,
                               [](const std::string& path) { return ReadFile(path); });
    InputHashes hashes;
    LogCache logs(experiment, hashes);
    const sweep::SweepResult result = Compare(*request, experiment, std::ref(logs));
    const fs::path out = request->out.empty() ? fs::path("out") / experiment.name : fs::path(request->out);
    WriteFile(out / "experiment.yaml", config::WriteExperiment(experiment));
    WriteFile(out / "inputs.txt", hashes.Text());
    WriteFile(out / "table.csv", TableCsv(result));
    WriteFile(out / "summary.json", SummaryJson(result));
    WriteSweepReport(out, result, std::ref(logs));
    fmt::print("{}", request->json ? SummaryJson(result) : SweepText(result));
    fmt::print(stderr, "report: {}\n", (out / "report.html").string());
    exit_code = request->exit_code && result.all.failures > 0 ? kFalsified : kDone;
  });
}

}  // namespace rift::commands
