#pragma once

#include <array>
#include <string_view>

#include "rift/search/options.hpp"

namespace rift::sweep {

/// When a search for failures is done, if its budget lasts so long.
enum class Until { kFirst, kBudget };
constexpr std::array<std::string_view, 2> EnumNames(Until) { return {"first", "budget"}; }

/// How a search is made and what it may cost.
struct SearchPlan : search::SearchOptions {
  int budget = 500;
  double max_s = 0.0;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("budget", self.budget, 1, 1'000'000, "settings to be tried at most");
    field("max_s", self.max_s, 0.0, 1e9,
          "no new settings are tried after this long on the wall clock; 0: no limit");
    search::SearchOptions::Fields(self, field);
  }
};

/// What counts as a falsification, and how sure it must be.
struct FalsifyOptions {
  Until until = Until::kFirst;
  bool falls_count = false;
  int most_repeats = 6;
  double near_m = 0.005;
  double share = 0.5;
  double confidence = 0.95;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("until", self.until, "stop at the first falsified setting, or map them all");
    field("falls_count", self.falls_count, "a trial in which the robot fell counts as falsified");
    field("most_repeats", self.most_repeats, 1, 1000,
          "trials of a setting, each with random numbers of its own, when the first of them fails "
          "or is near the threshold (6 that agree decide at 95 %)");
    field("near_m", self.near_m, 0.0, 1000.0, "so near the threshold a setting is repeated");
    field("share", self.share, 0.0, 1.0,
          "a setting is falsified when more than this share of all its trials would fail");
    field("confidence", self.confidence, 0.5, 0.999999,
          "of falsified and not falsified; between them a setting is undecided");
  }
};

}  // namespace rift::sweep
