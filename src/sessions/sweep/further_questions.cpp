#include "rift/sessions/sweep/further_questions.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "cluster.hpp"
#include "further_trials.hpp"
#include "rift/files/files.hpp"
#include "rift/report/json/json.hpp"
#include "rift/sessions/sweep/journal.hpp"
#include "rift/sweep/falsify/settings.hpp"

namespace rift::sessions {

namespace {

/// Trials of a cluster, where there is one.
class Elsewhere {
 public:
  /// All must outlive this.
  Elsewhere(sweep::Evaluator& evaluator, const sweep::Facts& facts,
            const sweep::SlurmOptions* options, const SweepObserver& observer, const GoOn& go_on) {
    if (options != nullptr) cluster_.emplace(evaluator, facts, *options, observer, go_on);
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

sweep::ShrunkRow ShrinkInto(const std::filesystem::path& folder,
                            const experiment::Experiment& experiment,
                            const sweep::SweepResult& result, int row, FurtherTrials& trials) {
  sweep::ShrunkRow found = sweep::ShrinkRow(experiment, result, row, {}, trials.AsRun());
  sweep::SweepResult table = sweep::EmptyResult(experiment);
  table.rows = found.rows;
  const std::filesystem::path shrunk = folder / "shrunk";
  files::WriteFile(shrunk / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(shrunk / "table.csv", report::TableCsv(table));
  files::WriteFile(folder / "shrunk.json", report::ShrunkJson(result, found, shrunk.string()));
  return found;
}

sweep::RareEvent RareEventInto(const std::filesystem::path& folder,
                               const experiment::Experiment& experiment, FurtherTrials& trials) {
  const sweep::RareEventOptions options;
  trials.Begin(options.replicas * options.samples_per_level * options.most_levels);
  sweep::RareEvent event = sweep::EstimateRareEvent(experiment, trials.AsRun(), options);
  trials.End();
  files::WriteFile(folder / "rare_event.json", report::RareEventJson(event, options));
  return event;
}

}  // namespace

void FurtherQuestions::Check(const experiment::Experiment& experiment) const {
  if (!Any()) return;
  const char* flag = rare_event ? "--rare-event" : "--shrink";
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
  const bool is_row = shrink.find_first_not_of("0123456789") == std::string::npos;
  if (is_row || shrink == "worst") return;
  throw std::invalid_argument(fmt::format(
      "--shrink {}: must be the id of a row in table.csv (a whole number), or worst", shrink));
}

std::optional<FurtherAnswers> Answer(const FurtherQuestions& questions,
                                     const std::filesystem::path& folder,
                                     const sweep::SweepResult& result, sweep::Evaluator& evaluator,
                                     const FurtherRun& run, const SweepObserver& observer) {
  FurtherAnswers answers;
  if (!questions.Any()) return answers;
  const experiment::Experiment& experiment = evaluator.experiment();
  const GoOn go_on = observer.watch_for_stop();
  const sweep::Facts facts = FactsOf(experiment);
  sweep::Journal journal(folder / kJournalName, facts);
  Elsewhere elsewhere(evaluator, facts, run.cluster, observer, go_on);
  if (!elsewhere.Resume(folder, journal)) return std::nullopt;
  FurtherTrials trials(evaluator, run.jobs, observer, go_on, journal);
  try {
    if (!questions.shrink.empty()) {
      const int row = sweep::FailingRow(result, questions.shrink);
      const std::string failing =
          sweep::EncodeRequest(sweep::RequestOf(result.rows[static_cast<size_t>(row)]));
      trials.AskFor(elsewhere.Bringing({.kind = sweep::ShardKind::kShrink, .requests = {failing}}));
      answers.shrunk = ShrinkInto(folder, experiment, result, row, trials);
    }
    if (questions.rare_event) {
      trials.AskFor(elsewhere.Bringing({.kind = sweep::ShardKind::kRareEvent}));
      answers.rare_event = RareEventInto(folder, experiment, trials);
    }
  } catch (const FurtherTrials::Stopped&) {
    journal.Close();
    return std::nullopt;
  }
  journal.SetNote("state", "done");
  journal.Close();
  return answers;
}

}  // namespace rift::sessions
