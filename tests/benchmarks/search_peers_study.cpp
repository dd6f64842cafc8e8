// The tasks of search_study by optimisers that others wrote, each as its documentation shows it:
// NLopt (MLSL with BOBYQA, CRS2), pagmo (de1220, sade, cmaes), dlib (global_function_search). Built
// when libpagmo-dev, libdlib-dev and libnlopt-dev are there; the bootstrap does not ask for them.
//
//   search_peers_study [--seeds N] [--first-seed N] [--budgets 100,500,2000] [--only TASK,...]
//                      [--with PEER,...] [--each]
//
// Paired seeds and output are those of search_study. Optuna: search_peers.py. A category is a whole
// number to all of them but dlib, which is told so.

#include <dlib/global_optimization.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlopt.hpp>
#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/de1220.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <sstream>
#include <stdexcept>

#include "rift/statistics/inference.hpp"
#include "search/run_until.hpp"
#include "search/tasks.hpp"

namespace rift {
namespace {

struct BudgetSpent {};

/// Counts evaluations, and ends the optimiser that asks for one too many.
class Counted {
 public:
  Counted(const test::StudyTask& study, int budget) : study_(study), budget_(budget) {}

  /// A value for each axis; whole where the axis is.
  double operator()(const double* values) {
    if (run_.reached_at || run_.evaluations >= budget_) throw BudgetSpent{};
    search::Point point;
    for (size_t i = 0; i < study_.task.axes.size(); ++i) {
      const search::Axis& axis = study_.task.axes[i];
      double value = std::clamp(values[i], axis.min, axis.max);
      if (axis.kind != search::AxisKind::kContinuous) value = std::round(value);
      point.push_back(value);
    }
    const double loss = study_.task.loss(point);
    ++run_.evaluations;
    if (loss < run_.best) run_.best = loss;
    if (run_.best <= study_.target) run_.reached_at = run_.evaluations;
    return std::isfinite(loss) ? loss : 1e9;
  }
  const std::vector<search::Axis>& axes() const { return study_.task.axes; }
  const test::RunResult& run() const { return run_; }
  int budget() const { return budget_; }

 private:
  const test::StudyTask& study_;
  int budget_;
  test::RunResult run_;
};

void RunNlopt(Counted& loss, bool is_mlsl, std::uint64_t seed) {
  nlopt::srand(seed);
  const auto axes = static_cast<unsigned>(loss.axes().size());
  nlopt::opt optimiser(is_mlsl ? nlopt::G_MLSL_LDS : nlopt::GN_CRS2_LM, axes);
  std::vector<double> low, high, x;
  for (const search::Axis& axis : loss.axes()) {
    low.push_back(axis.min);
    high.push_back(axis.max);
    x.push_back(0.5 * (axis.min + axis.max));
  }
  optimiser.set_lower_bounds(low);
  optimiser.set_upper_bounds(high);
  optimiser.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                 void* data) { return (*static_cast<Counted*>(data))(at.data()); },
                              &loss);
  if (is_mlsl) {
    nlopt::opt local(nlopt::LN_BOBYQA, axes);
    local.set_xtol_rel(1e-6);
    optimiser.set_local_optimizer(local);
  }
  optimiser.set_maxeval(10 * loss.budget());
  double least = 0.0;
  optimiser.optimize(x, least);
}

/// What pagmo asks of a problem.
struct PagmoProblem {
  Counted* loss = nullptr;
  pagmo::vector_double fitness(const pagmo::vector_double& x) const { return {(*loss)(x.data())}; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    std::pair<pagmo::vector_double, pagmo::vector_double> bounds;
    for (const search::Axis& axis : loss->axes()) {
      bounds.first.push_back(axis.min);
      bounds.second.push_back(axis.max);
    }
    return bounds;
  }
};

void RunPagmo(Counted& loss, const std::string& name, std::uint64_t seed) {
  const auto seed32 = static_cast<unsigned>(seed);
  const unsigned size = std::clamp(loss.budget() / 10, 10, 20);
  pagmo::population population{pagmo::problem{PagmoProblem{&loss}}, size, seed32};
  const unsigned generations = static_cast<unsigned>(loss.budget());
  pagmo::algorithm algorithm;
  if (name == "de1220") algorithm = pagmo::algorithm{pagmo::de1220(generations)};
  if (name == "sade") algorithm = pagmo::algorithm{pagmo::sade(generations)};
  if (name == "cmaes") {
    algorithm =
        pagmo::algorithm{pagmo::cmaes(generations, -1, -1, -1, -1, 0.5, 1e-12, 1e-12, false, true)};
  }
  algorithm.set_seed(seed32);
  algorithm.evolve(population);
}

