// Runs of the experiment's own values as references: which seeds have one, what takes the place of
// those that fail.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

#include "program_side.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/worker_pool.hpp"
#include "simulated_recording.hpp"

namespace rift::sweep {

using experiment::CandidateKind;
using experiment::ReferenceKind;

/// The nominal run depends on the trial alone, and every setting is held against it.
const Recording& Evaluator::Nominal(std::uint64_t seed) {
  constexpr size_t kMostKept = 1000;
  const auto found = nominal_runs_.find(seed);
  if (found != nominal_runs_.end()) return found->second;
  if (nominal_runs_.size() >= kMostKept) nominal_runs_.clear();
  if (candidate_program_) {
    const TrialRequest nominal{.theta = experiment::NominalTheta(experiment_),
                               .trial = experiment_.reference.trials.names.front(),
                               .seed = seed};
    return nominal_runs_[seed] = candidate_program_->Run(nominal);
  }
  const geometry::Pose2 start = experiment::TaskOf(experiment_).Start();
  const SimulatedTrial trial = TrialOf(experiment_, start, seed);
  return nominal_runs_[seed] = RecordingOf(Simulate(trial), trial);
}

std::uint64_t Evaluator::SeedWithReference(std::uint64_t seed) {
  constexpr std::uint64_t kMostTries = 50;
  if (experiment_.reference.kind != ReferenceKind::kNominal) return seed;
  if (const auto known = used_.find(seed); known != used_.end()) return known->second;
  std::uint64_t used = seed;
  for (std::uint64_t i = 1; Nominal(used).status != TrialStatus::kOk && i <= kMostTries; ++i) {
    used = FreshSeed(seed, i);
  }
  return used_[seed] = used;
}

std::string Evaluator::ReplacedText(int seeds) {
  ByteWriter write;
  const std::optional<std::uint64_t> first = FirstSeed(experiment_);
  for (int i = 0; i < seeds; ++i) {
    const std::uint64_t seed = *first + static_cast<std::uint64_t>(i);
    const std::uint64_t used = SeedWithReference(seed);
    if (Nominal(used).status != TrialStatus::kOk) used_[seed] = seed;
    write(seed);
    write(used_[seed]);
    write(Nominal(seed).reason);
  }
  return write.Take();
}

std::vector<ReplacedReference> Evaluator::CheckReferences() {
  const bool is_run = experiment_.reference.kind == ReferenceKind::kNominal &&
                      experiment_.candidate.kind != CandidateKind::kLogs;
  if (!is_run) return {};
  int seeds = static_cast<int>(experiment_.reference.trials.names.size());
  const bool is_repeated = experiment_.falsify.repeat == Repeat::kEvery ||
                           experiment_.goal == experiment::Goal::kFalsify;
  if (is_repeated) seeds = std::max(seeds, std::min(experiment_.falsify.most_repeats, 100));
  JobResult found{.end = JobEnd::kThrew};
  RunOptions options = experiment_.run;
  options.timeout_s *= 2.0 * seeds;
  WorkerPool([&](const std::string&) { return ReplacedText(seeds); }, 1, options)
      .Run({1, [](int) { return std::string(); },
            [&](int, const JobResult& result) { found = result; }, [] { return true; }});
  if (found.end != JobEnd::kDone) return {};  // its trials are rows that say why
  ByteReader read(found.bytes);
  std::vector<ReplacedReference> replaced;
  while (!read.IsAtEnd()) {
    ReplacedReference reference;
    read(reference.seed);
    read(reference.used);
    read(reference.reason);
    used_[reference.seed] = reference.used;
    if (!reference.reason.empty()) replaced.push_back(reference);
  }
  for (const ReplacedReference& reference : replaced) {
    if (reference.used != reference.seed) continue;
    throw std::invalid_argument(fmt::format(
        "{}: reference.kind is nominal, and the run with the experiment's own values does not "
        "arrive, with seed {} nor with 50 others: {}",
        experiment_file_, reference.seed, reference.reason));
  }
  return replaced;
}

double Evaluator::NominalNoiseFloor_m() {
  const auto floor_m = [this](const std::string&) {
    std::vector<trajectory::Trajectory> runs;
    for (const TrialRequest& request : TrialsAt(experiment_, {})) {
      const Recording& run = Nominal(SeedWithReference(request.seed.value_or(experiment_.seed)));
      if (run.status == TrialStatus::kOk) runs.push_back(run.trajectory);
    }
    return fmt::format("{}", gap::NoiseFloor_m(runs, experiment_.gap));
  };
  double result_m = gap::kNotComputed;
  RunOptions options = experiment_.run;
  options.timeout_s *= static_cast<double>(experiment_.reference.trials.names.size());
  WorkerPool(floor_m, 1, options)
      .Run({1, [](int) { return std::string(); },
            [&](int, const JobResult& result) {
              if (result.end == JobEnd::kDone)
                result_m = std::strtod(result.bytes.c_str(), nullptr);
            },
            [] { return true; }});
  return result_m;
}

}  // namespace rift::sweep
