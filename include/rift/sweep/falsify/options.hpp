#pragma once

#include <array>
#include <string_view>

#include "rift/gap/options.hpp"
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

/// Ends of a trial that count as failures beside a gap above the threshold.
struct CountOptions {
  bool timed_out = true;
  bool fell = true;
  bool left_arena = true;
  bool lost = true;
  bool stop = false;

  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("timed_out", self.timed_out, "the robot did not arrive in time");
    field("fell", self.fell, "it fell");
    field("left_arena", self.left_arena, "it left the arena");
    field("lost", self.lost, "motion capture saw it no more");
    field(
        "stop", self.stop,
        "a gap above the threshold where two runs stopped short of the last waypoint, both within "
        "control.reach_radius_m, and nowhere on the way");
  }
};

/// Which settings are repeated until they are decided.
enum class Repeat { kNone, kDoubtful, kEvery };
constexpr std::array<std::string_view, 3> EnumNames(Repeat) {
  return {"none", "doubtful", "every"};
}

/// What counts as a falsification, and how sure it must be.
struct FalsifyOptions : gap::VerdictOptions {
  Until until = Until::kFirst;
  CountOptions count;
  Repeat repeat = Repeat::kDoubtful;
  int most_repeats = 100;
  double near_m = 0.005;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("until", self.until, "stop at the first falsified setting, or map them all");
    field("count", self.count, "which ends of a trial count as failures");
    field("repeat", self.repeat,
          "settings that get further trials until they are decided: none; in a search those with a "
          "failure or near the threshold; every one, in a grid of simulated trials too");
    field("most_repeats", self.most_repeats, 1, 100'000,
          "trials of a setting at most, each with random numbers of its own");
    field("near_m", self.near_m, 0.0, 1000.0,
          "so near the threshold a setting without a failure is looked at again");
    gap::VerdictOptions::Fields(self, field);
  }
};

}  // namespace rift::sweep
