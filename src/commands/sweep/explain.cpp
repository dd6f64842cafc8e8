#include "explain.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/explain/shrink.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/run/beside_table.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"
#include "run.hpp"

namespace rift::commands {

namespace {

constexpr size_t kPaths = 0;  // that are kept of further trials: no page shows them

/// Trials of a cluster, where there is one.
class Elsewhere {
 public:
  /// All must outlive this.
  Elsewhere(sweep::Evaluator& evaluator, const sweep::Facts& facts,
            const FurtherTrials::Style& style, const terminal::StopSignal& stop) {
    if (style.cluster == nullptr) return;
    cluster_.emplace(evaluator, facts, *style.cluster, style.progress,
                     [&stop] { return !stop.IsAsked(); });
  }

  /// False when it was told to stop.
  bool Resume(const std::filesystem::path& folder, sweep::Journal& journal) {
    return !cluster_ || cluster_->Resume(folder, journal);
  }
  FurtherTrials::Bring Bringing(sweep::Shard shard) {
    if (!cluster_) return nullptr;
    return [this, shard = std::move(shard)] { return cluster_->RunAsOne(shard); };
  }

 private:
  std::optional<Cluster> cluster_;
};

sweep::TrialRequest RequestOf(const sweep::TrialRow& row) {
  return {.theta = row.theta, .trial = row.trial, .seed = row.seed};
}

}  // namespace

FurtherTrials::FurtherTrials(sweep::Evaluator& evaluator, const Style& style,
                             const terminal::StopSignal& stop, sweep::Journal& journal,
                             std::function<void(sweep::Journal&)> tick)
    : style_(style),
      runner_([&evaluator](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
              [&evaluator](const sweep::TrialRequest& trial) {
                return sweep::kBesideTable + evaluator.KeyOf(trial);
              },
              &journal, style.jobs, evaluator.experiment().run,
              {[this](const sweep::TrialRow& row, bool from_journal) {
                 if (progress_) progress_->Seen(row, from_journal);
               },
               [this, &stop, &journal, tick = std::move(tick)] {
                 if (progress_) progress_->Tick();
                 tick(journal);
                 return !stop.IsAsked();
               },
               [&evaluator](sweep::TrialRow& row) { evaluator.NameSides(row); }},
              kPaths) {
  evaluator.LoadLogs();  // workers are copies of what is there when they start
}

std::vector<sweep::TrialRow> FurtherTrials::Run(std::vector<sweep::TrialRequest> requests) {
  if (bring_ && !runner_.HasAll(requests)) {
    if (!std::exchange(bring_, nullptr)()) throw Stopped{};
  }
  std::optional<std::vector<sweep::TrialRow>> rows = runner_.Run(std::move(requests));
  if (!rows) throw Stopped{};
  return *std::move(rows);
}

void FurtherTrials::Begin(int most) { progress_.emplace(style_.progress, SweepSize{.most = most}); }

void FurtherTrials::End() {
  progress_->End("done");
  progress_.reset();
}

void RunTrialsOfShrinking(const experiment::Experiment& experiment, const sweep::TrialRequest& row,
                          const sweep::ShrinkOptions& options, FurtherTrials& trials) {
  sweep::SweepResult result = sweep::EmptyResult(experiment);
  result.rows.push_back({.theta = row.theta, .trial = row.trial, .seed = row.seed});
  sweep::ShrinkRow(experiment, result, 0, options, trials.AsRun());
}

std::string ShrinkInto(const std::filesystem::path& folder,
                       const experiment::Experiment& experiment, const sweep::SweepResult& result,
                       const std::string& row, const sweep::ShrinkOptions& options,
                       FurtherTrials& trials) {
  const int index = sweep::FailingRow(result, row);
  const sweep::ShrunkRow found =
      sweep::ShrinkRow(experiment, result, index, options, trials.AsRun());
  sweep::SweepResult table = sweep::EmptyResult(experiment);
  table.rows = found.rows;
  files::WriteFile(folder / "shrunk" / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(folder / "shrunk" / "table.csv", report::TableCsv(table));
  const std::string trials_folder = (folder / "shrunk").string();
  files::WriteFile(folder / "shrunk.json", report::ShrunkJson(result, found, trials_folder));
  return report::ShrunkText(result, found, trials_folder);
}

std::string RareEventInto(const std::filesystem::path& folder,
                          const experiment::Experiment& experiment,
                          const sweep::RareEventOptions& options, FurtherTrials& trials) {
  trials.Begin(options.replicas * options.samples_per_level * options.most_levels);
  const sweep::RareEvent event = sweep::EstimateRareEvent(experiment, trials.AsRun(), options);
  trials.End();
  files::WriteFile(folder / "rare_event.json", report::RareEventJson(event, options));
  return fmt::format("\nrare event: {}\n", report::RareEventSentence(event));
}

void AddExplainFlags(CLI::App& app, ExplainRequest& request) {
  app.add_option(
         "--suggest", request.suggest,
         "suggest up to N experiments on the robot, print what each would decide and write them "
         "to DIR/suggested.yaml, which rift drive --suggested DIR drives")
      ->type_name("N")
      ->check(CLI::Range(1, 1000));
  app.add_option("--shrink", request.shrink,
                 "bring a failing row of table.csv down to the fewest and smallest changes from "
                 "the experiment's own values that still fail, by further trials")
      ->type_name("ROW|worst");
  app.add_flag("--rare-event", request.rare_event,
               "estimate a small failure probability over the space by further trials (subset "
               "simulation)");
}

void CheckRequest(const ExplainRequest& request, const experiment::Experiment& experiment) {
  const bool costs_trials = !request.shrink.empty() || request.rare_event;
  if (!costs_trials) return;
  const char* flag = request.rare_event ? "--rare-event" : "--shrink";
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(
        fmt::format("{} drives further trials, and candidate.kind is logs: recorded runs cannot be "
                    "driven at other settings; set candidate.kind=simulation",
                    flag));
  }
  if (experiment.space.parameters.empty()) {
    throw std::invalid_argument(fmt::format(
        "{} needs a space: name the parameters to vary, such as space.v_min: [0.15, 0.2]", flag));
  }
  const bool is_row = !request.shrink.empty() &&
                      request.shrink.find_first_not_of("0123456789") == std::string::npos;
  if (!request.shrink.empty() && request.shrink != "worst" && !is_row) {
    throw std::invalid_argument(
        fmt::format("--shrink {}: must be the id of a row in table.csv (a whole number), or worst",
                    request.shrink));
  }
}

sweep::ExplainOptions OptionsFor(const ExplainRequest& request) {
  sweep::ExplainOptions options = request.options;
  if (request.suggest > 0) options.suggest.experiments = request.suggest;
  return options;
}

bool SpendTrials(const std::filesystem::path& folder, const sweep::SweepResult& result,
                 const ExplainRequest& request, sweep::Evaluator& evaluator,
                 const FurtherTrials::Style& style, bool is_silent) {
  const bool is_asked = !request.shrink.empty() || request.rare_event;
  if (!is_asked) return true;
  const experiment::Experiment& experiment = evaluator.experiment();
  const terminal::StopSignal stop;
  const sweep::Facts facts = FactsOf(experiment);
  sweep::Journal journal(folder / kJournalName, facts);
  Elsewhere elsewhere(evaluator, facts, style, stop);
  if (!elsewhere.Resume(folder, journal)) return false;
  FurtherTrials trials(evaluator, style, stop, journal);
  std::string text;
  try {
    if (!request.shrink.empty()) {
      const int index = sweep::FailingRow(result, request.shrink);
      const sweep::TrialRequest row = RequestOf(result.rows[static_cast<size_t>(index)]);
      trials.AskFor(elsewhere.Bringing(
          {.kind = sweep::ShardKind::kShrink, .requests = {sweep::EncodeRequest(row)}}));
      text +=
          ShrinkInto(folder, experiment, result, request.shrink, request.shrink_options, trials);
    }
    if (request.rare_event) {
      trials.AskFor(elsewhere.Bringing({.kind = sweep::ShardKind::kRareEvent}));
      text += RareEventInto(folder, experiment, request.rare_event_options, trials);
    }
  } catch (const FurtherTrials::Stopped&) {
    journal.Close();
    return false;
  }
  journal.SetNote("state", "done");
  journal.Close();
  if (!is_silent) terminal::PrintText(text);
  return true;
}

}  // namespace rift::commands
