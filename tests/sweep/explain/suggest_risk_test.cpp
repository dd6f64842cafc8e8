// What is suggested to be driven, with risks worked by hand: the share of failing runs lies evenly
// below or above a tenth, and each count of failures weighs by its binomial likelihood.
#include <catch2/catch.hpp>

#include "rift/sweep/explain/suggest.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

struct Setting {
  const char* surface;
  int failures, runs;
  double gap_m = 0.08;
};

/// Runs at surfaces that a person lays, each a path of its own, and a key that nobody sets.
SweepResult Of(const std::vector<Setting>& settings, const char* reference_kind) {
  SweepResult result;
  result.reference_kind = reference_kind;
  result.parameters = {{.key = "simulation.terrain.surface"},
                       {.key = "simulation.motor.mismatch", .levels = {{"0", 0.0}}}};
  std::uint64_t path = 1;
  for (const Setting& setting : settings) {
    result.parameters[0].levels.push_back({setting.surface, {}});
    for (int i = 0; i < setting.runs; ++i) {
      TrialRow row{.theta = {{setting.surface, {}}, {"0", 0.0}}, .seed = path};
      row.falsified = i < setting.failures;
      row.comparison.gap_m = row.falsified ? setting.gap_m : 0.04;
      row.evidence.fingerprint = path++;
      result.rows.push_back(row);
    }
  }
  Summarise(result);
  return result;
}

Suggestions All(const SweepResult& result, const std::vector<RobotTrials>& robot = {}) {
  return SuggestExperiments(result, {.experiments = 20, .repeats = 3, .least_gain = 0.0}, robot);
}

TEST_CASE("Of logs the risk is that of the runs, now and after three more") {
  const Suggestions suggestions = All(Of({{"rare", 0, 4}, {"one", 1, 3}}, "logs"));
  CHECK(suggestions.trusted == 1.0);
  REQUIRE(suggestions.list.size() == 2);
  const Suggestion &one = suggestions.list[0], &rare = suggestions.list[1];
  CHECK(one.values[0].text == "one");
  CHECK(one.fails_now == Approx(0.6681472081218274));
  CHECK(one.wrong_now == Approx(0.33185279187817257));
  CHECK(one.wrong_after == Approx(0.16831218274111676));
  CHECK(one.is_predicted_to_fail);
  CHECK(one.failures == 1);
  CHECK(one.mean_loss_m == Approx((0.08 + 0.04 + 0.04) / 3.0));
  CHECK(one.rows == std::vector<int>{4, 5, 6});
  CHECK(one.repeats == 3);
  CHECK(one.sentence ==
        "3 trials of surface one: 1 of 3 runs failed there; does the robot fail in more than 10 % "
        "of its runs? 67 % likely so far, and the risk of calling it wrongly falls from 33 to 17 "
        "%");
  CHECK(rare.fails_now == Approx(0.13809142953359152));
  CHECK(rare.wrong_now == Approx(0.13809142953359152));
  CHECK(rare.wrong_after == Approx(0.0697078632766459));
  CHECK_FALSE(rare.is_predicted_to_fail);
  CHECK(suggestions.note == "not set by a person, as they are on the robot: mismatch");
}

TEST_CASE("Of a simulator half a belief is kept until the robot has borne one out") {
  const SweepResult result = Of({{"ice", 4, 4}, {"rock", 0, 4}}, "nominal");
  const Suggestions suggestions = All(result);
  CHECK(suggestions.trusted == 0.5);
  REQUIRE(suggestions.list.size() == 2);
  const Suggestion &rock = suggestions.list[0], &ice = suggestions.list[1];  // the best first
  CHECK(ice.values[0].text == "ice");
  CHECK(ice.fails_now == Approx(0.749955003599712));
  CHECK(ice.wrong_now == Approx(0.250044996400288));
  CHECK(ice.wrong_after == Approx(0.1717481101511879));
  CHECK(ice.sentence.find("4 of 4 simulated runs failed there") != std::string::npos);
  CHECK(rock.fails_now == Approx(0.3190457147667958));
  CHECK(rock.wrong_after == Approx(0.14860393163832294));
}

