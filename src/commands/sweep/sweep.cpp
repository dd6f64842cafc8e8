#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "calibrate.hpp"
#include "compare.hpp"
#include "report.hpp"
#include "request.hpp"
#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/commands/sweep/sweep.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/json/fields.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/calibrate/likeness.hpp"
#include "rift/sweep/explain/program_cells.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/falsify.hpp"
#include "rift/sweep/falsify/program_files.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "robot_logs.hpp"
#include "shard.hpp"

namespace rift::commands {

namespace {

namespace fs = std::filesystem;

/// A simulated sweep over nothing means the paper's grid; logs without a space are one setting.
bool LacksSpace(const experiment::Experiment& experiment) {
  return experiment.candidate.kind == experiment::CandidateKind::kSimulation &&
         experiment.space.parameters.empty();
}

void CheckFlags(const SweepRequest& request, const experiment::Experiment& experiment) {
  const bool has_limits = !request.budget.empty() || !request.seconds.empty();
  if (experiment.goal == experiment::Goal::kGrid && has_limits) {
    throw std::invalid_argument(
        fmt::format("{}: goal is grid, which visits every setting: --budget and --seconds limit a "
                    "search (goal: falsify)",
                    request.experiment));
  }
  if (experiment.goal != experiment::Goal::kCalibrate && !request.write_robot.empty()) {
    throw std::invalid_argument(request.experiment +
                                ": --write-robot needs goal: calibrate (configs/calibrate.yaml)");
  }
  if (experiment.candidate.kind == experiment::CandidateKind::kProgram &&
      !request.write_robot.empty()) {
    throw std::invalid_argument(
        request.experiment +
        ": --write-robot writes the robot of rift's own simulator, and candidate.kind is program: "
        "the fitted values are in calibration.json");
  }
}

/// Budgets become part of the experiment, so that what is saved is what was run.
experiment::Experiment LoadFor(const SweepRequest& request) {
  std::vector<std::string> overrides = request.overrides;
  if (!request.budget.empty()) overrides.push_back("search.budget=" + request.budget);
  if (!request.seconds.empty()) overrides.push_back("search.max_s=" + request.seconds);
  const experiment::Experiment experiment = ReadExperiment(request.experiment, overrides);
  CheckFlags(request, experiment);
  RequireFolderName(request.out, "a sweep");
  if (experiment.candidate.kind == experiment::CandidateKind::kSimulation) {
    RequireWaypoints(experiment, request.experiment);
  }
  if (!request.any_waypoints &&
      experiment.candidate.kind == experiment::CandidateKind::kSimulation) {
    RequireReachableWaypoints(experiment, request.experiment);
  }
  return experiment;
}

/// The experiment as it is swept.
experiment::Experiment PlanFor(const SweepRequest& request, experiment::Experiment experiment) {
  if (LacksSpace(experiment)) experiment.space = experiment::PaperSpace();
  CheckRequest(request.explain, experiment);
  return experiment;
}

/// An earlier run's report beside a table without a gap would tell of other trials.
void RemoveReport(const fs::path& out) {
  for (const char* name :
       {"report.html", "explanation.json", "likeness.json", "programs.json", "figures"}) {
    fs::remove_all(out / name);
  }
}

/// Of a sweep that starts over. Drives of the robot, and the suggestions that they were made from,
/// are left alone.
void RemoveFindings(const fs::path& out) {
  RemoveReport(out);
  for (const char* name : {"shrunk", "shrunk.json", "rare_event.json"}) fs::remove_all(out / name);
}

/// What the process ends with when there is nothing to report on: logs that are not there are bad
/// input, a robot that never arrives is a result.
int EndWithoutGap(const SweepRequest& request, const fs::path& out,
                  const sweep::SweepResult& result) {
  RemoveReport(out);
  const std::string message =
      fmt::format("{}: not one of {} trials could be compared; the first: {}", request.experiment,
                  result.rows.size(), result.rows.front().reason);
  const auto lacks_log = [](const sweep::TrialRow& row) {
    return row.status == sweep::TrialStatus::kMissing ||
           row.status == sweep::TrialStatus::kUnreadable;
  };
  const bool is_input = std::all_of(result.rows.begin(), result.rows.end(), lacks_log);
  if (is_input || result.candidate_kind == "logs") throw std::invalid_argument(message);
  terminal::Say("rift: " + message);
  return terminal::kNotReached;
}

void Save(const fs::path& out, const experiment::Experiment& experiment,
          const sweep::Evaluator& evaluator, const sweep::SweepResult& result) {
  files::WriteFile(out / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(out / "inputs.txt", evaluator.InputsText());
  files::WriteFile(out / "table.csv", report::TableCsv(result));
  files::WriteFile(out / "summary.json", report::SummaryJson(result));
}

/// A failure that leaves its setting undecided may be one of many.
bool MayFail(const sweep::SweepResult& result) {
  return result.Count(gap::Verdict::kFalsified) > 0 ||
         std::any_of(result.settings.begin(), result.settings.end(), [](const auto& setting) {
           return setting.verdict.verdict == gap::Verdict::kUndecided && setting.verdict.above > 0;
         });
}

void NotePlan(const SweepRequest& request, const experiment::Experiment& loaded) {
  if (LacksSpace(loaded)) {
    terminal::Say(
        fmt::format("note: {} names no space: the paper's grid of surface, v_min and v_max",
                    request.experiment));
  }
  if (loaded.candidate.kind == experiment::CandidateKind::kSimulation) WarnOfTilt(loaded);
}

void NoteTooFewRepeats(const experiment::Experiment& experiment) {
  if (experiment.goal != experiment::Goal::kFalsify) return;
  const int needed = sweep::TrialsToFalsify(experiment.falsify, experiment.search.budget);
  if (experiment.falsify.most_repeats >= needed) return;
  terminal::Say(fmt::format(
      "note: falsify.most_repeats is {}, and it takes {} failing trials to falsify the first of {} "
      "settings at {:g} % confidence: settings that fail may stay undecided",
      experiment.falsify.most_repeats, needed, experiment.search.budget,
      100.0 * experiment.falsify.confidence));
}

/// A sweep that has a journal goes on with it, or says what differs. Without one, only the same
/// experiment may be written once more.
void RefuseOtherSweep(const SweepRequest& request, const experiment::Experiment& experiment,
                      const fs::path& out) {
  RefuseRunFolder(out);
  const bool goes_on = IsComputed(experiment) && experiment.goal != experiment::Goal::kCalibrate &&
                       fs::exists(out / "journal.sqlite");
  const fs::path saved = out / "experiment.yaml";
  if (request.fresh || goes_on || !fs::exists(saved)) return;
  if (files::ReadFile(saved) == experiment::WriteExperiment(experiment)) return;
  throw std::invalid_argument(
      fmt::format("{} holds another experiment ({}): name another folder with --out, or give "
                  "--force to replace "
                  "it",
                  out.string(), saved.string()));
}

/// As it can be typed again.
std::string ForShell(const std::string& word) {
  if (word.find_first_of(" \t'\"\\$&;()<>|*?[]#`!{}") == word.npos) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Logs are compared in seconds and keep no journal.
int SayStopped(const experiment::Experiment& experiment, const fs::path& out) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    terminal::Say("stopped; nothing was written, and the same command starts over");
    return terminal::kStopped;
  }
  terminal::Say(
      fmt::format("stopped; the same command goes on where it was (rift sweep --status {})",
                  ForShell(out.string())));
  return terminal::kStopped;
}

void SaveReport(const fs::path& out, const sweep::SweepResult& result,
                const sweep::Explanation& explanation,
                const std::vector<sweep::GroupLikeness>& likeness,
                const std::vector<sweep::ProgramCell>& programs, sweep::Evaluator& evaluator) {
  files::WriteFile(out / "explanation.json", report::ExplanationJson(result, explanation));
  WriteSweepReport(out, result, explanation, programs, evaluator);
  if (!programs.empty()) {
    files::WriteFile(out / "programs.json", report::ProgramsJson(result.parameters, programs));
  }
  if (!likeness.empty())
    files::WriteFile(out / "likeness.json", report::Dump(report::LikenessJson(likeness)));
}

void Print(const SweepRequest& request, const sweep::SweepResult& result,
           const sweep::Explanation& explanation,
           const std::vector<sweep::GroupLikeness>& likeness) {
  if (request.json) {
    terminal::PrintData(report::SummaryJson(result));
    return;
  }
  if (request.brief) {
    terminal::PrintText(report::BriefText(result, explanation));
    return;
  }
  terminal::PrintText(report::SweepText(result));
  if (!likeness.empty()) terminal::PrintText("\n" + report::LikenessText(likeness));
  terminal::PrintText(report::ExplanationText(result, explanation, request.explain.suggest > 0));
}

/// The cluster that was asked for, if what is asked of it can be done there.
std::optional<sweep::SlurmOptions> ClusterFor(const SweepRequest& request,
                                              const experiment::Experiment& experiment) {
  std::optional<sweep::SlurmOptions> cluster = ClusterOf(request.engine);
  if (cluster) CheckEngine(experiment, request.experiment);
  return cluster;
}

int Sweep(const SweepRequest& request) {
  const experiment::Experiment loaded = LoadFor(request);
  if (!request.engine.shard.empty()) return RunShard(request, loaded);
  const std::optional<sweep::SlurmOptions> cluster = ClusterFor(request, loaded);
  const sweep::SlurmOptions* const engine = cluster ? &*cluster : nullptr;
  // A cluster's nodes have programs of their own.
  if (!cluster) sweep::RequirePrograms(loaded, request.experiment);
  if (loaded.goal == experiment::Goal::kCalibrate) {
    if (request.serve) {
      throw std::invalid_argument(
          request.experiment +
          ": --serve shows the trials of a sweep as they come in, and goal: "
          "calibrate has no such page");
    }
    RefuseOtherSweep(request, loaded, OutputOf(request.out, loaded.name));
    return Calibrate(request, loaded, engine);
  }

  const experiment::Experiment experiment = PlanFor(request, loaded);
  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  NotePlan(request, loaded);
  NoteTooFewRepeats(experiment);

  const fs::path out = OutputOf(request.out, experiment.name);
  RefuseOtherSweep(request, experiment, out);
  const files::FolderLock lock(out);
  if (request.fresh) RemoveFindings(out);
  const ProgressStyle progress = StyleFor(request.quiet, request.json_progress);
  std::optional<LivePage> live;
  if (request.serve) live.emplace(out, evaluator);
  const std::optional<sweep::SweepResult> judged =
      RunSweep(evaluator, {.out = out,
                           .jobs = request.jobs,
                           .fresh = request.fresh,
                           .progress = progress,
                           .live = live ? &*live : nullptr,
                           .cluster = engine});
  if (!judged) return SayStopped(experiment, out);
  lock.RequireInPlace();
  Save(out, experiment, evaluator, *judged);
  if (judged->all.told == 0) return EndWithoutGap(request, out, *judged);

  sweep::ExplainOptions options = OptionsFor(request.explain);
  options.robot = TakeRobotLogs(out, evaluator);
  const sweep::Explanation explanation = sweep::Explain(*judged, options);
  if (request.explain.suggest > 0) {
    SaveSuggested(out, experiment, *judged, explanation.suggestions);
  }
  const std::vector<sweep::GroupLikeness> likeness =
      sweep::MeasureSweepLikeness(evaluator, request.jobs);
  const std::vector<sweep::ProgramCell> programs = sweep::MeasurePrograms(evaluator);
  SaveReport(out, *judged, explanation, likeness, programs, evaluator);
  if (live) live->End();
  Print(request, *judged, explanation, likeness);
  if (!request.json && !request.brief)
    terminal::PrintText(report::ProgramText(judged->parameters, programs));

  const bool is_done = SpendTrials(out, *judged, request.explain, evaluator,
                                   {request.jobs, progress, engine}, request.json);
  if (!is_done) return terminal::kStopped;
  lock.RequireInPlace();
  if (!request.quiet) {
    if (experiment.candidate.kind != experiment::CandidateKind::kLogs) {
      terminal::Say(
          fmt::format("worst row again: rift simulate --replay {} worst", ForShell(out.string())));
    }
    terminal::Say("report: " + (out / "report.html").string());
  }
  if (judged->all.n == 0) return terminal::kNotReached;
  return request.exit_code && MayFail(*judged) ? terminal::kFalsified : terminal::kDone;
}

void AddOptions(CLI::App& app, SweepRequest& request) {
  app.add_option("EXPERIMENT", request.experiment, "YAML file of the experiment");
  AddSetFlag(app, request.overrides, "gap.skip_start=0.1");
  app.add_option("--out", request.out,
                 "folder for journal, table, summary, figures and report [out/NAME]")
      ->type_name("DIR");
  app.add_option("--budget", request.budget, "settings that a search may try (search.budget)")
      ->type_name("N");
  app.add_option("--seconds", request.seconds, "time that a search may take (search.max_s)")
      ->type_name("S");
  app.add_option("--jobs", request.jobs, "worker processes; the results are the same for any")
      ->check(CLI::Range(1, 4096))
      ->capture_default_str();
  app.add_flag("--fresh,--force", request.fresh,
               "start over instead of going on with an earlier journal, and replace what another "
               "experiment left");
  AddAnyWaypointsFlag(app, request.any_waypoints);
  app.add_option("--status", request.status, "tell how far the sweep in a folder is, and end")
      ->type_name("DIR");
  app.add_option("--compare", request.compare,
                 "hold the folders of two sweeps over the same space against each other, before "
                 "and after a change, and end")
      ->expected(2)
      ->type_name("DIR");
  app.add_option("--page", request.page, "with --compare: write it as a page as well")
      ->type_name("FILE.html");
  AddEngineFlags(app, request.engine);
  AddExplainFlags(app, request.explain);
  AddKeysFlag(app);
  app.add_flag("--brief", request.brief,
               "print five lines: what fails, where, why, how sure, what next");
  CLI::Option* quiet = app.add_flag("--quiet", request.quiet, "no progress");
  app.add_flag("--json-progress", request.json_progress, "progress as lines of JSON on stderr")
      ->excludes(quiet);
  app.add_flag("--json", request.json, "print the summary (or status) as JSON instead of text")
      ->excludes(app.get_option("--brief"));
  app.add_option("--write-robot", request.write_robot,
                 "goal: calibrate: write the fitted robot, to be used as include:")
      ->type_name("FILE.yaml");
  app.add_flag("--serve", request.serve,
               "show the report growing while the sweep runs, at an address of this machine alone "
               "that is printed on stderr");
  app.add_flag("--exit-code", request.exit_code,
               "end with 1 when a setting is falsified, or undecided with a failure");
  app.footer(
      "Ctrl-C stops a sweep, and the same command goes on with it, also after a crash.\n"
      "goal: calibrate fits the simulator, or somebody else's, to logs (configs/calibrate.yaml).\n"
      "Example: rift sweep configs/waypoints/paper.yaml --out out/paper\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --suggest 3 --shrink "
      "worst\n"
      "         rift sweep configs/programs/diff_drive.yaml --out out/own (somebody else's "
      "simulator)\n"
      "         rift sweep configs/programs/calibrate.yaml --out out/fit (its parameters, fitted "
      "to "
      "logs)\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --serve\n"
      "         rift sweep configs/waypoints/paper.yaml --out out/paper --engine slurm --shards "
      "40\n"
      "         rift sweep --compare out/before out/after --page out/change.html");
}

}  // namespace

int SweepFile(const fs::path& file, const fs::path& out, bool json) {
  return Sweep({.experiment = file.string(), .out = out.string(), .json = json});
}

void AddSweep(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<SweepRequest>();
  AddOptions(app, *request);
  app.callback([request, &exit_code] {
    if (!request->status.empty()) {
      const std::string status = SweepStatus(request->status, request->json);
      request->json ? terminal::PrintData(status) : terminal::PrintText(status);
      return;
    }
    if (!request->compare.empty()) {
      CompareSweepFolders(request->compare, request->page, request->json, request->fresh);
      return;
    }
    if (!request->page.empty()) {
      throw std::invalid_argument("--page " + request->page +
                                  ": it is the page of --compare DIR DIR");
    }
    if (request->experiment.empty()) {
      throw std::invalid_argument("EXPERIMENT is missing: name the YAML file of the experiment");
    }
    request->experiment = FindInput(request->experiment);
    exit_code = Sweep(*request);
  });
}

}  // namespace rift::commands
