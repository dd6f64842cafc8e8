// How many evaluations the strategies need to reach a target: four functions of five dimensions,
// and failures of the simulated 3pi+ in a space of six parameters.
//
//   search_study [--seeds N] [--only TASK[,TASK...]] [--with STRATEGY[,STRATEGY...]] [--measure]
//
// TASK: rastrigin, rosenbrock, ellipsoid, peaks, robot. --measure finds the targets anew instead.
//
// Reported for each strategy: successes, mean evaluations of the successful runs, and the expected
// running time ERT = all evaluations / successes (Hansen 2010, BBOB), which charges a strategy for
// its failures and is what restarting it until it succeeds would cost.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <exception>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "rift/search/options.hpp"
#include "search/functions.hpp"
#include "search/robot_space.hpp"

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
/// A target that random search has no hope to reach: where a smooth function counts as solved.
constexpr double kSolved = 1e-6;

constexpr int kRobotBudget = 500;

struct Request {
  int seeds = 21;
  bool measure = false;
  std::vector<std::string> only{"rastrigin", "rosenbrock", "ellipsoid", "peaks", "robot"};
  std::vector<std::string> with;
};

struct RunResult {
  int evaluations = 0;
  std::optional<int> reached_at;  ///< evaluations until the target
  double best = INFINITY;
  double overhead_s = 0.0;  ///< in Ask and Tell
};

/// Of this process, whatever else the machine does.
double CpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Until the loss is at most the target or the budget is spent.
RunResult RunUntil(const test::Task& task, Method method, int budget, double target,
                   std::uint64_t seed) {
  search::SearchOptions options;
  options.strategy = method;
  const auto strategy = search::MakeStrategy(options, task.axes, budget, seed);
  RunResult run;
  while (run.evaluations < budget && !run.reached_at) {
    double begin = CpuSeconds();
    const std::vector<search::Point> points = strategy->Ask(budget - run.evaluations);
    run.overhead_s += CpuSeconds() - begin;
    if (points.empty()) break;
    std::vector<search::Evaluation> batch;
    for (const search::Point& point : points) {
      batch.push_back({point, task.loss(point)});
      ++run.evaluations;
      if (batch.back().loss < run.best) run.best = batch.back().loss;
      if (run.best <= target && !run.reached_at) run.reached_at = run.evaluations;
    }
    begin = CpuSeconds();
    strategy->Tell(batch);
    run.overhead_s += CpuSeconds() - begin;
  }
  return run;
}

struct Summary {
  int runs = 0;
  int successes = 0;
  double mean = NAN;  ///< evaluations of the successful runs
  double ert = INFINITY;
  double overhead_ms = 0.0;  ///< an evaluation
};

Summary Summarise(const std::vector<RunResult>& runs) {
  Summary summary;
  double all = 0.0, of_successes = 0.0, asked = 0.0;
  for (const RunResult& run : runs) {
    ++summary.runs;
    all += run.reached_at.value_or(run.evaluations);
    asked += run.evaluations;
    summary.overhead_ms += 1e3 * run.overhead_s;
    if (!run.reached_at) continue;
    ++summary.successes;
    of_successes += *run.reached_at;
  }
  summary.overhead_ms /= asked;
  if (summary.successes == 0) return summary;
  summary.mean = of_successes / summary.successes;
  summary.ert = all / summary.successes;
  return summary;
}

void PrintHeader(const std::string& title) {
  fmt::print("\n{}\n{:<10} {:>10} {:>10} {:>12} {:>12} {:>14}\n", title, "strategy", "budget",
             "successes", "mean", "ERT", "overhead ms");
}

void PrintRow(const std::string& name, int budget, const Summary& summary) {
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

void StudyFunction(const Request& request, const std::string& name, double target, bool is_easy) {
  PrintHeader(fmt::format("{} to {:.3g}", name, target));
  std::vector<std::string> all{"random",    "sobol",  "lhs",      "cmaes",
                               "surrogate", "polish", "portfolio"};
  if (!is_easy) all = {"cmaes", "polish", "portfolio"};
  double random_ert = NAN;
  for (const std::string& strategy : Strategies(request, all)) {
    const bool learns_nothing = strategy == "random" || strategy == "sobol" || strategy == "lhs";
    const int budget = learns_nothing ? kRandomBudget : kBudget;
    std::vector<RunResult> runs;
    for (int seed = 1; seed <= request.seeds; ++seed) {
      runs.push_back(
          RunUntil(FunctionOf(name, seed), MethodOf(strategy), budget, target, 1000 + seed));
    }
    const Summary summary = Summarise(runs);
    PrintRow(strategy, budget, summary);
    if (strategy == "random") random_ert = summary.ert;
    if (strategy == "portfolio" && !std::isnan(random_ert)) {
      fmt::print("random needs {:.1f} times the evaluations of the default\n",
                 random_ert / summary.ert);
    }
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
    std::vector<RunResult> runs;
    for (int seed = 1; seed <= request.seeds; ++seed) {
      runs.push_back(RunUntil(task, MethodOf(strategy), kRobotBudget, 0.0, 1000 + seed));
    }
    PrintRow(strategy, kRobotBudget, Summarise(runs));
  }
}

void MeasureFunction(const std::string& name) {
  std::vector<double> best;
  for (int seed = 1; seed <= kMeasureSeeds; ++seed) {
    const test::Task task = FunctionOf(name, 100'000 + seed);
    best.push_back(RunUntil(task, Method::kRandom, kRandomBudget, -1.0, seed).best);
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
  RunUntil(task, Method::kRandom, kSamples, -INFINITY, 1);
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
    } else if (request.measure) {
      MeasureFunction(name);
    } else {
      StudyFunction(request, name, kTargets.at(name), true);
      StudyFunction(request, name, kSolved, false);
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