TEST_CASE("One trial is a trial, and its gain is what it takes itself") {
  const SweepResult result = Of({{"one", 1, 3}}, "logs");
  const Suggestion one = SuggestExperiments(result, {.repeats = 1, .least_gain = 0.0}).list.at(0);
  CHECK(one.wrong_after == Approx(0.31725888324873097));
  CHECK(one.sentence.starts_with("1 trial of surface one: "));
  const double gain = 0.33185279187817257 - 0.31725888324873097;
  CHECK(SuggestExperiments(result, {.repeats = 1, .least_gain = gain - 1e-9}).list.size() == 1);
  CHECK(SuggestExperiments(result, {.repeats = 1, .least_gain = gain + 1e-9}).list.empty());
  // Of three trials each takes a third.
  const double third = (0.33185279187817257 - 0.16831218274111676) / 3.0;
  CHECK(SuggestExperiments(result, {.repeats = 3, .least_gain = third - 1e-9}).list.size() == 1);
  const Suggestions none = SuggestExperiments(result, {.repeats = 3, .least_gain = third + 1e-9});
  CHECK(none.list.empty());
  CHECK(
      none.note.starts_with("of 1 settings that can be set none is worth a trial: each would "
                            "take less than 5.45135 points from the risk of a wrong call"));
}

TEST_CASE("Half of the places, rounded up, are for predicted failures, whatever they gain") {
  // The gain of "passes" is the largest, and those of the failures are equal: the loss decides.
  const SweepResult result = Of(
      {{"passes", 0, 1}, {"near", 1, 1, 0.07}, {"far", 1, 1, 0.09}, {"second", 0, 2}}, "nominal");
  const auto chosen = [&](int experiments) {
    std::string names;
    for (const Suggestion& one :
         SuggestExperiments(result, {.experiments = experiments, .least_gain = 0.0}).list) {
      names += one.values[0].text + " ";
    }
    return names;
  };
  CHECK(chosen(1) == "far ");
  CHECK(chosen(2) == "passes far ");
  CHECK(chosen(3) == "passes far near ");
  CHECK(chosen(4) == "passes second far near ");
  CHECK(chosen(9) == chosen(4));
}

TEST_CASE("Reserved places go to the best predicted failures, and the others to the best of all") {
  const auto chosen = [](const std::vector<Setting>& settings, int experiments) {
    std::string names;
    for (const Suggestion& one : SuggestExperiments(Of(settings, "nominal"),
                                                    {.experiments = experiments, .least_gain = 0.0})
                                     .list) {
      names += one.values[0].text + " ";
    }
    return names;
  };
  // Of equal gain: the loss decides.
  const std::vector<Setting> failing{{"d", 1, 1, 0.07},
                                     {"b", 1, 1, 0.09},
                                     {"e", 1, 1, 0.065},
                                     {"a", 1, 1, 0.1},
                                     {"c", 1, 1, 0.08}};
  CHECK(chosen(failing, 3) == "a b c ");
  CHECK(chosen(failing, 4) == "a b c d ");
  // Gains of three trials: 0.321, 0.310, 0.251, 0.210, 0.186, 0.122.
  const std::vector<Setting> mixed{{"1st", 1, 5},   {"2nd", 1, 4}, {"3rd", 1, 3},
                                   {"holds", 0, 2}, {"4th", 1, 2}, {"5th", 1, 1}};
  CHECK(chosen(mixed, 5) == "1st 2nd 3rd holds 4th ");
  CHECK(chosen(mixed, 3) == "1st 2nd 3rd ");
}

TEST_CASE("A setting is predicted to fail above the share that is asked about, not at it") {
  const auto is_predicted = [](int failures, int runs, double share) {
    SweepResult result = Of({{"s", failures, runs}}, "nominal");
    result.judged_by.share = share;
    return All(result).list.at(0).is_predicted_to_fail;
  };
  CHECK_FALSE(is_predicted(1, 4, 0.25));
  CHECK(is_predicted(2, 4, 0.25));
  CHECK(is_predicted(1, 3, 0.25));
  CHECK_FALSE(is_predicted(0, 3, 0.25));
}

TEST_CASE("Trust is one more than what was borne out over two more than what was told") {
  const SweepResult result = Of({{"ice", 4, 4}}, "nominal");
  const auto trust = [&](const std::vector<RobotTrials>& robot) {
    return All(result, robot).trusted;
  };
  const experiment::Theta at{{"elsewhere", {}}};
  CHECK(trust({{at, true, 3, 3}}) == Approx(2.0 / 3.0));
  CHECK(trust({{at, false, 3, 3}}) == Approx(1.0 / 3.0));
  CHECK(trust({{at, false, 5, 0}}) == Approx(2.0 / 3.0));
  CHECK(trust({{at, true, 0, 0}}) == Approx(0.5));  // no trial tells
  CHECK(trust({{at, true, 3, 3}, {at, false, 3, 3}, {at, true, 2, 2}}) == Approx(3.0 / 5.0));
}

