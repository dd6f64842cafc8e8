// Words about sweeps at the numbers from which on they are others, and on both sides of them.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "report/synthetic_sweep.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/findings.hpp"
#include "rift/report/text/sweep_change.hpp"
#include "rift/report/text/text.hpp"
#include "rift/report/text/trial_query.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using Catch::Matchers::EndsWith;
using Catch::Matchers::StartsWith;
using nlohmann::json;

/// A setting for each list, of runs with these gaps.
sweep::SweepResult Settings(const std::vector<std::vector<double>>& gaps_m) {
  sweep::SweepResult result;
  result.parameters = {{"terrain.surface", {}}};
  std::uint64_t path = 1;
  for (size_t i = 0; i < gaps_m.size(); ++i) {
    result.parameters[0].levels.push_back(synthetic::Word(fmt::format("s{}", i)));
    for (size_t k = 0; k < gaps_m[i].size(); ++k) {
      result.rows.push_back(synthetic::Row({result.parameters[0].levels.back()},
                                           std::to_string(k + 1), gaps_m[i][k]));
      result.rows.back().evidence.fingerprint = path++;
    }
  }
  sweep::Summarise(result);
  return result;
}

TEST_CASE(
    "The worst row is the one that --shrink and --replay take, and a larger gap is told beside") {
  sweep::SweepResult result = Settings({{0.02, 0.07}, {0.04}});
  CHECK_THAT(SweepText(result),
             Contains("\nworst: row 2, 0.0700 m at u = ") && !Contains("largest gap:"));
  for (const size_t i : {size_t{0}, size_t{1}}) {
    result.rows[i].status = sweep::TrialStatus::kTimedOut;
    result.rows[i].falsified = true;
    result.rows[i].comparison = {};
  }
  sweep::Summarise(result);
  CHECK_THAT(SweepText(result), Contains("\nworst: row 1, timed_out (surface s0, trial 1)\n"
                                         "largest gap: row 3, 0.0400 m at u = "));
  result.rows.resize(2);
  sweep::Summarise(result);
  CHECK_THAT(SweepText(result), Contains("\nworst: row 1, timed_out (surface s0, trial 1)\n") &&
                                    !Contains("largest gap:"));
}

TEST_CASE("Chance that picks among a few fixed runs is told where it is asked how sure all is") {
  sweep::SweepResult result = Settings({{0.02, 0.07}, {0.04}});
  const std::string told =
      "- Chance picks among a few fixed runs here: repeats that are the same are draws, and each "
      "counts.\n";
  CHECK_THAT(ExplanationText(result, sweep::Explain(result), false), !Contains(told));
  result.chance_repeats_runs = true;
  CHECK_THAT(ExplanationText(result, sweep::Explain(result), false), Contains(told));
}

TEST_CASE(
    "A table of more than forty values holds those with the largest means, unknown ones last") {
  std::vector<std::vector<double>> gaps_m;
  for (int i = 0; i < 40; ++i) gaps_m.push_back({0.01 + 0.001 * i});
  const std::string whole = SweepText(Settings(gaps_m));
  CHECK_THAT(whole, Contains("surface  mean_gap_m  failures  trials  without_gap\n"
                             "s0           0.0100         0       1            0\n"
                             "s1           0.0110 ") &&
                        !Contains("more, all of them"));
  gaps_m.push_back({0.0155});
  gaps_m.push_back({0.02});
  sweep::SweepResult result = Settings(gaps_m);
  synthetic::LoseGap(&result.rows.back(), "gone");
  sweep::Summarise(result);
  const std::string cut = SweepText(result);
  CHECK_THAT(cut, Contains("without_gap\ns39          0.0490         0       1            0\n"
                           "s38          0.0480 ") &&
                      Contains("s1           0.0110         0       1            0\n"
                               "and 2 more, all of them in summary.json\n"));
  CHECK_THAT(cut, Contains("s6           0.0160 ") && Contains("s40          0.0155 "));
}

