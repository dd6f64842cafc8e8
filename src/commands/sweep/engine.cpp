#include "engine.hpp"

#include <fmt/format.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "rift/commands/arguments/flags.hpp"
#include "rift/commands/arguments/inputs.hpp"
#include "rift/files/files.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/run/shard.hpp"
#include "rift/terminal/print.hpp"
#include "rift/yaml/bind.hpp"
#include "rift/yaml/load.hpp"

namespace rift::commands {

void AddEngineFlags(CLI::App& app, EngineRequest& request) {
  app.add_option("--engine", request.engine,
                 "where trials are run: local, slurm, or a file with a cluster's habits "
                 "(configs/engines/slurm.yaml); a grid as job arrays, a search, a calibration, "
                 "--shrink and --rare-event as one job each")
      ->type_name("local|slurm|FILE.yaml")
      ->capture_default_str();
  app.add_option("--partition", request.partition, "with --engine slurm: where its jobs go");
  app.add_option("--shards", request.shards,
                 "with --engine slurm: parts that a batch of trials is run in; the results are the "
                 "same for any [as many as last a minute each]")
      ->type_name("N")
      ->check(CLI::Range(1, 1'000'000));
  app.add_option(
         "--shard", request.shard,
         "run the trials of one shard into --out/shards: what the jobs of --engine slurm do")
      ->type_name("FILE");
  app.add_option("--copy-every", request.copy_every_s,
                 "with --shard: how often what is done is copied there")
      ->type_name("S")
      ->check(InRange(1.0, 86400.0))
      ->capture_default_str();
}

std::optional<sweep::SlurmOptions> ClusterOf(const EngineRequest& request) {
  if (request.engine == "local") {
    if (request.partition.empty() && request.shards == 0) return std::nullopt;
    throw std::invalid_argument(
        fmt::format("--{} is for --engine slurm", request.shards > 0 ? "shards" : "partition"));
  }
  sweep::SlurmOptions options;
  if (request.engine != "slurm") {
    const std::string file = FindInput(request.engine);
    if (!file.ends_with(".yaml")) {
      throw std::invalid_argument(
          fmt::format("--engine {}: must be local, slurm or a file such as "
                      "configs/engines/slurm.yaml",
                      request.engine));
    }
    yaml::Bind(yaml::Load(file, [](const std::string& path) { return files::ReadFile(path); }),
               options);
  }
  if (!request.partition.empty()) options.partition = request.partition;
  if (request.shards > 0) options.shards = request.shards;
  return options;
}

void CheckEngine(const experiment::Experiment& experiment, const std::string& experiment_file) {
  if (experiment.candidate.kind == experiment::CandidateKind::kLogs) {
    throw std::invalid_argument(fmt::format(
        "{}: candidate.kind is logs, which are compared here in seconds: leave --engine out",
        experiment_file));
  }
}

Cluster::Cluster(sweep::Evaluator& evaluator, const sweep::Facts& facts,
                 const sweep::SlurmOptions& options, ProgressStyle progress,
                 std::function<bool()> go_on)
    : evaluator_(evaluator),
      facts_(facts),
      options_(options),
      progress_(progress),
      go_on_(std::move(go_on)),
      experiment_(experiment::WriteExperiment(evaluator.experiment())) {}

bool Cluster::Resume(const std::filesystem::path& out, sweep::Journal& journal) {
  out_ = out;
  journal_ = &journal;
  shards_.emplace(
      out, options_, experiment_, journal,
      sweep::SlurmShards::Watch{[this](const sweep::ShardCounts& counts) { Tell(counts); }, go_on_,
                                [](const std::string& line) { terminal::Say(line); }});
  return shards_->Resume();
}

sweep::Shard Cluster::EmptyShard() const {
  return {.facts = sweep::HashOf(facts_), .experiment = statistics::Hash128Text(experiment_)};
}

bool Cluster::RunAsOne(sweep::Shard shard) {
  const sweep::Shard empty = EmptyShard();
  shard.facts = empty.facts;
  shard.experiment = empty.experiment;
  const std::filesystem::path start =
      sweep::UnfinishedShardJournal(out_, sweep::ShardName(sweep::EncodeShard(shard)));
  std::filesystem::create_directories(start.parent_path());
  std::filesystem::remove(start);
  journal_->CopyTo(start);
  return shards_->Run({shard});
}

std::optional<size_t> Cluster::ShardsFor(const std::vector<sweep::TrialRequest>& requests,
                                         std::vector<size_t>& missing, sweep::TrialRunner& runner) {
  if (options_.shards > 0) return options_.shards;
  constexpr size_t kProbed = 8;
  std::vector<sweep::TrialRequest> probed;
  for (size_t i = 0; i < std::min(kProbed, missing.size()); ++i) {
    probed.push_back(requests[missing[i]]);
  }
  const auto begun = std::chrono::steady_clock::now();
  sweep::TrialRunner here(
      [this](const sweep::TrialRequest& trial) { return evaluator_.Evaluate(trial); },
      [this](const sweep::TrialRequest& trial) { return evaluator_.KeyOf(trial); }, journal_, 1,
      evaluator_.experiment().run,
      {[](const sweep::TrialRow&, bool) {}, go_on_,
       [this](sweep::TrialRow& row) { evaluator_.NameSides(row); }});
  if (!here.Run(probed)) return std::nullopt;
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  missing = runner.Missing(requests);
  const double trial_s = took.count() / static_cast<double>(probed.size());
  const double work_s = trial_s * static_cast<double>(missing.size()) / options_.cpus_per_task;
  const double shards = std::min(work_s / options_.shard_s, double(options_.most_shards));
  return std::max<size_t>(1, static_cast<size_t>(shards));
}

bool Cluster::Run(const std::vector<sweep::TrialRequest>& requests, sweep::TrialRunner& runner) {
  std::vector<size_t> missing = runner.Missing(requests);
  if (missing.empty()) return true;
  if (evaluator_.experiment().goal == experiment::Goal::kFalsify) {
    // What was damaged on the way is run here.
    return std::exchange(has_run_sweep_, true) || RunAsOne({.kind = sweep::ShardKind::kSweep});
  }
  const std::optional<size_t> count = ShardsFor(requests, missing, runner);
  if (!count) return false;
  std::vector<sweep::Shard> shards;
  for (const std::vector<size_t>& part : sweep::DealOut(missing.size(), *count)) {
    sweep::Shard shard = EmptyShard();
    sweep::KeysHash keys;
    for (const size_t i : part) {
      const sweep::TrialRequest& request = requests[missing[i]];
      keys.Add(evaluator_.KeyOf(request));
      shard.requests.push_back(sweep::EncodeRequest(request));
      shard.paths += missing[i] < runner.PathsLeft();
    }
    shard.keys = keys.Text();
    shards.push_back(std::move(shard));
  }
  return shards_->Run(shards);
}

void Cluster::Tell(const sweep::ShardCounts& counts) {
  std::string text = fmt::format("slurm: {}/{} shards done, {} running, {} pending", counts.done,
                                 counts.total, counts.running, counts.pending);
  if (!counts.reason.empty()) text += fmt::format(" ({})", counts.reason);
  if (progress_ == ProgressStyle::kQuiet || text == told_) return;
  told_ = text;
  if (progress_ == ProgressStyle::kBar) {
    terminal::SayInPlace(text);
  } else if (progress_ == ProgressStyle::kLines) {
    terminal::Say(text);
  } else {
    terminal::Say(nlohmann::ordered_json{{"state", "running"},
                                         {"shards", counts.total},
                                         {"shards_done", counts.done},
                                         {"shards_running", counts.running},
                                         {"shards_pending", counts.pending}}
                      .dump());
  }
}

}  // namespace rift::commands
