// A whole trial of the paper's task - controller, radio, camera, log, true path - against the bare
// physics of the same steps, in turn in one process. Counter trial_over_physics: the target
// is 1.15.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <vector>

#include "rift/simulation/ode_world.hpp"
#include "rift/sweep/falsify/simulated_trial.hpp"
#include "support/inputs/paper_waypoints.hpp"

namespace rift {
namespace {

using Clock = std::chrono::steady_clock;

double Since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

sweep::SimulatedTrial PaperTrial() {
  sweep::SimulatedTrial trial;
  trial.task = test::PaperWaypoints();
  trial.start = trial.task.Start();
  return trial;
}

/// The same world for as long, its motors driven by nothing but their own torque lines.
double PhysicsSeconds(const sweep::SimulatedTrial& trial, const sweep::SimulatedRun& run) {
  const simulation::SimulationOptions& options = trial.simulation;
  const auto begin = Clock::now();
  simulation::OdeWorld world(options.body, simulation::Terrain(options.terrain), trial.start,
                             options.step_s);
  simulation::Motor left(options.motor, simulation::Side::kLeft);
  simulation::Motor right(options.motor, simulation::Side::kRight);
  const int steps = static_cast<int>(run.result.end_s / options.step_s);
  const auto power = simulation::StepPower::Constant(0.17);
  for (int i = 0; i < steps; ++i) {
    const auto& rate_rad_s = world.State().wheel_rate_rad_s;
    world.Step({left.Drive(power, rate_rad_s[0], 0.0, options.step_s),
                right.Drive(power, rate_rad_s[1], 0.0, options.step_s)});
  }
  benchmark::DoNotOptimize(world.State());
  return Since(begin);
}

void BM_PaperTrial(benchmark::State& state) {
  const sweep::SimulatedTrial trial = PaperTrial();
  std::vector<double> ratios;
  for (auto _ : state) {
    const auto begin = Clock::now();
    const sweep::SimulatedRun run = sweep::Simulate(trial);
    const double trial_s = Since(begin);
    state.SetIterationTime(trial_s);
    ratios.push_back(trial_s / PhysicsSeconds(trial, run));
  }
  std::nth_element(ratios.begin(), ratios.begin() + ratios.size() / 2, ratios.end());
  state.counters["trial_over_physics"] = ratios[ratios.size() / 2];
}
BENCHMARK(BM_PaperTrial)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rift

BENCHMARK_MAIN();
