// What a trial of somebody else's simulator costs beside the same work done here. The program is
// rift's own way of running one (see docs/programs.md), in /bin/sh, which starts in a millisecond.
// Counters, each from runs in turn in this process: overhead_ms of a persistent trial is its time
// less that of the work its trajectory takes when it is in memory (target: below 2);
// times_own_start of a spawned trial is its time over that of the bare program, started by
// posix_spawn and waited for (target: below 1.5 for a simulator that starts in 50 ms, such as
// Python). `start_ms` says what the bare program took.
#include <benchmark/benchmark.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sweep/falsify/compare_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "support/inputs/paths.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using experiment::CandidateKind;
using experiment::ReferenceKind;

double WallSeconds() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

const std::string kScript = test::SourceDir() + "/configs/programs/diff_drive.py";

sweep::Inputs Files() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string&) {}};
}

/// The experiment of configs/programs/diff_drive.yaml with that program, against a straight path.
experiment::Experiment Plan(std::vector<std::string> run, bool persistent) {
  experiment::Experiment plan;
  plan.candidate.kind = CandidateKind::kProgram;
  plan.candidate.run.words = std::move(run);
  plan.candidate.persistent = persistent;
  plan.candidate.columns = "t=time,x=pose_x,y=pose_y,yaw=theta";
  plan.candidate.units = "mm";
  plan.reference.kind = ReferenceKind::kPath;
  plan.waypoints = {{.name = "a", .x_m = 0.0, .y_m = 0.0, .heading_deg = 0.0},
                    {.name = "b", .x_m = 0.6, .y_m = 0.25, .stop = true}};
  plan.space.parameters = {{.key = "mu", .min = 0.02, .max = 1.0},
                           {.key = "mismatch", .min = -0.3, .max = 0.3}};
  return plan;
}

sweep::TrialRequest Request(std::uint64_t seed) {
  return {.theta = {{"0.8", 0.8}, {"0.05", 0.05}}, .trial = "1", .seed = seed};
}

void RequireOk(const sweep::TrialRow& row) {
  if (!row.IsOk()) throw std::runtime_error("the trial has no gap: " + row.reason);
}

/// A program that answers each line at once with the same log, as a simulator without any work of
/// its own would.
std::string EchoingProgram(const std::filesystem::path& folder, const std::string& log_json) {
  const std::string answer = (folder / "answer.json").string(),
                    script = (folder / "echo.sh").string();
  std::ofstream(answer) << "{\"status\": \"ok\", \"log\": " << log_json << "}\n";
  std::ofstream(script) << "answer=$(cat '" << answer << "')\n"
                        << "while read -r line; do printf '%s\\n' \"$answer\"; done\n";
  return script;
}

std::string Log(const std::filesystem::path& folder) {
  const std::string out = (folder / "log.csv").string();
  const std::string command =
      "python3 '" + kScript + "' --mu 0.8 --mismatch 0.05 --seed 1 --out '" + out + "'";
  if (std::system(command.c_str()) != 0) throw std::runtime_error("python3 is needed");
  return files::ReadFile(out);
}

std::string AsJson(const std::string& text) {
  std::string json = "\"";
  for (const char c : text) c == '\n' ? json += "\\n" : json += c;
  return json + "\"";
}

/// The in-process trial: the same log read and held against the same reference.
sweep::TrialRow TrialHere(const experiment::Experiment& plan, sweep::Evaluator& evaluator,
                          const std::string& log) {
  const trajectory::ReadOptions read{.columns = plan.candidate.columns,
                                     .units = plan.candidate.units};
  const sweep::Recording run{.source = "log",
                             .trajectory = sweep::ReadMovedLog(log, "log", {read}).trajectory};
  return sweep::CompareTrial(plan, Request(1), run, evaluator.Reference(Request(1)));
}

class Folder {
 public:
  Folder() { std::filesystem::create_directories(path_); }
  ~Folder() { std::filesystem::remove_all(path_); }
  const std::filesystem::path& Path() const { return path_; }

 private:
  std::filesystem::path path_ = std::filesystem::temp_directory_path() /
                                ("rift_program_benchmark_" + std::to_string(::getpid()));
};

void Persistent(benchmark::State& state) {
  const Folder folder;
  const std::string log = Log(folder.Path());
  const experiment::Experiment plan =
      Plan({"/bin/sh", EchoingProgram(folder.Path(), AsJson(log))}, true);
  sweep::Evaluator evaluator(plan, "benchmark", Files());
  RequireOk(evaluator.Evaluate(Request(1)));  // its start is paid once
  double program_s = 0.0, here_s = 0.0;
  std::uint64_t seed = 1;
  for ([[maybe_unused]] auto _ : state) {  // in turn, so that both see the same machine
    const double begin_s = WallSeconds();
    RequireOk(evaluator.Evaluate(Request(++seed)));
    const double between_s = WallSeconds();
    RequireOk(TrialHere(plan, evaluator, log));
    program_s += between_s - begin_s;
    here_s += WallSeconds() - between_s;
  }
  const auto trials = static_cast<double>(state.iterations());
  state.counters["here_ms"] = 1e3 * here_s / trials;
  state.counters["overhead_ms"] = 1e3 * (program_s - here_s) / trials;
}
BENCHMARK(Persistent)->Unit(benchmark::kMillisecond)->Iterations(500);

/// Seconds that the program takes when nobody looks after it.
double BareRun_s(const std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const double begin_s = WallSeconds();
  pid_t child = 0;
  int status = 0;
  if (::posix_spawnp(&child, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0 ||
      ::waitpid(child, &status, 0) != child || status != 0) {
    throw std::runtime_error("python3 is needed");
  }
  return WallSeconds() - begin_s;
}

void Spawned(benchmark::State& state) {
  const Folder folder;
  const std::vector<std::string> head{"python3", kScript, "--mu", "0.8", "--mismatch", "0.05"};
  std::vector<std::string> asked = head, bare = head;
  for (const char* word : {"--seed", "{seed}", "--out", "{out}"}) asked.emplace_back(word);
  for (const std::string& word : {std::string("--seed"), std::string("1"), std::string("--out"),
                                  (folder.Path() / "bare.csv").string()}) {
    bare.push_back(word);
  }
  const experiment::Experiment plan = Plan(asked, false);
  sweep::Evaluator evaluator(plan, "benchmark", Files());
  double trial_s = 0.0, bare_s = 0.0;
  std::uint64_t seed = 0;
  for ([[maybe_unused]] auto _ : state) {
    bare_s += BareRun_s(bare);
    const double begin_s = WallSeconds();
    RequireOk(evaluator.Evaluate(Request(++seed)));
    trial_s += WallSeconds() - begin_s;
  }
  state.counters["start_ms"] = 1e3 * bare_s / static_cast<double>(state.iterations());
  state.counters["times_own_start"] = trial_s / bare_s;
}
BENCHMARK(Spawned)->Unit(benchmark::kMillisecond)->Iterations(50);

}  // namespace
}  // namespace rift

BENCHMARK_MAIN();
