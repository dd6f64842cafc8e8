// What a minute of `rift drive --identify` tells beside waypoint drives: a simulated robot with
// planted values is driven both ways with all its noise, the logs of each are fitted to, and each
// fit predicts fresh waypoint drives of that robot. `truth`: its own values, the best there is.
//
//   excitation_study [--repeats N] [--first N] [--drives N] [--runs N] [--features N] [--threads N]
//                    [--beside N]
//
// A minute: the program's straights and its turns as drives of their own, each twice. --drives: of
// the whole program. --beside: how wide the intervals from so many waypoint logs are (the method of
// planted_study) with and without these drives, and nothing else.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "rift/experiment/experiment.hpp"
#include "rift/files/files.hpp"
#include "rift/gap/likeness.hpp"
#include "rift/sessions/drive/identification.hpp"
#include "rift/statistics/descriptive.hpp"
#include "rift/sweep/calibrate/calibration.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/frame_grid.hpp"
#include "support/tree.hpp"

namespace rift {
namespace {

using experiment::Experiment;
using trajectory::Trajectory;

constexpr int kTrials = 2;  // of each of the paper's 24 settings

/// A log, and the experiment whose trial it is, with the free parameters at its robot's values.
struct Drive {
  Experiment experiment;
  sweep::CalibrationLog log;
};

sweep::SimulatedTrial TrialOf(const Experiment& experiment, const geometry::Pose2& start,
                              std::uint64_t seed) {
  return sweep::SimulatedTrialOf(experiment, start, seed, "the study",
                                 {files::ReadIfThere, [](const std::string&) {}});
}

class Study {
 public:
  explicit Study(std::map<std::string, int> asked) : asked_(std::move(asked)) {
    robot_ = experiment::LoadExperiment(test::SourceDir() + "/configs/calibrate.yaml", {},
                                        files::ReadFile);
    robot_.simulation.terrain.surface = "ground";
    robot_.calibrate.fit.list.clear();
    // As `rift sweep` reads what `rift drive --identify` leaves: each fit starts at the robot's
    // values.
    const std::string text = experiment::WriteExperiment(sessions::IdentificationFit(robot_));
    const auto method = robot_.calibrate.method;
    robot_ =
        experiment::LoadExperiment("/study.yaml", {}, [&](const std::string&) { return text; });
    robot_.calibrate.method = method;
  }

  void Repeat(std::uint64_t repeat) {
    std::mt19937_64 random(repeat);
    const std::vector<double> truth = PlantOneThatArrives(random);
    if (asked_["--beside"] > 0) return Beside(repeat, truth, random);
    const std::vector<Drive> halves = Excite(truth, 2, true, random);
    const std::vector<Drive> program = Excite(truth, asked_["--drives"], false, random);
    const std::vector<Drive> table = DriveTable(truth, random);
    const std::vector<Drive> fresh = DriveTable(truth, random);

    sweep::CalibrationOptions options;  // of an identification, which has no other
    options.runs = 0;
    const sweep::Calibration minute = Fit(halves, options);
    const sweep::Calibration drives = Fit(program, options);
    options = robot_.calibrate.method;
    options.features = {.rounds = 2, .draws = asked_["--features"]};
    const sweep::Calibration logs = Fit(table, options);

    double minute_s = 0.0;
    for (const Drive& drive : halves) minute_s += drive.log.log.Duration_s();
    for (size_t i = 0; i < truth.size(); ++i) {
      const auto shown = [&](const sweep::Calibration& fit) {
        return Shown(fit.parameters[i], truth[i]);
      };
      fmt::print("{:>3} {:<38} {:.4f}; {:.0f} s: {}; {} whole drives: {}; {} logs: {}; {:.2f}\n",
                 repeat, robot_.calibrate.fit.list[i].key, truth[i], minute_s, shown(minute),
                 program.size(), shown(drives), table.size(), shown(logs),
                 Width(drives.parameters[i]) / Width(logs.parameters[i]));
    }
    const double own_m = MeanGap_m(fresh, truth);
    const double minute_m = MeanGap_m(fresh, ValuesOf(minute));
    const double drives_m = MeanGap_m(fresh, ValuesOf(drives));
    const double logs_m = MeanGap_m(fresh, ValuesOf(logs));
    const double start_m = MeanGap_m(fresh, Start());
    fmt::print(
        "{:>3} fresh drives, mm from the mean of {} runs: truth {:.1f}, start {:.1f}, a minute "
        "{:.1f}, {} drives {:.1f}, {} logs {:.1f}; a minute over logs {:.3f}\n",
        repeat, asked_["--runs"], 1e3 * own_m, 1e3 * start_m, 1e3 * minute_m, program.size(),
        1e3 * drives_m, table.size(), 1e3 * logs_m, minute_m / logs_m);
    std::fflush(stdout);
  }

