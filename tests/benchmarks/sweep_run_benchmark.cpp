// The coordinator of a sweep: what it costs beside its trials, and what a second worker brings.
// Counters: coordinator_share is the coordinator's CPU time over that of trials of 10 ms (target:
// below 0.03), which a busy machine does not change; speed_up is trials/s with two workers over
// trials/s with one (target: 1.9), which wants an idle one.
#include <benchmark/benchmark.h>
#include <time.h>

#include <chrono>
#include <filesystem>

#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/grid.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "rift/sweep/falsify/trial_runner.hpp"
#include "rift/sweep/run/journal.hpp"
#include "support/paper_waypoints.hpp"
#include "support/paths.hpp"

namespace rift {
namespace {

double CpuSeconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double WallSeconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

std::vector<sweep::TrialRequest> Requests(int count) {
  std::vector<sweep::TrialRequest> requests;
  for (int i = 0; i < count; ++i) {
    requests.push_back({{{"ground", {}}, {"0.15", 0.15}}, "1", static_cast<std::uint64_t>(i)});
  }
  return requests;
}

/// A row such as a simulated trial gives, after 10 ms of work.
sweep::TrialRow TenMilliseconds(const sweep::TrialRequest& request) {
  static const experiment::Experiment plan;
  const double end_s = CpuSeconds() + 0.01;
  const sweep::Recording path{.source = "path", .trajectory = test::StraightPath(0.7, 40)};
  sweep::TrialRow row = sweep::CompareTrial(plan, request, path, path);
  while (CpuSeconds() < end_s) {
  }
  return row;
}

sweep::TrialRow PaperTask(const sweep::TrialRequest& request) {
  sweep::SimulatedTrial trial;
  trial.task = test::PaperWaypoints();
  trial.start = trial.task.Start();
  trial.seed = *request.seed;
  benchmark::DoNotOptimize(sweep::Simulate(trial));
  return {.theta = request.theta, .trial = request.trial, .seed = request.seed};
}

std::string KeyOf(const sweep::TrialRequest& request) {
  return "surface=ground v_min=0.15 trial=1 seed=" + std::to_string(*request.seed);
}

struct Cost {
  double wall_s = 0.0;
  double coordinator_s = 0.0;
};

Cost CostOf(const sweep::Evaluate& evaluate, int trials, int workers) {
  const auto file = std::filesystem::temp_directory_path() / "rift_sweep_run_benchmark.sqlite";
  sweep::Journal::Remove(file);
  sweep::Journal journal(file, {});
  sweep::TrialRunner runner(evaluate, KeyOf, &journal, workers, {}, {});
  const double wall_s = WallSeconds(), cpu_s = CpuSeconds();
  runner.Run(Requests(trials));
  return {WallSeconds() - wall_s, CpuSeconds() - cpu_s};
}

void Coordinator(benchmark::State& state) {
  constexpr int kTrials = 300;
  double coordinator_s = 0.0, trials_s = 0.0;
  for ([[maybe_unused]] auto _ : state) {
    coordinator_s += CostOf(TenMilliseconds, kTrials, 2).coordinator_s;
    trials_s += 0.01 * kTrials;
  }
  state.counters["coordinator_share"] = coordinator_s / trials_s;
}
BENCHMARK(Coordinator)->Unit(benchmark::kMillisecond)->Iterations(3);

void SecondWorker(benchmark::State& state) {
  constexpr int kTrials = 200;
  double one_s = 0.0, two_s = 0.0;
  for ([[maybe_unused]] auto _ : state) {  // in turn, so that both see the same machine
    one_s += CostOf(PaperTask, kTrials, 1).wall_s;
    two_s += CostOf(PaperTask, kTrials, 2).wall_s;
  }
  state.counters["trials_per_s_1"] = kTrials * static_cast<double>(state.iterations()) / one_s;
  state.counters["trials_per_s_2"] = kTrials * static_cast<double>(state.iterations()) / two_s;
  state.counters["speed_up"] = one_s / two_s;
}
BENCHMARK(SecondWorker)->Unit(benchmark::kMillisecond)->Iterations(4);

}  // namespace
}  // namespace rift

BENCHMARK_MAIN();
