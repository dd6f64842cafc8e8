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
  kPolish,          ///< pattern search from the best points so far
};
constexpr std::array<std::string_view, 8> EnumNames(Method) {
  return {"portfolio", "random", "sobol", "lhs", "corners", "cmaes", "surrogate", "polish"};
}

/// Covariance matrix adaptation.
struct CmaEsOptions {
  double sigma = 0.25;
  int population = 0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("sigma", self.sigma, 1e-3, 1.0, "first step size as a share of every axis");
    field("population", self.population, 0, 10'000,
          "points in a generation of the first run; 0: 4 + 3 ln(axes) (Hansen 2016)");
  }
};

/// Kriging over the ranks of the losses.
struct SurrogateOptions {
  int initial = 0;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("initial", self.initial, 0, 100'000,
          "space-filling points before the first model when it searches alone; 0: 4 an axis");
  }
};

/// Pattern search. Lengths are shares of the axes' ranges.
struct PolishOptions {
  double first_step = 0.1;
  double last_step = 1e-4;
  double apart = 0.1;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("first_step", self.first_step, 1e-6, 1.0, "step from the start point");
    field("last_step", self.last_step, 1e-12, 1.0,
          "a polish whose step fell below this goes on to another start point");
    field("apart", self.apart, 0.0, 1.0,
          "start points are at least so far apart on some axis, or differ in a category");
  }
  /// Throws std::invalid_argument when last_step exceeds first_step.
  void Check() const;
};

struct SearchOptions {
  Method strategy = Method::kPortfolio;
  int batch = 8;
  CmaEsOptions cmaes;
  SurrogateOptions surrogate;
  PolishOptions polish;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("strategy", self.strategy,
          "how points are chosen: portfolio mixes the others, random is the baseline");
    field(
        "batch", self.batch, 1, 10'000,
        "points proposed at once, whatever the number of workers, so that the same come with any");
    field("cmaes", self.cmaes, "evolution strategy with restarts");
    field("surrogate", self.surrogate, "Kriging, for small budgets");
    field("polish", self.polish, "local search from the best points");
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