 private:
  static double Width(const sweep::CalibratedParameter& found) { return found.high - found.low; }

  static std::string Shown(const sweep::CalibratedParameter& found, double truth) {
    const bool is_inside = found.low <= truth && truth <= found.high;
    return fmt::format("{:.4f} [{:.4f}, {:.4f}]{}{}", found.value, found.low, found.high,
                       is_inside ? "" : " OUT", found.is_identified ? "" : " flagged");
  }

  /// Waypoint logs, evenly over the settings, and the same ones with whole drives of the program.
  void Beside(std::uint64_t repeat, const std::vector<double>& truth, std::mt19937_64& random) {
    const std::vector<Drive> table = DriveTable(truth, random);
    const size_t count = std::min(static_cast<size_t>(asked_["--beside"]), table.size());
    std::vector<Drive> logs;
    for (size_t i = 0; i < count; ++i) logs.push_back(table[i * table.size() / count]);
    const std::vector<Drive> program = Excite(truth, asked_["--drives"], false, random);
    std::vector<Drive> both = logs;
    both.insert(both.end(), program.begin(), program.end());

    sweep::CalibrationOptions options;
    options.runs = 0;
    options.horizon.phases = 12;
    const sweep::Calibration of_logs = Fit(logs, options), of_both = Fit(both, options);
    const sweep::Calibration of_program = Fit(program, options);
    for (size_t i = 0; i < truth.size(); ++i) {
      fmt::print(
          "{:>3} {:<38} {:.4f}; {} logs: {}; and {} drives: {}, {:.2f} times as wide; drives "
          "alone: {}, {:.2f}\n",
          repeat, robot_.calibrate.fit.list[i].key, truth[i], logs.size(),
          Shown(of_logs.parameters[i], truth[i]), program.size(),
          Shown(of_both.parameters[i], truth[i]),
          Width(of_both.parameters[i]) / Width(of_logs.parameters[i]),
          Shown(of_program.parameters[i], truth[i]),
          Width(of_program.parameters[i]) / Width(of_logs.parameters[i]));
    }
    std::fflush(stdout);
  }

  std::vector<double> Start() const {
    std::vector<double> values;
    for (const auto& free : robot_.calibrate.fit.list) values.push_back(free.start);
    return values;
  }

  static std::vector<double> ValuesOf(const sweep::Calibration& fit) {
    std::vector<double> values;
    for (const auto& parameter : fit.parameters) values.push_back(parameter.value);
    return values;
  }

  /// The next robot that arrives in every setting: another has no table of real drives.
  std::vector<double> PlantOneThatArrives(std::mt19937_64& random) const {
    constexpr int kMostRobots = 20;
    for (int robots = 1;; ++robots) {
      std::vector<double> truth = Plant(random);
      try {
        DriveTable(truth, random);
        return truth;
      } catch (const std::runtime_error&) {
        if (robots == kMostRobots) throw;
      }
    }
  }

  /// Within the middle half of each range, which the fit's start may be far from.
  std::vector<double> Plant(std::mt19937_64& random) const {
    std::vector<double> values;
    for (const auto& free : robot_.calibrate.fit.list) {
      const double quarter = 0.25 * (free.max - free.min);
      values.push_back(
          std::uniform_real_distribution(free.min + quarter, free.max - quarter)(random));
    }
    return values;
  }

  /// Put down by hand.
  static geometry::Pose2 StartOf(const Experiment& experiment, std::mt19937_64& random) {
    std::normal_distribution<double> aside_m(0.0, 0.01), turned_rad(0.0, 0.03);
    geometry::Pose2 start = experiment::TaskOf(experiment).Start();
    start.x_m += aside_m(random);
    start.y_m += aside_m(random);
    start.yaw_rad += turned_rad(random);
    return start;
  }

  /// Driven until it arrives, as every log of a table of real drives did.
  Drive DriveOne(const Experiment& experiment, const std::vector<double>& truth,
                 const std::string& setting, std::mt19937_64& random) const {
    const Experiment real = experiment::CalibratedAt(experiment, truth);
    constexpr int kMostTries = 20;
    for (int tries = 0; tries < kMostTries; ++tries) {
      const geometry::Pose2 start = StartOf(real, random);
      sweep::SimulatedRun run = sweep::Simulate(TrialOf(real, start, random()));
      if (run.result.outcome != trial::Outcome::kReached) continue;
      const bool is_program = !experiment.program.segments.empty();
      return {experiment,
              {.name = setting,
               .setting = setting,
               .log = trajectory::OnFramesOf(std::move(run.result.trajectory),
                                             robot_.candidate.grid_fps),
               .drives_grid_fps = robot_.candidate.grid_fps,
               .began_s = is_program ? std::optional(0.0) : std::nullopt}};
    }
    throw std::runtime_error("the planted robot does not arrive: " + setting);
  }

