#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

#include "rift/search/strategy.hpp"

namespace rift::search {

enum class Method {
  kPortfolio,       ///< corners and space-filling first, then whichever of the others pays
  kRandom,          ///< uniform and independent: the baseline
  kSobol,           ///< scrambled Sobol points
  kLatinHypercube,  ///< each axis cut into as many strata as there are points
  kCorners,         ///< every numeric axis at a bound; Sobol points once the corners are used up
  kCmaEs,           ///< evolution strategy with restarts of growing and of small populations
  kSurrogate,       ///< Kriging of the losses so far
  kBobyqa,          ///< quadratic models around the best points so far, one point at a time
  kEvolution,       ///< differential evolution
  kCrs,             ///< controlled random search: reflections through simplices of good points
};
constexpr std::array<std::string_view, 10> EnumNames(Method) {
  return {"portfolio", "random",    "sobol",  "lhs",       "corners",
          "cmaes",     "surrogate", "bobyqa", "evolution", "crs"};
}

struct SearchOptions {
  Method strategy = Method::kPortfolio;
  int batch = 8;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("strategy", self.strategy,
          "how points are chosen: portfolio mixes the others, random is the baseline");
    field(
        "batch", self.batch, 1, 10'000,
        "points proposed at once, whatever the number of workers, so that the same come with any");
  }
};

/// A strategy over the axes, for about `budget` evaluations (> 0; it may be asked for more). What
/// it proposes depends on these arguments and on what it is told, on nothing else. It never
/// proposes a point twice, its batches hold at most options.batch points, and in a space of
/// integers and categories alone it ends with an empty batch once all points were proposed. Tell
/// takes losses that are not finite; it throws std::invalid_argument for points other than those of
/// the last batch. Throws std::invalid_argument for a space without axes, bounds that are no
/// numbers or in the wrong order, bounds of an integer or categorical axis that are not whole, or a
/// budget below one.
std::unique_ptr<Strategy> MakeStrategy(const SearchOptions& options, const std::vector<Axis>& axes,
                                       int budget, std::uint64_t seed);

}  // namespace rift::search
