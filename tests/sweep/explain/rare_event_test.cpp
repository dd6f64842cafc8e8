// Rare events over an experiment's space, and how often random draws fail.
#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "rift/statistics/inference.hpp"
#include "rift/sweep/explain/failure_probability.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "support/pinned.hpp"

namespace rift::sweep {
namespace {

TrialRow Draw(double x, TrialStatus status, bool falsified) {
  TrialRow row{.theta = {experiment::NumberValue(x)}, .status = status, .falsified = falsified};
  row.is_random_draw = true;
  return row;
}

TEST_CASE("Of each drawn setting the first trial that tells counts") {
  SweepResult result;
  result.parameters = {{.key = "x", .min = 0.0, .max = 1.0}};
  using enum TrialStatus;
  result.rows = {Draw(0.1, kOk, true),       Draw(0.1, kOk, false),     // fails
                 Draw(0.2, kCrashed, false), Draw(0.2, kFell, true),    // fails, the second
                 Draw(0.3, kOk, false),      Draw(0.3, kOk, true),      // passes
                 Draw(0.4, kHung, false),    Draw(0.4, kHung, false),   // does not tell
                 Draw(0.5, kOk, false),      Draw(0.6, kFell, false)};  // passes; does not tell
  TrialRow chosen = Draw(0.7, kOk, true);
  chosen.is_random_draw = false;
  result.rows.push_back(chosen);
  Summarise(result);
  const FailureProbability found = EstimateFailureProbability(result);
  CHECK(found.draws == 4);
  CHECK(found.failures == 2);
  CHECK(found.untold == 2);
  CHECK(found.share == 0.5);
  CHECK(found.low == Approx(0.067586).margin(1e-6));  // R: binom.test(2, 4)
  CHECK(found.high == Approx(0.932414).margin(1e-6));
  CHECK(found.sentence ==
        "Over the space 50 % of the runs fail, between 6.76 and 93.2 % with 95 % confidence "
        "(Clopper-Pearson, 2 of 4 runs, each at a setting drawn at random; 2 more do not tell)");
  result.rows.resize(2);
  Summarise(result);
  CHECK(
      EstimateFailureProbability(result).sentence.ends_with("each at a setting drawn at random)"));
}

TEST_CASE("Draws of which none tells are not said to be chosen, and chosen settings not drawn") {
  const auto sentence = [](bool is_drawn) {
    SweepResult result;
    result.parameters = {{.key = "x", .min = 0.0, .max = 1.0}};
    result.rows = {Draw(0.1, TrialStatus::kCrashed, false), Draw(0.2, TrialStatus::kHung, false)};
    for (TrialRow& row : result.rows) row.is_random_draw = is_drawn;
    Summarise(result);
    const FailureProbability found = EstimateFailureProbability(result);
    CHECK(found.draws == 0);
    CHECK(found.untold == (is_drawn ? 2 : 0));
    CHECK(std::isnan(found.share));
    CHECK(found.low == 0.0);
    CHECK(found.high == 1.0);
    return found.sentence;
  };
  CHECK(sentence(true) ==
        "How often it fails over the whole space is not known: the settings were drawn at random, "
        "and none of their trials tells");
  CHECK(sentence(false) ==
        "How often it fails over the whole space is not known: the settings were chosen, not drawn "
        "at random");
}

experiment::Experiment Plan() {
  experiment::Experiment plan;
  plan.seed = 5;
  plan.space.parameters = {{.key = "x", .min = -2.0, .max = 6.0},
                           {.key = "n", .min = 1.0, .max = 4.0, .is_integer = true},
                           {.key = "s", .levels = {{"a", {}}, {"b", {}}}},
                           {.key = "l", .min = 1.0, .max = 100.0, .is_logarithmic = true}};
  plan.reference.trials.names = {"p", "q"};
  return plan;
}

TEST_CASE(
    "Runs of a rare event are drawn evenly over every kind of axis, with seeds of their own") {
  std::vector<TrialRequest> asked;
  const RareEvent event =
      EstimateRareEvent(Plan(),
                        [&](const std::vector<TrialRequest>& requests) {
                          std::vector<TrialRow> rows;
                          for (const TrialRequest& request : requests) {
                            asked.push_back(request);
                            rows.push_back(RowFor(request));
                            rows.back().falsified = *request.theta[0].number > 4.0;
                            rows.back().comparison.gap_m = rows.back().falsified ? 0.08 : 0.04;
                          }
                          return rows;
                        },
                        {.replicas = 5, .samples_per_level = 400, .level_share = 0.1});
  CHECK(event.levels == 1);
  CHECK(event.evaluations == 2000);
  CHECK(event.is_reached);
  CHECK(event.probability == Approx(0.25).margin(0.03));
  const statistics::Interval exact = statistics::ClopperPearson(
      static_cast<int>(std::lround(event.probability * 2000)), 2000, 0.95);
  CHECK(event.low == Approx(exact.low));
  CHECK(event.high == Approx(exact.high));
  REQUIRE(asked.size() == 2000);
  std::set<std::uint64_t> seeds;
  std::map<std::string, int> whole, words;
  double below_ten = 0.0, least = 9.0, most = -9.0;
  for (size_t i = 0; i < asked.size(); ++i) {
    seeds.insert(*asked[i].seed);
    CHECK(asked[i].seed == FreshSeed(5, i + 1));
    CHECK(asked[i].trial == (i % 2 == 0 ? "p" : "q"));
    least = std::min(least, *asked[i].theta[0].number);
    most = std::max(most, *asked[i].theta[0].number);
    ++whole[asked[i].theta[1].text];
    ++words[asked[i].theta[2].text];
    below_ten += *asked[i].theta[3].number < 10.0;
  }
  CHECK(seeds.size() == 2000);
  CHECK(least == Approx(-2.0).margin(0.05));
  CHECK(most == Approx(6.0).margin(0.05));
  REQUIRE(whole.size() == 4);
  for (const auto& [value, n] : whole) CHECK(n == Approx(500).margin(90));  // 4.6 sigma
  CHECK(words["a"] == Approx(1000).margin(100));
  CHECK(words["b"] == Approx(1000).margin(100));
  CHECK(below_ten == Approx(1000).margin(100));
}

TEST_CASE("The points of a rare event are those of the experiment's seed") {
  const auto points = [](std::uint64_t seed) {
    experiment::Experiment plan = Plan();
    plan.seed = seed;
    std::vector<experiment::Theta> asked;
    EstimateRareEvent(plan,
                      [&](const std::vector<TrialRequest>& requests) {
                        std::vector<TrialRow> rows;
                        for (const TrialRequest& request : requests) {
                          asked.push_back(request.theta);
                          rows.push_back(RowFor(request));
                          rows.back().comparison.gap_m = 0.04;
                        }
                        return rows;
                      },
                      {.replicas = 4, .samples_per_level = 20, .most_levels = 1});
    return asked;
  };
  CHECK(points(5) == points(5));
  CHECK(points(5) != points(6));
}

TEST_CASE("Where half of the first draws fail they alone are counted, and with one less all") {
  const auto evaluations = [](size_t failures) {
    return EstimateRareEvent(1,
                             [&](const auto& points) {
                               std::vector<double> values;
                               for (size_t i = 0; i < points.size(); ++i) {
                                 values.push_back(i % 20 < failures ? -1.0 : 1.0);
                               }
                               return values;
                             },
                             1, {.replicas = 4, .samples_per_level = 20})
        .evaluations;
  };
  CHECK(evaluations(10) == 20);
  CHECK(evaluations(9) == 80);
}

std::vector<double> Each(const std::vector<std::vector<double>>& points, double share) {
  std::vector<double> values;
  for (const std::vector<double>& point : points) values.push_back(point[0] - share);
  return values;
}

TEST_CASE("Runs that do not tell are no part of draws that are counted, and are told") {
  // Of every 20 draws two do not tell.
  const auto counted = [](int failures) {
    return EstimateRareEvent(
        1,
        [&](const auto& points) {
          std::vector<double> values;
          for (int i = 0; i < static_cast<int>(points.size()); ++i) {
            values.push_back(i % 20 < failures ? -1.0 : i % 20 < 18 ? 1.0 : NAN);
          }
          return values;
        },
        1, {.replicas = 4, .samples_per_level = 20});
  };
  const RareEvent some = counted(6), most = counted(18);
  CHECK(some.levels == 1);
  CHECK(some.evaluations == 80);
  CHECK(some.untold == 8);
  CHECK(some.probability == Approx(24.0 / 72.0));
  const statistics::Interval share = statistics::ClopperPearson(24, 72, 0.95);
  CHECK(some.low == share.low);
  CHECK(some.high == share.high);
  CHECK(most.evaluations == 20);
  CHECK(most.untold == 2);
  CHECK(most.probability == 1.0);
  CHECK(most.high == 1.0);
  // In levels they lie beyond each of them.
  const RareEvent rare = EstimateRareEvent(1,
                                           [](const auto& points) {
                                             std::vector<double> values = Each(points, 1e-3);
                                             for (double& value : values)
                                               value = value > 0.8 ? NAN : value;
                                             return values;
                                           },
                                           11, {});
  CHECK(rare.levels > 1);
  CHECK(rare.untold > 0.15 * 8 * 300);  // a fifth of the draws, and few of what is asked later
  CHECK(rare.untold < 0.25 * 8 * 300);
  CHECK(std::log10(rare.probability) == Approx(-3.0).margin(0.2));
}

TEST_CASE("A probability of a thousandth takes three levels of a tenth") {
  const RareEvent event = EstimateRareEvent(
      1, [](const auto& points) { return Each(points, 1e-3); }, 11, {.replicas = 12});
  CHECK(event.is_reached);
  CHECK(event.levels >= 3);
  CHECK(event.levels <= 4);
  CHECK(std::log10(event.probability) == Approx(-3.0).margin(0.15));
  CHECK(event.low < 1e-3);
  CHECK(event.high > 1e-3);
  // Even in the logarithm around the estimate.
  CHECK(event.low * event.high == Approx(event.probability * event.probability));
  CHECK(event.coefficient_of_variation > 0.0);
  CHECK(event.coefficient_of_variation < 0.3);
}

TEST_CASE("Fewer levels, or a smaller share of each, reach as far as their product") {
  const RareEvent bound = EstimateRareEvent(
      1, [](const auto& points) { return Each(points, 1e-9); }, 3, {.most_levels = 2});
  CHECK_FALSE(bound.is_reached);
  CHECK(bound.levels == 2);
  CHECK(bound.high == Approx(0.01).epsilon(0.05));
  CHECK(std::isnan(bound.probability));
  CHECK(bound.low == 0.0);
  const RareEvent half = EstimateRareEvent(1, [](const auto& points) { return Each(points, 1e-9); },
                                           3, {.level_share = 0.5, .most_levels = 3});
  CHECK(half.high == Approx(0.125).epsilon(0.05));
}

TEST_CASE("What no draw announces lies below the bound, though all levels lead past it") {
  int missed = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const RareEvent event = EstimateRareEvent(
        1,
        [](const auto& points) {
          std::vector<double> values;
          for (const std::vector<double>& point : points) {
            values.push_back(point[0] > 0.3 && point[0] < 0.3002 ? -0.1 : 0.05 + point[0]);
          }
          return values;
        },
        seed);
    if (event.is_reached) continue;
    ++missed;
    CHECK(std::isnan(event.probability));
    CHECK(event.low == 0.0);
    // None of 8 x 300 draws fails: 1 - 0.05^(1 / 2400).
    CHECK(event.high == Approx(1.0 - std::pow(0.05, 1.0 / 2400.0)));
  }
  CHECK(missed >= 4);  // 7.4 expected
}

TEST_CASE("Draws that do not tell bound nothing") {
  // Of every 20 draws five tell, and hold.
  const RareEvent event =
      EstimateRareEvent(1,
                        [](const auto& points) {
                          std::vector<double> values;
                          for (size_t i = 0; i < points.size(); ++i) {
                            values.push_back(i % 20 < 5 ? 1.0 + points[i][0] : NAN);
                          }
                          return values;
                        },
                        1, {.replicas = 4, .samples_per_level = 20});
  CHECK_FALSE(event.is_reached);
  CHECK(event.high >= Approx(1.0 - std::pow(0.05, 1.0 / 20.0)));
}

TEST_CASE("A run of a rare event fails where it is falsified: not at the threshold, at the goal") {
  const auto of = [](const TrialRow& end) {
    return EstimateRareEvent(Plan(),
                             [&](const std::vector<TrialRequest>& requests) {
                               std::vector<TrialRow> rows(requests.size(), end);
                               return rows;
                             },
                             {.replicas = 4, .samples_per_level = 20, .most_levels = 2});
  };
  TrialRow at_threshold;
  at_threshold.comparison.gap_m = Plan().gap.threshold_m;
  CHECK_FALSE(of(at_threshold).is_reached);
  TrialRow at_goal{.status = TrialStatus::kTimedOut, .falsified = true, .left_m = 0.0};
  CHECK(of(at_goal).probability == 1.0);
  at_goal.falsified = false;  // does not count: falsify.count
  CHECK_FALSE(of(at_goal).is_reached);
  CHECK(of(at_goal).untold == of(at_goal).evaluations);
}

TEST_CASE("A loss at the threshold is a failure, one without a value is none, no axis is refused") {
  const auto of = [](double value) {
    return EstimateRareEvent(
        1, [=](const auto& points) { return std::vector<double>(points.size(), value); }, 1,
        {.replicas = 4, .samples_per_level = 20, .most_levels = 2});
  };
  CHECK(of(0.0).probability == 1.0);
  CHECK(of(0.0).levels == 1);
  CHECK_FALSE(of(1e-9).is_reached);
  CHECK_FALSE(of(NAN).is_reached);
  CHECK_THROWS_WITH(EstimateRareEvent(0, {}, 1),
                    "a rare event needs a space of at least one "
                    "parameter");
}

TEST_CASE("Estimates of rare events, and the points they ask for, are those that were approved") {
  struct Case {
    const char* name;
    int dimensions;
    RareEventOptions options;
    std::function<double(const std::vector<double>&)> robustness;
  };
  const auto corner = [](const std::vector<double>& x) { return std::max(x[0], x[1]) - 0.02; };
  const std::vector<Case> cases{
      {"a corner", 2, {.replicas = 4, .samples_per_level = 60}, corner},
      {"wide steps",
       2,
       {.replicas = 5, .samples_per_level = 47, .level_share = 0.2, .step = 0.7},
       corner},
      {"two corners",
       3,
       {.replicas = 4, .samples_per_level = 80},
       [](const std::vector<double>& x) {
         return std::min({x[0] + x[1], 1.98 - x[0] - x[1] + x[2], 1.0}) - 0.03;
       }},
      {"steps",
       1,
       {.replicas = 4, .samples_per_level = 50, .level_share = 0.3},
       [](const std::vector<double>& x) { return std::floor(8.0 * x[0]) / 8.0 - 0.1; }},
      {"holes",
       2,
       {.replicas = 4, .samples_per_level = 60, .most_levels = 3},
       [](const std::vector<double>& x) {
         return std::sin(40.0 * x[1]) > 0.8 ? NAN : x[0] * x[0] - 1e-6;
       }}};
  std::string text;
  for (const Case& one : cases) {
    double sum = 0.0, weighted = 0.0;
    int asked = 0;
    const RareEvent event = EstimateRareEvent(
        one.dimensions,
        [&](const std::vector<std::vector<double>>& points) {
          std::vector<double> values;
          for (const std::vector<double>& point : points) {
            for (const double x : point) sum += x, weighted += x * (++asked % 101);
            values.push_back(one.robustness(point));
          }
          return values;
        },
        21, one.options);
    text += fmt::format(
        "{}: {:.9g} in [{:.9g}, {:.9g}], variation {:.9g}, levels {}, runs {}, {}\n", one.name,
        event.probability, event.low, event.high, event.coefficient_of_variation, event.levels,
        event.evaluations, event.is_reached ? "reached" : "bounded");
    text += fmt::format("  {} coordinates, {:.9g}, {:.9g}\n", asked, sum, weighted);
  }
  CHECK(test::DifferenceFromPinned("sweep/rare_events.txt", text) == "");
}

}  // namespace
}  // namespace rift::sweep
