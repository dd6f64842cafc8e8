// What the identification of the 3pi+ is judged by: likeness and closeness of the simulated robot
// to the authors' trials by surface, beside Webots and a robot made of facts alone.
//
//   identification_study [--runs N] [--trial 1|2] [--robot FILE.yaml] [--facts] [--webots]
//                        [--horizon | --each] [key=value ...]

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include "rift/sweep/short_horizon.hpp"
#include <map>

#include "benchmarks/run_study.hpp"
#include "identification/trial_grid.hpp"
#include "rift/config/bind.hpp"
#include "rift/config/load.hpp"
#include "rift/config/tree.hpp"
#include "rift/sweep/short_horizon.hpp"

namespace rift {
namespace {

struct Request {
  int runs = 20;
  int trial = 0;
  bool facts = false, webots = false, horizon = false, each = false;
  std::string robot = RIFT_SOURCE_DIR "/configs/robots/3pi_2040.yaml";
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

test::GridStudy LoadStudy(const Request& request) {
  config::Node tree = config::Load(RIFT_SOURCE_DIR "/configs/waypoints/paper.yaml", test::ReadFile);
  if (!request.facts) config::Merge(tree, config::Load(request.robot, test::ReadFile));
  for (const std::string& set : request.overrides) config::Merge(tree, config::ParseOverride(set));
  test::GridStudy study;
  config::Bind(tree, study);
  return study;
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

void PrintTable(const std::vector<sweep::RepeatedTrial>& trials, bool is_matched) {
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
    Print(name, sweep::MeasureDriveLikeness(groups[name], is_matched, gap, {}, generator));
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

void PrintPhases(const test::GridStudy& study, const std::vector<test::GridTrial>& trials, bool simulated, int phases) {
  double mean = 0, single = 0, best = 0; std::map<std::string, std::array<double,3>> by;
  for (test::GridTrial trial : trials) {
    if (trial.surface == "bump") continue;
    auto twin = test::TwinOf(study, trial, 1);
    if (simulated) { twin.seed = 1 + std::hash<std::string>{}(trial.setting) + trial.trial; trial.real = sweep::Simulate(twin).result.trajectory; twin.seed = 77; }
    std::vector<std::vector<double>> turned;
    for (int p = 0; p < phases; ++p) {
      twin.simulation.link.poll_phase = (p + 0.5) / phases;
      auto log = trial.real;
      auto path = sweep::Replay(twin, log);
      std::vector<double> e;
      std::vector<double> yaws;
      size_t i = 0;
      for (const auto& row : log.poses) {
        while (i + 2 < path.poses.size() && path.poses[i + 1].t_s < row.t_s) ++i;
        const auto &a = path.poses[i], &b = path.poses[i + 1];
        yaws.push_back(a.yaw_rad + std::clamp((row.t_s - a.t_s) / (b.t_s - a.t_s), 0.0, 1.0) * std::remainder(b.yaw_rad - a.yaw_rad, 6.283185307));
      }
      for (size_t k = 10; k + 3 < yaws.size(); ++k) e.push_back(std::remainder(yaws[k + 3] - yaws[k] - log.poses[k + 3].yaw_rad + log.poses[k].yaw_rad, 6.283185307));
      turned.push_back(e);
    }
    double m = 0, s = 0, b = 1e9;
    for (size_t k = 0; k < turned[0].size(); ++k) { double x = 0; for (auto& e : turned) x += e[k] / phases; m += x * x; }
    for (auto& e : turned) { double q = 0; for (double x : e) q += x * x; s += q / phases; b = std::min(b, q); }
    mean += m; single += s; best += b;
    auto& o = by[trial.surface]; o[0] += m; o[1] += s; o[2] += b;
  }
  for (auto& [k, o] : by) fmt::print("{}: mean {:.4f} single {:.3f} best {:.3f} (of mean)\n", k, o[0], o[1] / o[0], o[2] / o[0]);
  fmt::print("mean {:.4f} single {:.3f} best {:.3f}\n", mean, single / mean, best / mean);
}

int Study(const Request& request) {
  const test::GridStudy study = LoadStudy(request);
  const std::vector<test::GridTrial> trials = test::LoadTrialGrid(study, request.trial);
  if (request.horizon) {
    PrintHorizons(study, trials);
    return 0;
  }
  if (getenv("PHASES")) { PrintPhases(study, trials, getenv("SIMULATED"), atoi(getenv("PHASES"))); return 0; }
  if (const char* dir = getenv("DUMP")) {
    for (const auto& t : test::DriveGrid(study, trials, request.runs)) {
      std::string name = t.setting; std::replace(name.begin(), name.end(), '/', '_');
      static std::map<std::string, int> n; 
      std::FILE* f = std::fopen(fmt::format("{}/{}_{}.dat", dir, name, ++n[name]).c_str(), "w");
      for (const auto& r : t.runs) { for (const auto& q : r.poses) fmt::print(f, "{} {} {} {}\n", q.t_s - r.poses[0].t_s, q.x_m, q.y_m, q.yaw_rad); fmt::print(f, "\n"); }
      std::fclose(f);
    }
    return 0;
  }
  if (request.each) {
    PrintEach(test::DriveGrid(study, trials, request.runs));
    return 0;
  }
  PrintHeader();
  if (request.webots) {
    PrintTable(test::WebotsGrid(trials), false);
  } else {
    PrintTable(test::DriveGrid(study, trials, request.runs), true);
  }
  return 0;
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  return rift::test::RunStudy([&] { return rift::Study(rift::ParseArguments(count, arguments)); });
}
