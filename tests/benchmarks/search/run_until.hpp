#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rift/search/options.hpp"
#include "search/functions.hpp"

namespace rift::test {

struct RunResult {
  int evaluations = 0;
  std::optional<int> reached_at;  ///< evaluations until the target
  double best = INFINITY;
  double overhead_s = 0.0;  ///< in Ask and Tell, on the processor
};

/// Runs a strategy with its default options until the loss is at most the target or the budget is
/// spent.
RunResult RunUntil(const Task& task, search::Method method, int budget, double target,
                   std::uint64_t seed);

/// Runs alike but for their seed. ERT = all evaluations / successes (Hansen 2010, BBOB) charges a
/// strategy for its failures: it is what restarting it until it succeeds would cost.
struct Summary {
  int runs = 0;
  int successes = 0;
  double mean = NAN;  ///< evaluations of the successful runs
  double ert = INFINITY;
  double median_best = NAN;  ///< of the least losses
  double overhead_ms = 0.0;  ///< an evaluation
};
Summary Summarise(const std::vector<RunResult>& runs);

/// One line for each run, of seeds from `first_seed` on, so that runs of several processes can be
/// counted together.
void PrintEach(const std::string& task, const std::string& strategy, int budget, int first_seed,
               const std::vector<RunResult>& runs);

}  // namespace rift::test
