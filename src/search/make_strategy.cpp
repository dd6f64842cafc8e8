#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "archive.hpp"
#include "cma_es.hpp"
#include "controlled_random_search.hpp"
#include "differential_evolution.hpp"
#include "local_model.hpp"
#include "portfolio.hpp"
#include "rift/search/options.hpp"
#include "samplers.hpp"
#include "surrogate.hpp"

namespace rift::search {
namespace {

/// Strata of a Latin hypercube beyond this gain nothing and cost memory.
constexpr int kMostStrata = 10'000;

std::unique_ptr<Strategy> Proposer(const SearchOptions& options, const Known& known, int budget,
                                   std::uint64_t seed) {
  switch (options.strategy) {
    case Method::kPortfolio:
      return std::make_unique<Portfolio>(known, options, budget, seed);
    case Method::kRandom:
      return std::make_unique<RandomSampler>(known.space, seed);
    case Method::kSobol:
      return std::make_unique<SobolSampler>(known.space, seed);
    case Method::kLatinHypercube:
      return std::make_unique<LatinHypercubeSampler>(known.space, seed,
                                                     std::min(budget, kMostStrata));
    case Method::kCorners:
      return std::make_unique<CornerSampler>(known.space, seed);
    case Method::kCmaEs:
      return std::make_unique<Restarts>(known, options.batch, seed);
    case Method::kSurrogate:
      return std::make_unique<Surrogate>(known, seed);
    case Method::kBobyqa:
      return std::make_unique<LocalModel>(known, seed);
    case Method::kEvolution:
      return std::make_unique<DifferentialEvolution>(known, seed);
    case Method::kCrs:
      return std::make_unique<ControlledRandomSearch>(known, seed);
  }
  throw std::invalid_argument("search: no such strategy");
}

}  // namespace

std::unique_ptr<Strategy> MakeStrategy(const SearchOptions& options, const std::vector<Axis>& axes,
                                       int budget, std::uint64_t seed) {
  if (budget < 1) {
    throw std::invalid_argument(
        fmt::format("search: a budget of {} evaluations must be at least 1", budget));
  }
  auto known = std::make_unique<Known>(axes);
  auto proposer = Proposer(options, *known, budget, seed);
  return std::make_unique<WithoutRepeats>(std::move(known), std::move(proposer), options.batch,
                                          seed);
}

}  // namespace rift::search
