// How many evaluations the strategies need to reach a target: four functions of five dimensions,
// and failures of the simulated 3pi+ in a space of six parameters.
//
//   search_study [--seeds N] [--first-seed N] [--only TASK[,TASK...]]
//                [--with STRATEGY[,STRATEGY...]] [--measure]
//
// TASK: rastrigin, rosenbrock, ellipsoid, peaks, robot, cost (of the strategies themselves).
// --measure finds the targets anew instead.
//
// Reported for each strategy: successes, mean evaluations of the successful runs, and the expected
// running time (run_until.hpp). Results: README.md beside this file.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <sstream>
#include <stdexcept>

#include "rift/search/options.hpp"
#include "search/functions.hpp"
#include "search/robot_space.hpp"
#include "search/run_until.hpp"

namespace rift {
namespace {

using search::Method;

/// A target that random search reaches in every second run of 1e5 evaluations: the median over 41
/// seeds of the least loss it found (--measure).
constexpr int kRandomBudget = 100'000;
constexpr int kMeasureSeeds = 41;
const std::map<std::string, double> kTargets{
    {"rastrigin", 11.5}, {"rosenbrock", 28.0}, {"ellipsoid", 802.0}, {"peaks", 0.258}};
/// The others are given a tenth of that, and told so.
constexpr int kBudget = 10'000;
/// Where a function counts as solved. Random search is not run for it: what it would need follows
/// from the volume (functions.hpp).
constexpr double kSolved = 1e-6;
constexpr int kSolvedBudget = 100'000;

constexpr int kRobotBudget = 500;

struct Request {
  int seeds = 20;
  int first_seed = 1;
  bool measure = false;
  std::vector<std::string> only{"rastrigin", "rosenbrock", "ellipsoid", "peaks", "robot", "cost"};
  std::vector<std::string> with;
};

void PrintHeader(const std::string& title) {
  fmt::print("\n{}\n{:<10} {:>10} {:>10} {:>12} {:>12} {:>14}\n", title, "strategy", "budget",
             "successes", "mean", "ERT", "overhead ms");
}

void PrintRow(const std::string& name, int budget, const test::Summary& summary) {
  fmt::print("{:<10} {:>10} {:>7}/{:<2} {:>12.0f} {:>12.0f} {:>14.3f}\n", name, budget,
             summary.successes, summary.runs, summary.mean, summary.ert, summary.overhead_ms);
  std::fflush(stdout);
}

Method MethodOf(const std::string& name) {
  const auto names = EnumNames(Method{});
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw std::invalid_argument(name + ": no such strategy");
  return static_cast<Method>(found - names.begin());
}

std::vector<std::string> Strategies(const Request& request,
                                    const std::vector<std::string>& otherwise) {
  return request.with.empty() ? otherwise : request.with;
}

test::Task FunctionOf(const std::string& name, std::uint64_t seed) {
  for (test::Task& task : test::Functions(seed)) {
    if (task.name == name) return task;
  }
  throw std::invalid_argument(name + ": no such task");
}

std::vector<test::RunResult> RunSeeds(const Request& request, Method method, int budget,
                                      double target,
                                      const std::function<test::Task(std::uint64_t)>& task) {
  std::vector<test::RunResult> runs;
  for (int i = 0; i < request.seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(request.first_seed + i);
    runs.push_back(test::RunUntil(task(seed), method, budget, target, 1000 + seed));
  }
  return runs;
}

void StudyFunction(const Request& request, const std::string& name) {
  PrintHeader(fmt::format("{} to {}", name, kTargets.at(name)));
  for (const std::string& strategy :
       Strategies(request, {"random", "sobol", "cmaes", "surrogate", "polish", "portfolio"})) {
    const bool learns_nothing = strategy == "random" || strategy == "sobol" || strategy == "lhs";
    const int budget = learns_nothing ? kRandomBudget : kBudget;
    PrintRow(strategy, budget,
             test::Summarise(RunSeeds(request, MethodOf(strategy), budget, kTargets.at(name),
                                      [&](std::uint64_t seed) { return FunctionOf(name, seed); })));
  }
}

void StudySolved(const Request& request, const std::string& name) {
  PrintHeader(fmt::format("{} to {} (random by volume: ERT {:.1e})", name, kSolved,
                          FunctionOf(name, 1).random_evaluations(kSolved)));
  for (const std::string& strategy : Strategies(request, {"cmaes", "portfolio"})) {
    PrintRow(strategy, kSolvedBudget,
             test::Summarise(RunSeeds(request, MethodOf(strategy), kSolvedBudget, kSolved,
                                      [&](std::uint64_t seed) { return FunctionOf(name, seed); })));
  }
}

void StudyRobot(const Request& request) {
  const test::RobotSpace robot;
  const test::Task task{"robot", robot.Axes(), [&](const search::Point& point) {
                          return test::RobotSpace::kThreshold_m - robot.Gap_m(point);
                        }};
  PrintHeader(fmt::format("robot: a gap above {} m", test::RobotSpace::kThreshold_m));
  for (const std::string& strategy :
       Strategies(request, {"portfolio", "random", "sobol", "cmaes", "surrogate", "polish"})) {
    PrintRow(strategy, kRobotBudget,
             test::Summarise(RunSeeds(request, MethodOf(strategy), kRobotBudget, 0.0,
                                      [&](std::uint64_t) { return task; })));
  }
}

/// What a strategy itself takes over a whole budget, on a space of the robot's shape.
void StudyCost(const Request& request) {
  test::Task task = FunctionOf("rastrigin", 1);
  task.axes.push_back({"surface", search::AxisKind::kCategorical, 0, 4});
  PrintHeader(fmt::format("cost of Ask and Tell over {} evaluations", kRobotBudget));
  for (const std::string& strategy :
       Strategies(request, {"portfolio", "random", "sobol", "cmaes", "surrogate", "polish"})) {
    PrintRow(strategy, kRobotBudget,
             test::Summarise(RunSeeds(request, MethodOf(strategy), kRobotBudget, -INFINITY,
                                      [&](std::uint64_t) { return task; })));
  }
}

void MeasureFunction(const std::string& name) {
  std::vector<double> best;
  for (int seed = 1; seed <= kMeasureSeeds; ++seed) {
    const test::Task task = FunctionOf(name, 100'000 + seed);
    best.push_back(test::RunUntil(task, Method::kRandom, kRandomBudget, -1.0, seed).best);
  }
  std::sort(best.begin(), best.end());
  fmt::print("{}: random search reaches {:.4g} in the median of {} seeds\n", name,
             best[best.size() / 2], kMeasureSeeds);
}

/// The gap that 0.1 % of the volume exceeds.
void MeasureRobot() {
  constexpr int kSamples = 20'000;
  const test::RobotSpace robot;
  std::vector<double> gaps_m;
  const test::Task task{"robot", robot.Axes(), [&](const search::Point& point) {
                          const double gap_m = robot.Gap_m(point);
                          gaps_m.push_back(std::isnan(gap_m) ? -1.0 : gap_m);
                          return -gap_m;
                        }};
  test::RunUntil(task, Method::kRandom, kSamples, -INFINITY, 1);
  std::sort(gaps_m.begin(), gaps_m.end(), std::greater<>());
  const auto arrived = std::count_if(gaps_m.begin(), gaps_m.end(), [](double g) { return g >= 0; });
  const auto above = std::count_if(gaps_m.begin(), gaps_m.end(),
                                   [](double g) { return g > test::RobotSpace::kThreshold_m; });
  fmt::print("robot: {} of {} arrive; 0.1 % exceed {:.4f} m; {} exceed {} m\n", arrived, kSamples,
             gaps_m[kSamples / 1000], above, test::RobotSpace::kThreshold_m);
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

Request ParseArguments(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    const auto value = [&] {
      if (i + 1 == count) throw std::invalid_argument(argument + " needs a value");
      return std::string(arguments[++i]);
    };
    if (argument == "--seeds") {
      request.seeds = std::stoi(value());
    } else if (argument == "--first-seed") {
      request.first_seed = std::stoi(value());
    } else if (argument == "--only") {
      request.only = Split(value());
    } else if (argument == "--with") {
      request.with = Split(value());
    } else if (argument == "--measure") {
      request.measure = true;
    } else {
      throw std::invalid_argument(argument + ": no such option");
    }
  }
  return request;
}

void Study(const Request& request) {
  for (const std::string& name : request.only) {
    if (name == "robot") {
      request.measure ? MeasureRobot() : StudyRobot(request);
    } else if (name == "cost") {
      StudyCost(request);
    } else if (request.measure) {
      MeasureFunction(name);
    } else {
      StudyFunction(request, name);
      StudySolved(request, name);
    }
  }
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  try {
    rift::Study(rift::ParseArguments(count, arguments));
    return 0;
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
