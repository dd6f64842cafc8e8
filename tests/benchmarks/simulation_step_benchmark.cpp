// One step of the robot against the same robot built from ODE's cylinders, and the error of each
// against its own run at a quarter of a millisecond. Both in one process, on the same weave.

#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>
#include <vector>

#include "benchmarks/cylinder_wheel_world.hpp"
#include "rift/simulation/ode_world.hpp"

namespace rift::benchmarks {
namespace {

constexpr double kDuration_s = 3.0;
constexpr double kReferenceStep_s = 0.00025;

enum class Sampling { kRamped, kStepped };

/// Wheel rates of three seconds of weaving at up to 0.24 m/s, from rest.
std::array<double, 2> Rates(double t_s) {
  const double rise = t_s < 0.5 ? 0.5 * (1.0 - std::cos(2.0 * M_PI * t_s)) : 1.0;
  const double turn = 3.0 * std::sin(2.0 * M_PI * 0.8 * t_s);
  return {rise * (15.0 - turn), rise * (15.0 + turn)};
}

std::array<double, 2> Sampled(double t_s, double step_s, Sampling sampling) {
  const auto from = Rates(t_s), to = Rates(t_s + step_s);
  if (sampling == Sampling::kStepped) return from;
  return {0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])};
}

/// One contact for each wheel: the robot of rift.
class HandMade {
 public:
  explicit HandMade(double step_s)
      : world_(simulation::BodyOptions{}, simulation::Terrain(simulation::TerrainOptions{}), {},
               step_s) {}
  void Step(const std::array<double, 2>& rates) {
    constexpr double kAnyTorque = std::numeric_limits<double>::infinity();
    world_.Step({simulation::WheelDrive{rates[0], 0.0, kAnyTorque},
                 simulation::WheelDrive{rates[1], 0.0, kAnyTorque}});
  }
  Eigen::Vector2d Position_m() const { return world_.State().position_m.head<2>(); }

 private:
  simulation::OdeWorld world_;
};

/// Positions at every 16 ms of the weave.
template <class World>
std::vector<Eigen::Vector2d> Weave(double step_s, Sampling sampling) {
  World world(step_s);
  std::vector<Eigen::Vector2d> path;
  const int every = static_cast<int>(std::lround(0.016 / step_s));
  const int steps = static_cast<int>(std::lround(kDuration_s / 0.016)) * every;
  for (int i = 0; i < steps; ++i) {
    world.Step(Sampled(i * step_s, step_s, sampling));
    if ((i + 1) % every == 0) path.push_back(world.Position_m());
  }
  return path;
}

template <class World>
double Error_mm(double step_s, Sampling sampling) {
  static const std::vector<Eigen::Vector2d> reference =
      Weave<World>(kReferenceStep_s, Sampling::kRamped);
  const std::vector<Eigen::Vector2d> path = Weave<World>(step_s, sampling);
  double largest_m = 0.0;
  for (size_t i = 0; i < path.size(); ++i) {
    largest_m = std::max(largest_m, (path[i] - reference[i]).norm());
  }
  return 1e3 * largest_m;
}

template <class World>
void Step(benchmark::State& state) {
  const double step_s = 1e-6 * static_cast<double>(state.range(0));
  World world(step_s);
  double t_s = 0.0;
  for (auto _ : state) {
    world.Step(Sampled(t_s, step_s, Sampling::kRamped));
    t_s += step_s;
  }
}

template <class World>
void Trial(benchmark::State& state) {
  const double step_s = 1e-6 * static_cast<double>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(Weave<World>(step_s, Sampling::kRamped));
  state.counters["ramped_mm"] = Error_mm<World>(step_s, Sampling::kRamped);
  state.counters["stepped_mm"] = Error_mm<World>(step_s, Sampling::kStepped);
}

BENCHMARK_TEMPLATE(Step, CylinderWheelWorld)->Arg(8000);
BENCHMARK_TEMPLATE(Step, HandMade)->Arg(8000);
BENCHMARK_TEMPLATE(Trial, CylinderWheelWorld)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Arg(8000)
    ->Arg(16000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(Trial, HandMade)
    ->Arg(1000)
    ->Arg(2000)
    ->Arg(4000)
    ->Arg(8000)
    ->Arg(16000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rift::benchmarks

BENCHMARK_MAIN();