  /// The program of an identification, whole or as two drives.
  std::vector<Drive> Excite(const std::vector<double>& truth, int times, bool in_halves,
                            std::mt19937_64& random) const {
    const Experiment whole = sessions::IdentificationDrive(robot_);
    std::vector<Experiment> programs{whole};
    if (in_halves) {
      const std::vector<control::Segment>& all = whole.program.segments;
      const auto middle = std::find_if(all.begin(), all.end(), [](const control::Segment& segment) {
        return segment.turn_deg.has_value();
      });
      programs.push_back(whole);
      programs[0].program.segments.assign(all.begin(), middle);
      programs[1].program.segments.assign(middle, all.end());
    }
    std::vector<Drive> drives;
    for (int i = 0; i < times; ++i) {
      for (const Experiment& program : programs) {
        drives.push_back(
            DriveOne(program, truth, fmt::format("program {}", drives.size()), random));
      }
    }
    return drives;
  }

  std::vector<Drive> DriveTable(const std::vector<double>& truth, std::mt19937_64& random) const {
    std::vector<Drive> drives;
    const auto& parameters = robot_.space.parameters;
    for (const experiment::Theta& theta : experiment::GridPoints(parameters)) {
      for (int trial = 0; trial < kTrials; ++trial) {
        drives.push_back(DriveOne(experiment::ExperimentAt(robot_, theta), truth,
                                  sweep::SettingKey(parameters, theta), random));
      }
    }
    return drives;
  }

  sweep::SimulatedTrial TwinOf(const Drive& drive, const std::vector<double>& values,
                               std::uint64_t seed) const {
    const Experiment at = experiment::CalibratedAt(drive.experiment, values);
    return TrialOf(at, sweep::StartFromLog(drive.log.log, 0.0, at.simulation.mocap), seed);
  }

  sweep::Calibration Fit(const std::vector<Drive>& drives,
                         const sweep::CalibrationOptions& options) {
    std::vector<sweep::CalibrationLog> logs;
    for (const Drive& drive : drives) logs.push_back(drive.log);
    const sweep::TwinAt twin = [&](size_t log, const std::vector<double>& values) {
      return TwinOf(drives[log], values, 7 + 1000 * static_cast<std::uint64_t>(log));
    };
    std::mt19937_64 generator(1);
    return sweep::Calibrate(robot_.calibrate.fit.list, logs, twin, options, generator,
                            asked_["--threads"]);
  }

  /// From each drive to the mean of the simulator's runs of it.
  double MeanGap_m(const std::vector<Drive>& drives, const std::vector<double>& values) {
    std::vector<double> gaps_m;
    for (size_t i = 0; i < drives.size(); ++i) {
      std::vector<Trajectory> runs;
      for (int run = 0; run < asked_["--runs"]; ++run) {
        const auto seed = 900'000 + 1000 * i + static_cast<std::uint64_t>(run);
        sweep::SimulatedRun driven = sweep::Simulate(TwinOf(drives[i], values, seed));
        if (driven.result.outcome != trial::Outcome::kReached) continue;
        runs.push_back(
            trajectory::OnFramesOf(std::move(driven.result.trajectory), robot_.candidate.grid_fps));
      }
      const double gap_m = gap::MeanPathGap_m(drives[i].log.log, runs, robot_.gap, robot_.likeness);
      if (!std::isnan(gap_m)) gaps_m.push_back(gap_m);
    }
    return statistics::Mean(gaps_m);
  }

  std::map<std::string, int> asked_;
  Experiment robot_;
};

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  std::map<std::string, int> asked{{"--repeats", 3}, {"--first", 1},      {"--drives", 5},
                                   {"--runs", 20},   {"--features", 100}, {"--threads", 1},
                                   {"--beside", 0}};
  try {
    for (int i = 1; i + 1 < count; i += 2) asked.at(arguments[i]) = std::stoi(arguments[i + 1]);
    rift::Study study(asked);
    for (int i = 0; i < asked["--repeats"]; ++i) {
      study.Repeat(static_cast<std::uint64_t>(asked["--first"] + i));
    }
    return 0;
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