void RunDlib(Counted& loss, std::uint64_t seed) {
  const long axes = static_cast<long>(loss.axes().size());
  dlib::matrix<double, 0, 1> low(axes), high(axes);
  std::vector<bool> whole;
  for (long i = 0; i < axes; ++i) {
    const search::Axis& axis = loss.axes()[static_cast<size_t>(i)];
    low(i) = axis.min;
    high(i) = axis.max;
    whole.push_back(axis.kind != search::AxisKind::kContinuous);
  }
  dlib::global_function_search search(dlib::function_spec(low, high, whole));
  search.set_seed(static_cast<time_t>(seed));
  while (true) {
    dlib::function_evaluation_request request = search.get_next_x();
    const dlib::matrix<double, 0, 1> x = request.x();
    request.set(-loss(&x(0)));
  }
}

test::RunResult RunPeer(const std::string& name, const test::StudyTask& study, int budget,
                        std::uint64_t seed) {
  Counted loss(study, budget);
  try {
    if (name == "mlsl" || name == "crs2") {
      RunNlopt(loss, name == "mlsl", seed);
    } else if (name == "dlib") {
      RunDlib(loss, seed);
    } else {
      RunPagmo(loss, name, seed);
    }
  } catch (const BudgetSpent&) {         // as every run ends
  } catch (const std::runtime_error&) {  // NLopt: rounding leaves nothing to gain
  }
  return loss.run();
}

std::vector<std::string> Split(const std::string& list) {
  std::vector<std::string> names;
  std::istringstream text(list);
  for (std::string name; std::getline(text, name, ',');) names.push_back(name);
  return names;
}

struct Request {
  int seeds = 50, first_seed = 1;
  bool each = false;
  std::vector<std::string> budgets{"100", "500", "2000"};
  std::vector<std::string> only = test::StudyNames();
  std::vector<std::string> with{"mlsl", "crs2", "de1220", "sade", "cmaes", "dlib"};
};

Request ParseArguments(int count, char** arguments) {
  Request request;
  for (int i = 1; i < count; ++i) {
    const std::string argument = arguments[i];
    if (argument == "--each") {
      request.each = true;
      continue;
    }
    if (++i == count) throw std::invalid_argument(argument + " needs a value");
    const std::string value = arguments[i];
    if (argument == "--seeds")
      request.seeds = std::stoi(value);
    else if (argument == "--first-seed")
      request.first_seed = std::stoi(value);
    else if (argument == "--budgets")
      request.budgets = Split(value);
    else if (argument == "--only")
      request.only = Split(value);
    else if (argument == "--with")
      request.with = Split(value);
    else
      throw std::invalid_argument(argument + ": no such option");
  }
  return request;
}

void Study(const Request& request, const std::string& name, const std::string& peer, int budget) {
  std::vector<test::RunResult> runs;
  for (int i = 0; i < request.seeds; ++i) {
    const auto seed = static_cast<std::uint64_t>(request.first_seed + i);
    runs.push_back(RunPeer(peer, test::StudyTaskOf(name, seed), budget, 1000 + seed));
  }
  if (request.each) test::PrintEach(name, peer, budget, request.first_seed, runs);
  const test::Summary summary = test::Summarise(runs);
  const statistics::Interval share =
      statistics::ClopperPearson(summary.successes, summary.runs, 0.95);
  fmt::print("{:<11} {:<10} {:>6} {:>4}/{:<4} [{:.2f}, {:.2f}] {:>9.0f} {:>11.4g}\n", name, peer,
             budget, summary.successes, summary.runs, share.low, share.high, summary.ert,
             summary.median_best);
  std::fflush(stdout);
}

}  // namespace
}  // namespace rift

int main(int count, char** arguments) {
  try {
    const rift::Request request = rift::ParseArguments(count, arguments);
    for (const std::string& name : request.only) {
      for (const std::string& budget : request.budgets) {
        for (const std::string& peer : request.with) {
          rift::Study(request, name, peer, std::stoi(budget));
        }
      }
    }
    return 0;
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}
