#include "rift/commands/sweep/sweep.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "progress.hpp"
#include "rift/commands/arguments/arguments.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/json/sweep_change.hpp"
#include "rift/report/page/sweep_change.hpp"
#include "rift/report/text/sweep_change.hpp"
#include "rift/sessions/sweep/compare.hpp"
#include "rift/sessions/sweep/findings.hpp"
#include "rift/sessions/sweep/folder.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sessions/sweep/live_page.hpp"
#include "rift/sessions/sweep/plan.hpp"
#include "rift/sessions/sweep/run.hpp"
#include "rift/sessions/sweep/shard.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "steps.hpp"

namespace rift::commands {

namespace {

namespace fs = std::filesystem;

/// With --serve.
std::unique_ptr<sessions::LivePage> Serve(const SweepRequest& request, const fs::path& out,
                                          sweep::Evaluator& evaluator) {
  if (!request.serve) return nullptr;
  auto page = std::make_unique<sessions::LivePage>(out, evaluator);
  terminal::Say("live: " + page->Url());
  return page;
}

/// What a job of --engine slurm does: computes a shard into OUT/shards (sessions::RunShard).
int ComputeShard(const SweepRequest& request, const experiment::Experiment& experiment) {
  const sessions::ShardFile shard = sessions::ReadShard(request.engine.shard, experiment);
  const bool is_done = sessions::RunShard(shard, experiment, request.experiment, FileInputs(),
                                          {.out = OutputOf(request.out, experiment.name),
                                           .jobs = request.jobs,
                                           .copy_every_s = request.engine.copy_every_s},
                                          ObserverFor(ProgressStyle::kQuiet));
  return is_done ? terminal::kDone : terminal::kStopped;
}

int Sweep(const SweepRequest& request) {
  const experiment::Experiment loaded = LoadFor(request);
  if (!request.engine.shard.empty()) return ComputeShard(request, loaded);
  const std::optional<sweep::SlurmOptions> cluster =
      sessions::ClusterFor(request.engine, loaded, request.experiment);
  const sweep::SlurmOptions* const engine = cluster ? &*cluster : nullptr;
  if (loaded.goal == experiment::Goal::kCalibrate) return Calibrate(request, loaded, engine);

  const experiment::Experiment experiment = sessions::PlanSweep(loaded);
  request.further.Check(experiment);
  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  sessions::NotePlan(loaded, request.experiment, terminal::Say);
  const fs::path out = FolderFor(request, experiment);
  const files::FolderLock lock(out);
  if (request.fresh) sessions::RemoveFindings(out);

  const sessions::SweepObserver observer =
      ObserverFor(StyleFor(request.quiet, request.json_progress));
  const std::unique_ptr<sessions::LivePage> live = Serve(request, out, evaluator);
  const std::optional<sweep::SweepResult> judged = sessions::RunSweep(
      evaluator, {out, request.jobs, request.fresh, live.get(), engine}, observer);
  const std::string when_stopped = StoppedText(request, experiment, out);
  if (!judged) return SayStopped(when_stopped);
  lock.RequireInPlace();
  sessions::SaveResult(out, evaluator, *judged);
  if (judged->all.told == 0) {
    sessions::RemoveReport(out);
    return EndWithoutGap(request, *judged);
  }

  // The likeness may take as long as all else.
  std::optional<terminal::EndSignal> end(when_stopped);
  const sessions::SweepFindings findings =
      sessions::ExplainSweep(out, evaluator, *judged, request.suggest.value_or(0), request.jobs);
  end.reset();
  sessions::SaveReport(out, evaluator, *judged, findings, observer);
  if (live) live->End();
  PrintFindings(request, *judged, findings);
  terminal::FlushResults();  // the trials of further questions take long
  const std::optional<sessions::FurtherAnswers> answers =
      sessions::Answer(request.further, out, *judged, evaluator, {request.jobs, engine}, observer);
  if (!answers) return SayStopped(when_stopped);
  PrintAnswers(request, out, *judged, *answers);
  lock.RequireInPlace();
  SayWhere(request, experiment, out);
  return ExitCodeOf(request, *judged);
}

/// --status and --compare only read folders: a flag of a sweep would do nothing beside them, and
/// --exit-code tell of every change that all is well.
void RefuseFlagsOfSweep(const CLI::App& app, const std::string& asked, std::set<std::string> own) {
  own.insert({asked, "--json", "--large-inputs"});
  for (const CLI::Option* option : app.get_options()) {
    const std::string name = option->get_name();
    Refuse({{option->count() > 0 && !own.contains(name),
             fmt::format("{} does not go with {}, which only reads folders: leave it out", name,
                         asked)}});
  }
}

/// With --status.
void PrintStatus(const SweepRequest& request) {
  const auto [summary, state, shards] = sessions::ReadStatus(request.status);
  request.json ? terminal::PrintData(report::StatusJson(summary, state, shards))
               : terminal::PrintText(report::StatusText(summary, state, shards));
}

/// With --compare: a table, or JSON, and a page where one is asked for.
void Compare(const SweepRequest& request) {
  if (!request.page.empty()) {
    std::vector<fs::path> inputs;
    for (const fs::path folder : request.compare) {
      for (const char* name : {"experiment.yaml", "table.csv", "summary.json"}) {
        inputs.push_back(folder / name);
      }
      inputs.push_back(folder / sessions::kJournalName);  // the trials that all of it is made from
    }
    CheckOutputs(inputs, {.files = {request.page}, .force = request.fresh});
  }
  const sweep::SweepChange change =
      sessions::CompareFolders(request.compare.at(0), request.compare.at(1));
  if (!request.page.empty()) files::WriteFile(request.page, report::RenderChange(change));
  request.json ? terminal::PrintData(report::ChangeJson(change))
               : terminal::PrintText(report::ChangeText(change));
}

}  // namespace

int SweepFile(const fs::path& file, const fs::path& out, bool any_waypoints, bool json) {
  return Sweep({.experiment = file.string(),
                .out = out.string(),
                .any_waypoints = any_waypoints,
                .json = json});
}

void AddSweep(CLI::App& app, int& exit_code) {
  const auto request = std::make_shared<SweepRequest>();
  AddSweepFlags(app, *request);
  app.callback([request, &app, &exit_code] {
    if (!request->status.empty()) {
      RefuseFlagsOfSweep(app, "--status", {});
      return PrintStatus(*request);
    }
    if (!request->compare.empty()) {
      RefuseFlagsOfSweep(app, "--compare", {"--page", "--fresh"});
      return Compare(*request);
    }
    Refuse({{!request->page.empty(),
             "--page " + request->page + ": it is the page of --compare DIR DIR"},
            {request->experiment.empty(),
             "EXPERIMENT is missing: name the YAML file of the experiment"}});
    request->experiment = files::FindInput(request->experiment);
    exit_code = Sweep(*request);
  });
}

}  // namespace rift::commands
