// What the identification of the 3pi+ is judged by: likeness and closeness of the simulated robot
// to the authors' trials by surface, beside Webots and a robot made of facts alone.
//
//   identification_study [--runs N] [--trial 1|2] [--robot FILE.yaml] [--facts] [--webots]
//                        [--horizon | --each] [--longest-run RATIO] [key=value ...]

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "benchmarks/run_study.hpp"
#include "identification/trial_grid.hpp"
#include "rift/sweep/calibrate/short_horizon.hpp"

namespace rift {
namespace {

struct Request {
  int runs = 20;
  int trial = 0;
  bool facts = false, webots = false, horizon = false, each = false;
  std::string robot = test::kAuthorsRobot;
  gap::LikenessOptions likeness;
  std::vector<std::string> overrides;
};

Request ParseArguments(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--runs" && i + 1 < count) {
      request.runs = std::stoi(arguments[++i]);
    } else if (argument == "--trial" && i + 1 < count) {
      request.trial = std::stoi(arguments[++i]);
    } else if (argument == "--robot" && i + 1 < count) {
      request.robot = arguments[++i];
    } else if (argument == "--facts") {
      request.facts = true;
    } else if (argument == "--webots") {
      request.webots = true;
    } else if (argument == "--longest-run" && i + 1 < count) {
      request.likeness.longest_run = std::stod(arguments[++i]);
    } else if (argument == "--each") {
      request.each = true;
    } else if (argument == "--horizon") {
      request.horizon = true;
    } else {
      request.overrides.push_back(argument);
    }
  }
  return request;
}

void PrintHeader() {
  fmt::print(
      "{:<10} {:>9} {:>6} {:>6} {:>15} {:>15} {:>14} {:>6} {:>12} {:>11} {:>9} {:>5} {:>6}\n", "",
      "gap/floor", "ratio", "mean20", "spread", "weave", "loop delay", "speed", "gain",
      "wavelength", "energy p", "in", "failed");
  fmt::print(
      "{:<10} {:>9} {:>6} {:>6} {:>15} {:>15} {:>14} {:>6} {:>12} {:>11} {:>9} {:>5} {:>6}\n", "",
      "mm", "", "mm", "mm", "mm", "s", "ratio", "rad/s", "mm", "", "share", "runs");
}

void Print(const std::string& name, const sweep::DriveLikeness& d) {
  const gap::Likeness& l = d.path;
  const auto mm = [](const gap::BothSides& both) {
    return fmt::format("{:.1f}/{:.1f} {:.2f}", 1e3 * both.sim, 1e3 * both.real, both.Ratio());
  };
  fmt::print(
      "{:<10} {:>4.1f}/{:>4.1f} {:>6.2f} {:>6.1f} {:>15} {:>15} {:>14} {:>6.3f} {:>12} "
      "{:>11} {:>9.3f} {:>5.2f} {:>6}\n",
      name, 1e3 * l.mean_gap_m, 1e3 * l.spread_m.real, l.mean_gap_m / l.spread_m.real,
      1e3 * l.mean_path_gap_m, mm(l.spread_m), mm(l.weave_m),
      fmt::format("{:.3f}/{:.3f}", d.loop_delay_s.sim, d.loop_delay_s.real), l.speed_mps.Ratio(),
      fmt::format("{:.1f}/{:.1f}", d.steering_gain_rad_s.sim, d.steering_gain_rad_s.real),
      fmt::format("{:.0f}/{:.0f}", 1e3 * l.wavelength_m.sim, 1e3 * l.wavelength_m.real), l.energy_p,
      l.inside_share, d.failed_runs);
}

void PrintTable(const std::vector<sweep::RepeatedTrial>& trials, bool is_matched,
                const gap::LikenessOptions& likeness) {
  gap::GapOptions gap;
  gap.skip_start = 0.1;
  std::map<std::string, std::vector<sweep::RepeatedTrial>> groups;
  for (const sweep::RepeatedTrial& trial : trials) {
    const std::string surface = trial.setting.substr(0, trial.setting.find('/'));
    groups[surface].push_back(trial);
    if (surface != "bump") groups["the grid"].push_back(trial);
  }
  for (const char* name : {"ground", "cardboard", "parchment", "downhill", "the grid", "bump"}) {
    if (!groups.contains(name)) continue;
    std::mt19937_64 generator(1);
    Print(name, sweep::MeasureDriveLikeness(groups[name], is_matched, gap, likeness, generator));
  }
}

