#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "rift/files/files.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/candidate_runs.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/trajectory/log.hpp"
#include "support/inputs/paths.hpp"
#include "support/processes/process.hpp"
#include "sweep/calibrate/fitted_simulator.hpp"

namespace rift::sweep {

/// Somebody else's program, a line of awk, and logs to fit it to: a way of `k` metres that ends a
/// little to the left by the seed's last digit.
class Bench {
 public:
  explicit Bench(const std::string& before = "") {
    test::WriteText(folder_ / "sim.sh",
                    "echo \"$2 $3\" >> '" + folder_ / "asked" + "'\n" + before +
                        "\nawk -v k=\"$2\" -v s=\"$3\" 'BEGIN { print \"t_s,x_m,y_m,yaw_rad\"; "
                        "for (i = 0; i <= 40; ++i) print i / 20 \",\" k * i / 40 \",\" "
                        "0.001 * (s % 10) * i / 40 \",0\" }' > \"$1\"\n");
    experiment.goal = experiment::Goal::kCalibrate;
    experiment.seed = 30;
    experiment.candidate.kind = experiment::CandidateKind::kProgram;
    experiment.candidate.run.words = {"sh", folder_ / "sim.sh", "{out}", "{k}", "{seed}"};
    experiment.reference.kind = experiment::ReferenceKind::kLogs;
    experiment.reference.path.text = "{s}_{trial}.csv";
    experiment.reference.trials.names = {"1", "2"};
    experiment.space.parameters = {{.key = "s", .levels = {{"a", {}}, {"b", {}}}}};
    experiment.calibrate.fit.list = {{.key = "k", .min = 0.5, .max = 2.0, .start = 0.8}};
    experiment.calibrate.judge_runs = 2;
    experiment.calibrate.method.runs = 1;
    experiment.calibrate.method.iterations = 3;
    experiment.calibrate.method.corrections = 0;
    experiment.calibrate.method.resamples = 50;
    experiment.likeness.shuffles = 19;
    experiment.likeness.bootstrap.resamples = 50;
    for (const char* name : {"a_1.csv", "a_2.csv", "b_1.csv", "b_2.csv"}) {
      logs[name] = trajectory::WriteRift(test::Moved(test::StraightPath(1.2, 41), {0, 0, 0.001}));
    }
  }

  Inputs AsInputs() const {
    return {[this](const std::string& path) -> std::optional<std::string> {
              const auto found = logs.find(path);
              return found != logs.end() ? std::optional(found->second) : files::ReadIfThere(path);
            },
            [](const std::string&) {}};
  }
  /// What it was asked for since the last call, sorted: "k seed" a line.
  std::vector<std::string> Asked() const {
    std::vector<std::string> lines;
    if (!std::filesystem::exists(folder_ / "asked")) return lines;
    std::istringstream text(files::ReadFile(folder_ / "asked"));
    for (std::string line; std::getline(text, line);) lines.push_back(line);
    std::filesystem::remove(folder_ / "asked");
    std::sort(lines.begin(), lines.end());
    return lines;
  }

  experiment::Experiment experiment;
  std::map<std::string, std::string> logs;

 private:
  test::TemporaryFolder folder_;
};

inline const Say kSilent = [](const std::string&) {};

inline std::vector<CalibrationLog> Logs(const Bench& bench, double longest_m) {
  std::vector<CalibrationLog> logs;
  for (const char* name : {"a_1.csv", "b_1.csv"}) {
    logs.push_back(
        {.name = name,
         .setting = name,
         .log =
             trajectory::ReadLog(bench.logs.at(name), name, trajectory::Format::kRift).trajectory,
         .longest_m = longest_m});
  }
  return logs;
}

inline std::vector<TrialRequest> Requests() {
  return {{.theta = {{"a", {}}}, .trial = "1", .seed = 7},
          {.theta = {{"b", {}}}, .trial = "1", .seed = 500}};
}

/// Runs of the program beside those logs, as a fit asks for them.
struct BenchTwins {
  explicit BenchTwins(const Bench& bench)
      : evaluator(bench.experiment, "e.yaml", bench.AsInputs()),
        runs(evaluator, 1),
        twins(runs, Requests(), bench.experiment, "e.yaml", kSilent) {}

  Evaluator evaluator;
  CandidateRuns runs;
  ProgramTwins twins;
};

}  // namespace rift::sweep
