// The gap against the numpy script beside this file, as ratios from one run:
//   BM_GapInProcess      one gap of two 80-row logs; counter numpy_over_rift
//   BM_GapWholeProcess   `rift gap SIM REAL` against the script, 80 and 1e5 rows, in turn
#include <benchmark/benchmark.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/gap/comparison.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paths.hpp"
#include "support/processes/process.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

const std::string kScript = test::SourceDir() + "/tests/benchmarks/gap_baseline.py";

/// Two logs of `rows` rows with the columns that rift writes.
struct Logs {
  explicit Logs(int rows) {
    std::mt19937_64 generator(1);
    sim = test::RandomPath(generator, rows);
    real = test::RandomPath(generator, rows);
    for (auto* path : {&sim, &real}) {
      for (trajectory::StampedPose& pose : path->poses) {
        pose.z_m = pose.roll_rad = pose.pitch_rad = 0.01;
        pose.target_x_m = pose.target_y_m = 0.3832;
      }
    }
    test::WriteText(folder / "sim.csv", trajectory::WriteRift(sim));
    test::WriteText(folder / "real.csv", trajectory::WriteRift(real));
    files = " " + (folder / "sim.csv") + " " + (folder / "real.csv");
  }
  test::TemporaryFolder folder;
  trajectory::Trajectory sim, real;
  std::string files;
};

/// Wall clock of a whole process, its output thrown away; no shell in between.
double Seconds(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  const auto begin = std::chrono::steady_clock::now();
  pid_t pid = 0;
  int status = -1;
  if (posix_spawn(&pid, argv[0], &actions, nullptr, argv.data(), environ) == 0) {
    waitpid(pid, &status, 0);
  }
  const auto end = std::chrono::steady_clock::now();
  posix_spawn_file_actions_destroy(&actions);
  if (status != 0) throw std::runtime_error("failed: " + words[0]);
  return std::chrono::duration<double>(end - begin).count();
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

double NumpyMicroseconds(const Logs& logs) {
  FILE* script = popen(("/usr/bin/python3 " + kScript + " --time" + logs.files).c_str(), "r");
  double microseconds = 0.0;
  if (script == nullptr || std::fscanf(script, "%lf", &microseconds) != 1 || pclose(script) != 0) {
    throw std::runtime_error("the baseline needs the packages python3 and python3-numpy");
  }
  return microseconds;
}

void BM_GapInProcess(benchmark::State& state) {
  const Logs logs(80);
  std::vector<double> seconds;
  for (auto _ : state) {
    const auto begin = std::chrono::steady_clock::now();
    benchmark::DoNotOptimize(gap::Gap(logs.sim, logs.real, {}));
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
  }
  state.counters["numpy_over_rift"] = NumpyMicroseconds(logs) / (1e6 * Median(seconds));
}
BENCHMARK(BM_GapInProcess)->Unit(benchmark::kMicrosecond);

void BM_CompareInProcess(benchmark::State& state) {
  const Logs logs(80);
  for (auto _ : state) benchmark::DoNotOptimize(gap::Compare(logs.sim, logs.real, {}));
}
BENCHMARK(BM_CompareInProcess)->Unit(benchmark::kMicrosecond);

void BM_GapWholeProcess(benchmark::State& state) {
  const Logs logs(static_cast<int>(state.range(0)));
  const std::string sim = logs.folder / "sim.csv", real = logs.folder / "real.csv";
  const std::vector<std::string> rift{test::RiftBinary(), "gap", sim, real};
  const std::vector<std::string> numpy{"/usr/bin/python3", kScript, sim, real};
  std::vector<double> ratios;
  for (auto _ : state) {
    const double rift_s = Seconds(rift);
    state.SetIterationTime(rift_s);
    ratios.push_back(Seconds(numpy) / rift_s);
  }
  state.counters["numpy_over_rift"] = Median(ratios);
}
BENCHMARK(BM_GapWholeProcess)
    ->Arg(80)
    ->Arg(100'000)
    ->Iterations(15)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rift

BENCHMARK_MAIN();