/// Root mean square of the errors over one and over five frames, and what is left of them on
/// average: a model that is wrong has a bias.
void PrintHorizons(const test::GridStudy& study, const std::vector<test::GridTrial>& trials) {
  struct Sums {
    double n = 0, ahead = 0, left = 0, turned = 0, ahead2 = 0, left2 = 0, turned2 = 0;
  };
  std::map<std::pair<std::string, int>, Sums> all;
  for (const test::GridTrial& trial : trials) {
    for (const auto& e : sweep::ShortHorizonErrors(test::TwinOf(study, trial, 1), trial.real, {})) {
      for (const std::string& name : {trial.surface, std::string("~all")}) {
        Sums& s = all[{name, e.frames}];
        s.n += 1, s.ahead += e.ahead_m, s.left += e.left_m, s.turned += e.turned_rad;
        s.ahead2 += e.ahead_m * e.ahead_m, s.left2 += e.left_m * e.left_m;
        s.turned2 += e.turned_rad * e.turned_rad;
      }
    }
  }
  fmt::print("{:<12} {:>6} {:>22} {:>22} {:>24}\n", "horizon", "frames", "ahead rms (bias) mm",
             "left rms (bias) mm", "turned rms (bias) deg");
  for (const auto& [key, s] : all) {
    if (key.second != 1 && key.second != 5) continue;
    fmt::print("{:<12} {:>6} {:>14.2f} ({:+.2f}) {:>14.2f} ({:+.2f}) {:>16.3f} ({:+.3f})\n",
               key.first, key.second, 1e3 * std::sqrt(s.ahead2 / s.n), 1e3 * s.ahead / s.n,
               1e3 * std::sqrt(s.left2 / s.n), 1e3 * s.left / s.n,
               57.29578 * std::sqrt(s.turned2 / s.n), 57.29578 * s.turned / s.n);
  }
}

void PrintTraits(const sweep::RepeatedTrial& trial, const char* side,
                 const trajectory::Trajectory& path) {
  const gap::PathTraits shape = gap::TraitsOf(path, {});
  const trial::LoopDelay d = trial::EstimateLoopDelay(path, trial.waypoints, trial.control);
  fmt::print("{},{},{:.5f},{:.5f},{:.4f},{:.3f},{:.4f},{:.3f},{:.3f}\n", trial.setting, side,
             shape.speed_mps, shape.weave_m, d.lag_s, d.gain_rad_s, d.bias_rad_s, d.r2,
             path.Duration_s());
}

/// What each path tells by itself, real and simulated, as CSV.
void PrintEach(const std::vector<sweep::RepeatedTrial>& trials) {
  fmt::print("setting,side,speed_mps,weave_m,loop_delay_s,gain_rad_s,bias_rad_s,r2,duration_s\n");
  for (const sweep::RepeatedTrial& trial : trials) {
    PrintTraits(trial, "real", trial.real);
    for (const trajectory::Trajectory& run : trial.runs) PrintTraits(trial, "simulated", run);
  }
}

int Study(const Request& request) {
  const test::GridStudy study =
      test::LoadGridStudy(request.facts ? "" : request.robot, request.overrides);
  const std::vector<test::GridTrial> trials = test::LoadTrialGrid(study, request.trial);
  if (request.horizon) {
    PrintHorizons(study, trials);
    return 0;
  }
  if (request.each) {
    PrintEach(test::DriveGrid(study, trials, request.runs));
    return 0;
  }
  PrintHeader();
  if (request.webots) {
    PrintTable(test::WebotsGrid(trials), false, request.likeness);
  } else {
    PrintTable(test::DriveGrid(study, trials, request.runs), true, request.likeness);
  }
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  return rift::test::RunStudy([&] { return rift::Study(rift::ParseArguments(count, arguments)); });
}