TEST_CASE("A share within one per cent of none or all is told with its digits") {
  const auto headline = [](int failures, size_t all) {
    std::vector<double> gaps_m(all, 0.05);
    std::fill_n(gaps_m.begin(), failures, 0.07);
    return Summary(Settings({gaps_m})).sentence.Text();
  };
  CHECK_THAT(headline(1, 200),
             Contains("It fails: 1 of 200 measured trials exceed 0.06 m (0.50 %)"));
  CHECK_THAT(headline(299, 300), Contains("299 of 300 measured trials exceed 0.06 m (99.67 %)"));
  CHECK_THAT(headline(99, 100), Contains("99 of 100 measured trials exceed 0.06 m (99 %)"));
  CHECK_THAT(headline(1, 100), Contains("1 of 100 measured trials exceed 0.06 m (1 %)"));
  CHECK_THAT(headline(1, 1), Contains("1 of 1 measured trial exceed 0.06 m (100 %)"));
  CHECK_THAT(headline(0, 1), Contains("none of 1 measured trial exceeds"));
}

/// Twelve settings whose gaps are the noise and `more_m` beyond it in the mean, give or take 10 mm.
std::string BesideScatter(double noise_m, double more_m) {
  std::vector<std::vector<double>> gaps_m;
  for (int i = 0; i < 12; ++i) gaps_m.push_back({noise_m + more_m + (i % 2 == 0 ? 0.01 : -0.01)});
  sweep::SweepResult result = Settings(gaps_m);
  result.reference_kind = "logs";
  for (sweep::SettingResult& setting : result.settings) setting.noise_floor_m = noise_m;
  return Summary(result).sentence.Text();
}

TEST_CASE("A gap is further than the robot from itself beyond doubt, or as near within a quarter") {
  // Student's interval of twelve values of +-10 mm: 2.201 x 10 mm / sqrt(11) = 6.636 mm.
  CHECK_THAT(BesideScatter(0.02, 0.0067), StartsWith("Further from the robot than the robot from "
                                                     "itself: over the settings a mean gap of "
                                                     "0.0267 m against 0.0200 m between its own "
                                                     "runs, difference +0.0067 m (0.0001 to "
                                                     "0.0133). "));
  CHECK_THAT(BesideScatter(0.02, 0.0066), StartsWith("It cannot be told"));
  CHECK_THAT(BesideScatter(0.0264, 0.0), StartsWith("It cannot be told"));
  CHECK_THAT(BesideScatter(0.0267, 0.0), StartsWith("As near to the robot as the robot to itself"));
}

TEST_CASE("Where it fails names the three worst settings by their share, and counts the others") {
  const auto where = [](const std::vector<std::vector<double>>& gaps_m) {
    const sweep::SweepResult result = Settings(gaps_m);
    const std::string text = BriefText(result, {});
    const size_t begin = text.find("where:");
    return text.substr(begin, text.find('\n', begin) - begin);
  };
  const double bad = 0.07, ok = 0.05;
  const std::vector<double> third{bad, ok, ok + 0.001}, half{bad, ok}, all{bad, bad + 0.001};
  CHECK(where({third, {ok}, half, all}) ==
        "where:      surface s3 (2 of 2 failed); surface s2 (1 of 2 failed); surface s0 (1 of 3 "
        "failed)");
  CHECK(where({third, half, half, all}) ==
        "where:      surface s3 (2 of 2 failed); surface s1 (1 of 2 failed); surface s2 (1 of 2 "
        "failed); 1 more settings saw a failure");
  CHECK(where({{ok}, {ok}}) == "where:      nowhere: no run failed");
}

TEST_CASE("Undecided settings are named up to twelve") {
  for (const int open : {1, 12, 13}) {
    const sweep::SweepResult result = Settings(std::vector<std::vector<double>>(
        static_cast<size_t>(open), std::vector<double>{0.07, 0.05}));
    const std::vector<Finding> findings = Findings(result, {});
    const std::string told = findings[2].sentences[1].Text();
    INFO(told);
    CHECK(findings[2].question == "How sure is that?");
    CHECK_THAT(told, StartsWith("Undecided: s0 (1 of 2 failed)"));
    CHECK(std::count(told.begin(), told.end(), ';') == std::min(open, 12) - 1);
    CHECK((told.find(" and more in the table of settings.") != told.npos) == (open > 12));
  }
}

sweep::ParameterEffect Effect(const std::string& name, double low, double high) {
  sweep::ParameterEffect effect{.name = name};
  effect.share_low = low;
  effect.share_high = high;
  effect.sentence = name + " is told";
  return effect;
}