TEST_CASE("What the robot did at a setting itself counts beside the prediction") {
  const SweepResult result = Of({{"ice", 1, 1}, {"rock", 1, 1}}, "nominal");
  const RobotTrials untold{{{"ice", {}}}, true, 0, 0}, passed{{{"ice", {}}}, true, 3, 0};
  CHECK(All(result, {untold}).list.at(0).fails_now == Approx(0.7083333333333333));
  for (const Suggestion& one : All(result, {passed}).list) {
    // Of rock a third of the belief is left: the robot has not borne out what was predicted.
    const double prior = (0.9166666666666666 + 2.0 * 0.5) / 3.0;
    if (one.values[0].text == "rock") CHECK(one.fails_now == Approx(prior));
    // 0 of 3: (1 - q)^3 / 4 above, (1 - (1 - q)^4) / (4 q) below.
    const double above = prior * 0.729 / 4.0, below = (1.0 - prior) * (1.0 - 0.6561) / 0.4;
    if (one.values[0].text == "ice") CHECK(one.fails_now == Approx(above / (above + below)));
  }
}

TEST_CASE("What the robot did counts for its setting however its numbers are written") {
  SweepResult result;
  result.reference_kind = "nominal";
  result.parameters = {{.key = "control.v_min", .min = 0.1, .max = 0.3}};
  result.rows = {TrialRow{.theta = {experiment::NumberValue(0.2)}, .seed = 1}};
  result.rows[0].comparison.gap_m = 0.04;
  Summarise(result);
  const auto fails_now = [&](const experiment::ParameterValue& driven) {
    return All(result, {{{driven}, false, 1, 0}}).list.at(0).fails_now;
  };
  const double there = fails_now({"0.2", 0.2}), elsewhere = fails_now({"0.21", 0.21});
  CHECK(there < elsewhere - 0.1);
  CHECK(fails_now({"0.20", 0.2}) == there);
  CHECK(fails_now({"2e-1", 0.2}) == there);
}

TEST_CASE("Runs are the same by their path and their loss, and without a path never") {
  SweepResult result = Of({{"ice", 2, 2}, {"rock", 2, 2}}, "nominal");
  const auto with_paths = [&](std::uint64_t first, std::uint64_t second) {
    for (size_t i = 0; i < 4; ++i) {
      result.rows[i].evidence.fingerprint = i % 2 == 0 ? first : second;
    }
    return All(result);
  };
  CHECK(with_paths(0, 0).list.size() == 2);
  const Suggestions same = with_paths(7, 8);
  CHECK(same.list.size() == 1);
  CHECK_THAT(same.note, Catch::Contains("1 left out as the same runs to the last bit"));
  result.rows[3].comparison.gap_m = 0.09;  // against another reference
  CHECK(with_paths(7, 8).list.size() == 2);
}

TEST_CASE("A sweep without parameters suggests its only setting") {
  SweepResult result = Of({{"ice", 1, 2}}, "nominal");
  result.parameters.clear();
  for (TrialRow& row : result.rows) row.theta.clear();
  Summarise(result);
  const Suggestions suggestions = All(result);
  REQUIRE(suggestions.list.size() == 1);
  CHECK(suggestions.list[0].values.empty());
  CHECK(suggestions.list[0].failures == 1);
  CHECK(suggestions.list[0].sentence.starts_with("3 trials of the only setting: 1 of 2 "));
}

TEST_CASE("The robot's settings are judged together with those that were driven, and no others") {
  const auto judged = [](std::vector<RobotTrials> robot) {
    for (int i = 0; i < 4; ++i) robot.push_back({.is_predicted_to_fail = true});  // not driven
    return JudgeRobotTrials(robot, {});
  };
  // Two failures of two speak 22 to 1 against one failure in ten: one setting needs 20, two 40.
  const std::vector<gap::RepeatVerdict> alone = judged({{{}, true, 2, 2}});
  REQUIRE(alone.size() == 5);
  CHECK(alone[0].settings == 1);
  CHECK(alone[0].verdict == gap::Verdict::kFalsified);
  CHECK(alone[4].verdict == gap::Verdict::kUndecided);
  const std::vector<gap::RepeatVerdict> beside = judged({{{}, true, 2, 2}, {{}, true, 1, 0}});
  CHECK(beside[0].settings == 2);
  CHECK(beside[0].verdict == gap::Verdict::kUndecided);
}

}  // namespace
}  // namespace rift::sweep
