#include "search/run_until.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>

namespace rift::test {
namespace {

/// Of this process, whatever else the machine does.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

RunResult RunUntil(const Task& task, search::Method method, int budget, double target,
                   std::uint64_t seed) {
  search::SearchOptions options;
  options.strategy = method;
  const auto strategy = search::MakeStrategy(options, task.axes, budget, seed);
  RunResult run;
  while (run.evaluations < budget && !run.reached_at) {
    double begin = CpuSeconds();
    const std::vector<search::Point> points = strategy->Ask(budget - run.evaluations);
    run.overhead_s += CpuSeconds() - begin;
    if (points.empty()) break;
    std::vector<search::Evaluation> batch;
    for (const search::Point& point : points) {
      batch.push_back({point, task.loss(point)});
      ++run.evaluations;
      if (batch.back().loss < run.best) run.best = batch.back().loss;
      if (run.best <= target && !run.reached_at) run.reached_at = run.evaluations;
    }
    begin = CpuSeconds();
    strategy->Tell(batch);
    run.overhead_s += CpuSeconds() - begin;
  }
  return run;
}

Summary Summarise(const std::vector<RunResult>& runs) {
  Summary summary;
  double all = 0.0, of_successes = 0.0, asked = 0.0;
  std::vector<double> best;
  for (const RunResult& run : runs) best.push_back(run.best);
  std::sort(best.begin(), best.end());
  if (!best.empty()) summary.median_best = best[best.size() / 2];
  for (const RunResult& run : runs) {
    ++summary.runs;
    all += run.reached_at.value_or(run.evaluations);
    asked += run.evaluations;
    summary.overhead_ms += 1e3 * run.overhead_s;
    if (!run.reached_at) continue;
    ++summary.successes;
    of_successes += *run.reached_at;
  }
  summary.overhead_ms /= asked;
  if (summary.successes == 0) return summary;
  summary.mean = of_successes / summary.successes;
  summary.ert = all / summary.successes;
  return summary;
}

void PrintEach(const std::string& task, const std::string& strategy, int budget, int first_seed,
               const std::vector<RunResult>& runs) {
  for (size_t i = 0; i < runs.size(); ++i) {
    const std::string reached = runs[i].reached_at ? std::to_string(*runs[i].reached_at) : "-";
    fmt::print("{} {} {} seed {} reached {} of {} best {:.6g}\n", task, strategy, budget,
               first_seed + static_cast<int>(i), reached, runs[i].evaluations, runs[i].best);
  }
}

}  // namespace rift::test