std::vector<std::string> Said(const Finding& finding) {
  std::vector<std::string> lines;
  for (const Sentence& sentence : finding.sentences) lines.push_back(sentence.Text());
  return lines;
}

TEST_CASE("Parameters that can explain little are named together, a start that is clear is told") {
  sweep::Explanation explanation;
  explanation.effects.parameters = {Effect("seen", 0.01, 0.04), Effect("wide", 0.0, 0.05),
                                    Effect("small", 0.0, 0.049), Effect("tiny", 0.0, 0.01)};
  explanation.effects.note = "by a model";
  explanation.anatomy.start_m = {0.0123, 0.004, 0.0206, 9};
  const auto because = [&] { return Said(Findings(Settings({{0.05}}), explanation)[1]); };
  const std::string start =
      "Start placement matters: 0.0123 m of the mean gap over the settings (0.0040 to 0.0206) go "
      "when the first points are laid together.";
  explanation.anatomy.is_over_settings = true;
  CHECK(because() ==
        std::vector<std::string>{
            "seen is told.", "wide is told.",
            "No effect seen, and less than 5 % of the loss's variance each: small, tiny.",
            "By a model.", start});
  explanation.anatomy.start_m = {0.0123, -0.001, 0.0256, 9};
  CHECK(because().size() == 4);
  explanation.anatomy.start_m = {-0.0123, -0.02, -0.001, 9};
  CHECK(because().size() == 4);
  explanation.anatomy.start_m = {0.0, 0.0001, 0.0002, 9};  // nothing of it goes
  CHECK(because().size() == 4);
}

TEST_CASE("What the gap is made of adds up, and says of which mean it is") {
  // Trials unevenly over the settings: their mean gap is 0.0433 m, that of the settings 0.05 m.
  sweep::SweepResult result = Settings({{0.03, 0.031, 0.032, 0.027}, {0.05}, {0.07}});
  const auto said = [&] { return Said(Findings(result, sweep::Explain(result))[4]); };
  CHECK_THAT(said()[0], StartsWith("Mean gap over the settings 0.0500 m; with the first points "
                                   "laid together 0.0400 m (-20 %); 0.0250 m is shape"));
  CHECK_THAT(said()[1], StartsWith("Start placement: +0.0100 m"));
  result.rows.pop_back();
  sweep::Summarise(result);
  CHECK_THAT(said()[0], StartsWith("Mean gap over the trials 0.0340 m; with the first points laid "
                                   "together 0.0272 m (-20 %); 0.0170 m is shape"));
}

TEST_CASE("In short: runs that tell nothing are counted by their end beside those that fail") {
  sweep::SweepResult result = Settings({{0.02, 0.07, 0.03, 0.04}, {0.04, 0.05}});
  const auto fails = [&] {
    return BriefText(result, {}).substr(0, BriefText(result, {}).find('\n'));
  };
  CHECK(fails() ==
        "what fails: 0 of 2 settings; 1 of 6 runs exceed 0.06 m, and 0 fail by not arriving");
  for (const size_t i : {size_t{0}, size_t{2}, size_t{3}}) {
    result.rows[i].status = i == 3 ? sweep::TrialStatus::kCrashed : sweep::TrialStatus::kTimedOut;
    result.rows[i].comparison = {};
  }
  result.rows[0].falsified = true;
  sweep::Summarise(result);
  CHECK(fails() ==
        "what fails: 0 of 2 settings; 1 of 4 runs exceed 0.06 m, and 1 fail by not arriving; 2 "
        "more tell nothing (1 timed_out, 1 crashed)");
}

TEST_CASE("Trials that only stop short of the goal are counted, one or more") {
  sweep::Explanation explanation;
  explanation.anatomy.gap_m = explanation.anatomy.shape_m = {0.05, 0.04, 0.06, 4};
  explanation.anatomy.start_m = {0.0, -0.01, 0.01, 4};
  explanation.anatomy.goal_m = {0.0021, 0.001, 0.0032, 4};
  explanation.anatomy.noise_m = {0.03, 0.02, 0.04, 4};
  explanation.anatomy.removable_m = {-0.002, -0.01, 0.006, 4};
  const auto made_of = [&](int only_at_goal) {
    explanation.anatomy.only_at_goal = only_at_goal;
    return Said(Findings(Settings({{0.05}}), explanation)[4]);
  };
  CHECK_THAT(made_of(0)[1],
             StartsWith("Stopping short of the goal: +0.0021 m (0.0010 to 0.0032) of "
                        "it go when") &&
                 Catch::EndsWith("level with the last waypoint."));
  CHECK_THAT(made_of(1)[1],
             Contains("; 1 trial is above the threshold by that alone, and no failure."));
  CHECK_THAT(made_of(2)[1],
             Contains("; 2 trials are above the threshold by that alone, and no failures."));
  CHECK_THAT(made_of(0)[2], Contains("would still be 0.0300 m away") &&
                                Contains(": 0.0000 m (-0.0100 to 0.0060) of the gap"));
}

