#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "files.hpp"
#include "json_fields.hpp"
#include "keys_flag.hpp"
#include "likeness_output.hpp"
#include "rift/commands/command.hpp"
#include "sweep_likeness.hpp"
#include "sweep_output.hpp"
#include "sweep_report.hpp"
#include "sweep_sources.hpp"

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

/// A simulated sweep over nothing means the paper's grid; logs without a space are one setting.
bool LacksSpace(const config::Experiment& experiment) {
  return experiment.candidate.kind == sweep::CandidateKind::kSimulation &&
         experiment.space.parameters.empty();
}

config::Experiment LoadFor(const SweepRequest& request) {
  return config::LoadExperiment(request.experiment, request.overrides,
                                [](const std::string& path) { return ReadFile(path); });
}

sweep::SweepResult Run(SweepSources& sources) {
  return sweep::CompareGrid(
      sources.Plan(),
      [&](const sweep::Theta& theta, const std::string& trial, const sweep::Recording& reference) {
        return sources.Candidate(theta, trial, reference);
      },
      [&](const sweep::Theta& theta, const std::string& trial) {
        return sources.Reference(theta, trial);
      });
}

/// What the process ends with when there is nothing to report on: logs that are not there are bad
/// input, a robot that never arrives is a result.
int EndWithoutGap(const SweepRequest& request, const sweep::SweepResult& result) {
  const std::string message =
      fmt::format("{}: not one of {} trials could be compared; the first: {}", request.experiment,
                  result.rows.size(), result.rows.front().reason);
  if (result.candidate_kind == "logs") throw std::invalid_argument(message);
  fmt::print(stderr, "rift: {}\n", message);
  return kNotReached;
}

void Save(const fs::path& out, const config::Experiment& experiment, const SweepSources& sources,
          const sweep::SweepResult& result) {
  WriteFile(out / "experiment.yaml", config::WriteExperiment(experiment));
  WriteFile(out / "inputs.txt", sources.InputsText());
  WriteFile(out / "table.csv", TableCsv(result));
  WriteFile(out / "summary.json", SummaryJson(result));
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
  AddKeysFlag(app);
  app.add_flag("--json", request->json, "print the summary as JSON instead of text");
  app.add_flag("--exit-code", request->exit_code, "end with 1 when any trial is falsified");
  app.footer("Example: rift sweep configs/waypoints/paper.yaml --out out/paper");
  app.callback([request, &exit_code] {
    config::Experiment experiment = LoadFor(*request);
    const bool lacks_space = LacksSpace(experiment);
    if (lacks_space) experiment.space = sweep::PaperSpace();
    SweepSources sources(experiment, request->experiment);
    if (lacks_space) {
      fmt::print(stderr, "note: {} names no space: the paper's grid of surface, v_min and v_max\n",
                 request->experiment);
    }
    const sweep::SweepResult result = Run(sources);
    const fs::path out = OutputOf(request->out, experiment.name);
    Save(out, experiment, sources, result);
    if (result.all.n == 0) {
      exit_code = EndWithoutGap(*request, result);
      return;
    }
    WriteSweepReport(out, result, sources);
    const std::vector<LikenessRow> likeness = MeasureSweepLikeness(experiment, sources);
    if (!likeness.empty()) WriteFile(out / "likeness.json", Dump(LikenessJson(likeness)));
    fmt::print("{}", request->json ? SummaryJson(result) : SweepText(result));
    if (!likeness.empty() && !request->json) fmt::print("\n{}", LikenessText(likeness));
    fmt::print(stderr, "report: {}\n", (out / "report.html").string());
    exit_code = request->exit_code && result.all.failures > 0 ? kFalsified : kDone;
  });
}

}  // namespace rift::commands
