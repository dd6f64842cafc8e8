// How often the strategies reach a target within a budget, and at what cost: four functions of five
// dimensions, two spaces whose failures nothing points to, and failures of the simulated 3pi+ in a
// space of six parameters.
//
//   search_study [--seeds N] [--first-seed N] [--budgets 100,500,2000] [--only TASK[,TASK...]]
//                [--with STRATEGY[,STRATEGY...]] [--each] [--measure]
//   search_study --serve TASK SEED     (losses of points on stdin, one a line: search_peers.py)
//
// TASK: rastrigin, rosenbrock, ellipsoid, peaks, deceiving, flat, robot.
// --each prints each run as well: its seed, its evaluations until the target, its least loss.
// --measure counts what random search finds instead, for the targets.
//
// Seeds are paired: every strategy meets the same tasks. Reported: successes with their 95 %
// interval (Clopper and Pearson), the expected running time (run_until.hpp), the median of the
// least loss. Results: README.md beside this file.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "rift/statistics/inference.hpp"
#include "rift/yaml/enum_name.hpp"
#include "search/robot_space.hpp"
#include "search/run_until.hpp"
#include "search/tasks.hpp"

namespace rift {
namespace {

using search::Method;

struct Request {
  int seeds = 50;
  int first_seed = 1;
  bool each = false;
  bool measure = false;
  std::vector<std::string> budgets{"100", "500", "2000"};
  std::vector<std::string> only = test::StudyNames();
  std::vector<std::string> with{"portfolio", "random"};
  std::string serve;
};

Method MethodOf(const std::string& name) {
  const std::optional<Method> method = yaml::ValueNamed<Method>(name);
  if (!method) throw std::invalid_argument(name + ": no such strategy");
  return *method;
}

void Study(const Request& request, const std::string& name, int budget) {
  for (const std::string& strategy : request.with) {
    std::vector<test::RunResult> runs;
    for (int i = 0; i < request.seeds; ++i) {
      const auto seed = static_cast<std::uint64_t>(request.first_seed + i);
      const test::StudyTask study = test::StudyTaskOf(name, seed);
      runs.push_back(
          test::RunUntil(study.task, MethodOf(strategy), budget, study.target, 1000 + seed));
    }
    if (request.each) test::PrintEach(name, strategy, budget, request.first_seed, runs);
    const test::Summary summary = test::Summarise(runs);
    const statistics::Interval share =
        statistics::ClopperPearson(summary.successes, summary.runs, 0.95);
    fmt::print("{:<11} {:<10} {:>6} {:>4}/{:<4} [{:.2f}, {:.2f}] {:>9.0f} {:>11.4g} {:>9.3f}\n",
               name, strategy, budget, summary.successes, summary.runs, share.low, share.high,
               summary.ert, summary.median_best, summary.overhead_ms);
    std::fflush(stdout);
  }
}

void MeasureFunction(const std::string& name) {
  constexpr int kRandomBudget = 100'000, kSeeds = 41;
  std::vector<double> best;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    const test::StudyTask study = test::StudyTaskOf(name, 100'000 + seed);
    best.push_back(test::RunUntil(study.task, Method::kRandom, kRandomBudget, -2.0, seed).best);
  }
  std::sort(best.begin(), best.end());
  fmt::print("{}: random search reaches {:.4g} in the median of {} seeds\n", name,
             best[best.size() / 2], kSeeds);
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

/// The first line tells the axes as name kind min max, and the target; then a loss for each point.
void Serve(const std::string& name, std::uint64_t seed) {
  const test::StudyTask study = test::StudyTaskOf(name, seed);
  for (const search::Axis& axis : study.task.axes) {
    fmt::print("{} {} {} {} ", axis.name, static_cast<int>(axis.kind), axis.min, axis.max);
  }
  fmt::print("{}\n", study.target);
  std::fflush(stdout);
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    search::Point point;
    for (double x = 0.0; words >> x;) point.push_back(x);
    const double loss = study.task.loss(point);
    fmt::print("{:.17g}\n", std::isfinite(loss) ? loss : 1e9);
    std::fflush(stdout);
  }
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
    } else if (argument == "--budgets") {
      request.budgets = Split(value());
    } else if (argument == "--only") {
      request.only = Split(value());
    } else if (argument == "--with") {
      request.with = Split(value());
    } else if (argument == "--each") {
      request.each = true;
    } else if (argument == "--measure") {
      request.measure = true;
    } else if (argument == "--serve") {
      request.serve = value();
      request.first_seed = std::stoi(value());
    } else {
      throw std::invalid_argument(argument + ": no such option");
    }
  }
  return request;
}

void Run(const Request& request) {
  if (!request.serve.empty()) {
    return Serve(request.serve, static_cast<std::uint64_t>(request.first_seed));
  }
  if (!request.measure) {
    fmt::print("{:<11} {:<10} {:>6} {:>9} {:>12} {:>9} {:>11} {:>9}\n", "task", "strategy",
               "budget", "successes", "95 %", "ERT", "median best", "ms each");
  }
  for (const std::string& name : request.only) {
    if (request.measure) {
      name == "robot" ? MeasureRobot() : MeasureFunction(name);
      continue;
    }
    for (const std::string& budget : request.budgets) Study(request, name, std::stoi(budget));
  }
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  try {
    rift::Run(rift::ParseArguments(count, arguments));
    return 0;
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