TEST_CASE("What the robot said of predictions is counted by its verdicts, of both kinds") {
  sweep::SweepResult result = Settings({{0.05}});
  result.judged_by = {.share = 0.1, .confidence = 0.95};
  sweep::Explanation explanation;
  explanation.suggestions.trusted = 0.834;
  CHECK(RobotSentence(result, explanation).empty());
  // Sixty failures falsify, sixty runs without one pass, three tell nothing, one of three leaves
  // it.
  for (const bool fails : {true, false}) {
    explanation.robot.insert(explanation.robot.end(), {{{}, fails, 60, 60},
                                                       {{}, fails, 60, 0},
                                                       {{}, fails, 3, 0},
                                                       {{}, fails, 3, 0},
                                                       {{}, fails, 3, 1},
                                                       {{}, fails, 0, 0}});
  }
  explanation.robot.push_back({{}, true, 60, 59});
  CHECK(RobotSentence(result, explanation) ==
        "2 of 6 predicted failures confirmed by the robot (falsified), the others: 1 passed, 2 not "
        "seen to fail, 1 undecided; of 5 predicted to hold: 1 falsified, 1 passed, 2 not seen to "
        "fail, 1 undecided; 318 drives in all; a prediction of the sweep holds with 83 % "
        "probability");
}

TEST_CASE(
    "Settings that the robot drove are judged together, and need more trials the more they are") {
  sweep::SweepResult result = Settings({{0.05}});
  result.judged_by = {.share = 0.1, .confidence = 0.95};
  sweep::Explanation explanation;
  explanation.suggestions.trusted = 0.5;
  // Two failures of two are 37 times as likely above the share as at it: enough of one setting
  // (20), not of ten (200).
  explanation.robot = {{{}, true, 2, 2}};
  CHECK_THAT(RobotSentence(result, explanation), Catch::StartsWith("1 of 1 predicted failures"));
  explanation.robot.resize(10, {{}, true, 0, 0});
  CHECK_THAT(RobotSentence(result, explanation), Catch::StartsWith("1 of 1 predicted failures"));
  std::fill(explanation.robot.begin() + 1, explanation.robot.end(),
            sweep::RobotTrials{{}, true, 3, 0});
  CHECK_THAT(RobotSentence(result, explanation),
             Catch::StartsWith("0 of 10 predicted failures confirmed by the robot (falsified), the "
                               "others: 9 not seen to fail, 1 undecided; 29 drives in all"));
  // Three failures of three, and of all ten settings, are enough once more.
  std::fill(explanation.robot.begin(), explanation.robot.end(), sweep::RobotTrials{{}, true, 3, 3});
  CHECK_THAT(RobotSentence(result, explanation), Catch::StartsWith("10 of 10 predicted failures"));
  explanation.robot = {{{}, true, 0, 0}};
  CHECK(sweep::JudgeRobotTrials(explanation.robot, result.judged_by)[0].verdict ==
        gap::Verdict::kUndecided);
}

TEST_CASE("A rare event says how many of its runs do not tell, and what they are taken for") {
  sweep::RareEvent event{.probability = 0.3, .low = 0.2, .high = 0.4, .levels = 1};
  event.evaluations = 300;
  event.untold = 12;
  event.is_reached = true;
  CHECK_THAT(RareEventSentence(event),
             EndsWith("(288 runs in 1 level: it is not rare; 12 more do not tell)"));
  event.levels = 3;
  CHECK_THAT(RareEventSentence(event), EndsWith("(300 runs in 3 levels of subset simulation; 12 of "
                                                "them do not tell and are taken to hold)"));
  event.is_reached = false;
  CHECK_THAT(RareEventSentence(event),
             EndsWith("with a probability of 0.4 at most, with 95 % confidence (12 of 300 runs do "
                      "not tell and are taken to hold)"));
  event.untold = 0;
  CHECK_THAT(RareEventSentence(event), EndsWith(" of 0.4 at most, with 95 % confidence"));
}

TEST_CASE("Changes between two sweeps say how many are copies") {
  sweep::SweepChange change;
  change.now_hold = 4;
  CHECK_THAT(ChangeSentence(change), EndsWith("(4 now hold, 0 now fail)"));
  change.copies = 16;
  CHECK_THAT(ChangeSentence(change),
             EndsWith("(4 now hold, 0 now fail, 16 more are copies of these)"));
}

TEST_CASE("A link names a hundred rows at most, and its words are those of a URL") {
  std::vector<int> rows(101);
  for (int i = 0; i < 101; ++i) rows[static_cast<size_t>(i)] = i;
  CHECK(TrialsNumbered({4, 0}) == ".row=5%2C1");
  CHECK_THAT(TrialsNumbered(rows), StartsWith(".row=1%2C2%2C") && Catch::EndsWith("%2C99%2C100"));
  CHECK(TrialsWhere("a b", "x&y=Ä-_.Z9") == "a%20b=x%26y%3D%C3%84-_.Z9");
  CHECK(TrialsWhere("a", "b\tc\uFFFF") == "a=b%09c%EF%BF%BF");  // as the table holds it
  CHECK(Both("", "a=1") == "a=1");
  CHECK(Both("a=1", "") == "a=1");
  CHECK(Both("a=1", "b=2") == "a=1&b=2");
}

TEST_CASE("Documents of large sweeps keep ten thousand settings and a thousand rows of one") {
  sweep::SweepResult result;
  result.settings.resize(10'002);
  for (size_t i = 0; i < result.settings.size(); ++i) {
    result.settings[i].mean_loss_m = 1e-6 * static_cast<double>((i * 7919) % 10'002);
    result.settings[i].verdict.repeats = 1;
  }
  result.settings[5].mean_loss_m = gap::kNotComputed;
  result.settings[7].verdict.above = 1;
  result.doubts = {{.first = {.text = "stands"}, .trials = 3, .row = 4}};
  const json summary = json::parse(SummaryJson(result));
  CHECK(summary["settings_omitted"] == 2);
  CHECK(summary["settings"].size() == 10'000);
  CHECK(summary["settings"][0]["failures"] == 1);
  CHECK(summary["settings"][1]["mean_loss_m"].is_null());
  CHECK(summary["settings"][2]["mean_loss_m"].get<double>() == Approx(0.010001));
  CHECK(summary["settings"].back()["mean_loss_m"].get<double>() == Approx(2e-6));
  CHECK(summary["doubts"][0]["row"] == 5);
  CHECK(summary["doubts"][0]["trials"] == 3);
  CHECK(summary["doubts"][0]["text"] == "stands");
  result.settings.resize(10'000);
  CHECK_FALSE(json::parse(SummaryJson(result)).contains("settings_omitted"));

  result.settings.resize(1002);
  for (sweep::SettingResult& setting : result.settings) {
    setting.verdict = {.verdict = gap::Verdict::kUndecided, .above = 1, .repeats = 3};
  }
  result.settings[1].verdict.repeats = 0;
  result.settings[0].rows.assign(1001, 6);
  const json told = json::parse(ExplanationJson(result, {}));
  CHECK(told["undecided"].size() == 1000);
  CHECK(told["undecided"][0]["rows"].size() == 1000);
  CHECK(told["undecided"][0]["rows"][999] == 7);
}

TEST_CASE("A list of changes that just fits is not said to go on") {
  sweep::SweepChange change;
  change.keys.assign(20, {"run.timeout_s", "1", "2"});
  change.settings.assign(60, {.setting = "surface ice"});
  CHECK_THAT(ChangeText(change), !Contains("more"));
  change.keys.push_back(change.keys.front());
  change.settings.push_back(change.settings.front());
  CHECK_THAT(ChangeText(change),
             Contains("and 1 more keys that differ\n") && Contains("and 1 more settings\n"));
}

}  // namespace
}  // namespace rift::report
