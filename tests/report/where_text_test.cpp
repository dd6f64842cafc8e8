// "Where does it fail?": what is said where no trial has a gap, and where no value stands out.
#include <catch2/catch.hpp>
#include <cmath>
#include <tuple>

#include "rift/report/text/findings.hpp"
#include "rift/report/text/text.hpp"
#include "synthetic_sweep.hpp"

namespace rift::report {
namespace {

/// A sweep over "a" and "b"; `fails(a, b)`: whether the two trials of a setting do, without a gap.
template <class Fails>
sweep::SweepResult Sweep(bool has_gaps, const Fails& fails) {
  sweep::SweepResult result;
  result.gap.threshold_m = 0.07;
  for (const char* name : {"a", "b"}) {
    result.parameters.push_back(
        {.key = name, .levels = {synthetic::Numeric("0"), synthetic::Numeric("1")}});
  }
  for (int i = 0; i < 8; ++i) {
    const int a = i / 4, b = i / 2 % 2;
    sweep::TrialRow row;
    row.theta = {result.parameters[0].levels[a], result.parameters[1].levels[b]};
    row.trial = std::to_string(1 + i % 2);
    row.falsified = fails(a, b);
    if (has_gaps) {
      row.comparison.gap_m = row.falsified ? 0.09 + 0.001 * i : 0.02;
    } else {
      row.status = row.falsified ? sweep::TrialStatus::kTimedOut : sweep::TrialStatus::kCrashed;
    }
    result.rows.push_back(row);
  }
  sweep::Summarise(result);
  return result;
}

std::string Where(const sweep::SweepResult& result) {
  std::string text;
  for (const Finding& finding : Findings(result, sweep::Explain(result))) {
    if (finding.question != "Where does it fail?") continue;
    for (const Sentence& sentence : finding.sentences) text += sentence.Text() + "\n";
  }
  return text;
}

TEST_CASE("Runs that never arrive fail somewhere, though none has a gap") {
  const std::string text = Where(Sweep(false, [](int a, int) { return a == 1; }));
  CHECK_THAT(text, Catch::Contains("One kind of failure"));
  CHECK_THAT(text, Catch::Contains("4 ended as 'timed_out'"));
  CHECK_THAT(text, !Catch::Contains("Not known") && !Catch::Contains("largest gap"));
  CHECK(Where(Sweep(false, [](int, int) { return false; })) == "Not known: no trial has a gap.\n");
}

/// The first sentence that answers the question.
std::string Answer(const sweep::SweepResult& result, const std::string& question) {
  for (const Finding& finding : Findings(result, sweep::Explain(result))) {
    if (finding.question == question) return finding.sentences.at(0).Text();
  }
  return "";
}

TEST_CASE("The robot's own scatter is told without a gap, and without a ratio where it has none") {
  const std::string question = "How much is the robot's own scatter?";
  sweep::SweepResult result = Sweep(false, [](int, int) { return true; });
  result.settings[0].noise_floor_m = 0.02;
  CHECK(Answer(result, question) ==
        "Repeats of one setting are 0.0200 m apart from each other (noise floor, mean of 1 "
        "setting); no trial has a gap to hold against that.");
  result = Sweep(true, [](int, int) { return true; });
  REQUIRE(result.all.mean_gap_m > 0.0);
  result.settings[0].noise_floor_m = 0.0;
  CHECK_THAT(Answer(result, question),
             Catch::Contains("setting); the mean gap to the candidate") && Catch::EndsWith(" m."));
}

TEST_CASE("A gap of nothing is made of nothing, and no share of it goes") {
  sweep::SweepResult result = Sweep(true, [](int, int) { return false; });
  for (sweep::TrialRow& row : result.rows) {
    row.comparison.gap_m = row.comparison.start_aligned_gap_m = row.comparison.shape_gap_m = 0.0;
  }
  sweep::Summarise(result);
  CHECK(Answer(result, "What is the gap made of?") ==
        "Mean gap over the settings 0.0000 m; with the first points laid together 0.0000 m; 0.0000 "
        "m is shape, left after the best rigid motion.");
}

TEST_CASE("Most and least are said of values that fail unequally often alone") {
  CHECK_THAT(Where(Sweep(true, [](int a, int b) { return a == 1 && b == 0; })),
             Catch::Contains("Most often at 1 (2 of 4 trials), least often at 0 (0 of 4 trials)") ||
                 Catch::Contains("Most often at a 1 (2 of 4 trials), least often at 0 (0 of 4"));
  const std::string all = Where(Sweep(true, [](int, int) { return true; }));
  CHECK_THAT(all, !Catch::Contains("Most often") && Catch::Contains("The largest gap"));
}

/// Words, and in brackets behind them the rows that they lead to.
std::vector<std::string> WithLinks(const sweep::SweepResult& result,
                                   const sweep::Explanation& explanation,
                                   const std::string& question) {
  std::vector<std::string> lines;
  for (const Finding& finding : Findings(result, explanation)) {
    if (finding.question != question) continue;
    for (const Sentence& sentence : finding.sentences) {
      lines.emplace_back();
      for (const Piece& piece : sentence.pieces()) {
        lines.back() += piece.text + (piece.query.empty() ? "" : "[" + piece.query + "]");
      }
    }
  }
  return lines;
}

using Lines = std::vector<std::string>;

TEST_CASE("Of parameters whose values are as far apart the main one is told, else the further") {
  const auto most = [](const sweep::SweepResult& result) {
    return WithLinks(result, {}, "Where does it fail?").at(0);
  };
  CHECK(most(Sweep(true, [](int a, int b) { return a == 1 && b == 0; })) ==
        "Most often at a 1 (2[a=1&.result=failed] of 4 trials[a=1]), least often at 0 "
        "(0[a=0&.result=failed] of 4 trials[a=0]).");
  CHECK(most(Sweep(true, [](int, int b) { return b == 0; })) ==
        "Most often at b 0 (4[b=0&.result=failed] of 4 trials[b=0]), least often at 1 "
        "(0[b=1&.result=failed] of 4 trials[b=1]).");
}

/// A value of one parameter for each list, and trials of it with these gaps; NaN: none came, below
/// zero: it did not arrive, and its gap is not known.
sweep::SweepResult Values(const std::vector<std::vector<double>>& gaps_m) {
  sweep::SweepResult result;
  result.parameters = {{"terrain.surface", {}}};
  std::uint64_t path = 1;
  for (size_t i = 0; i < gaps_m.size(); ++i) {
    result.parameters[0].levels.push_back(synthetic::Word("s" + std::to_string(i)));
    for (const double gap_m : gaps_m[i]) {
      sweep::TrialRow row = synthetic::Row({result.parameters[0].levels[i]}, "1", gap_m);
      row.evidence.fingerprint = path++;
      if (std::isnan(gap_m)) synthetic::LoseGap(&row, "gone");
      if (gap_m < 0.0) {
        row.status = sweep::TrialStatus::kTimedOut;
        row.comparison = {};
        row.falsified = true;
      }
      result.rows.push_back(row);
    }
  }
  sweep::Summarise(result);
  return result;
}

TEST_CASE("Among values that fail as often the larger mean gap is the worse one") {
  CHECK(
      WithLinks(Values({{0.07}, {0.09}, {0.08}, {0.04}, {0.02}, {0.03}}), {}, "Where does it fail?")
          .at(0) ==
      "Most often at surface s1 (1[surface=s1&.result=failed] of 1 trials[surface=s1]), least "
      "often at s4 (0[surface=s4&.result=failed] of 1 trials[surface=s4]).");
}

TEST_CASE("The worst setting is one that tells, with its trials and what its mean is over") {
  const auto worst = [](const std::vector<std::vector<double>>& gaps_m) {
    for (const std::string& line : WithLinks(Values(gaps_m), {}, "Where does it fail?")) {
      if (line.starts_with("The worst")) return line;
    }
    return std::string();
  };
  CHECK(worst({{0.02}, {0.09}, {NAN}}) ==
        "The worst setting is s1[surface=s1]: 1 of 1 trial failed, the mean gap is 0.0900 m.");
  CHECK(worst({{0.02}, {0.09, 0.03}}) ==
        "The worst setting is s1[surface=s1]: 1 of 2 trials failed, the mean gap is 0.0600 m.");
  CHECK(worst({{0.02}, {0.09, NAN}}) ==
        "The worst setting is s1[surface=s1]: 1 of 1 trial failed, the mean gap is 0.0900 m, over "
        "the 1 with a gap.");
  CHECK(worst({{-1.0}, {0.02}}) ==
        "The worst setting is s0[surface=s0]: 1 of 1 trial failed, none has a gap.");
}

TEST_CASE("Of more than three kinds of failure three are told, each with its rows") {
  sweep::Explanation explanation;
  for (int i = 0; i < 4; ++i) {
    sweep::FailureCluster cluster;
    for (int k = 0; k < 12 - i; ++k) cluster.rows.push_back(3 * k);
    cluster.sentence = std::to_string(12 - i) + " of a kind";
    explanation.clusters.push_back(cluster);
  }
  const auto kinds = [&] {
    const Lines all = WithLinks(Values({{0.02}, {0.09}}), explanation, "Where does it fail?");
    return Lines(all.begin() + 3, all.end());
  };
  REQUIRE(kinds().size() == 4);
  CHECK(kinds()[0] == "4 kinds of failure by where and how the paths part:");
  CHECK(kinds()[1] == "12[.row=1%2C4%2C7%2C10%2C13%2C16%2C19%2C22%2C25%2C28%2C31%2C34] of a kind.");
  CHECK(kinds()[3] == "10[.row=1%2C4%2C7%2C10%2C13%2C16%2C19%2C22%2C25%2C28] of a kind.");
  explanation.clusters.resize(2);
  CHECK(kinds()[0] == "2 kinds of failure by where and how the paths part:");
  CHECK(kinds().size() == 3);
  explanation.clusters.resize(1);
  CHECK(kinds()[0] == "One kind of failure by where and how the paths part:");
  explanation.clusters.clear();
  CHECK(kinds().empty());
}

TEST_CASE("Three experiments are suggested, each with its rows, and else it is said why none is") {
  const sweep::SweepResult result = Values({{0.02}});
  sweep::Explanation explanation;
  const auto next = [&] { return WithLinks(result, explanation, "What to test next?"); };
  CHECK(next() == Lines{"Nothing can be said: no trial tells."});
  explanation.suggestions.note = "none is worth a trial";
  CHECK(next() == Lines{"None is worth a trial."});
  for (int i = 1; i <= 4; ++i) {
    explanation.suggestions.list.push_back(
        {.rows = {i, 2 * i}, .sentence = std::to_string(i) + " trials: so it is"});
  }
  CHECK(next() == Lines{"1 trials[.row=2%2C3]: so it is.", "2 trials[.row=3%2C5]: so it is.",
                        "3 trials[.row=4%2C7]: so it is.", "None is worth a trial."});
}

TEST_CASE("What was not measured is counted by trials and by the settings that lack some") {
  const auto missing = [](const std::vector<std::vector<double>>& gaps_m) {
    return WithLinks(Values(gaps_m), {}, "What was not measured?");
  };
  CHECK(missing({{0.02}}) == Lines{"Nothing: all 1 trial have a gap."});
  CHECK(missing({{0.02, 0.03}}) == Lines{"Nothing: all 2 trials have a gap."});
  // Of the last setting no trial tells, so that it is not judged at all.
  CHECK(missing({{0.02, NAN}, {0.03}, {NAN}}) ==
        Lines{"Without a gap: 2 of 4 trials (2 missing). They are in no mean on this page.",
              "1 setting judged by fewer repeats than asked for."});
  CHECK(missing({{0.02, NAN}, {0.03, -1.0}}) ==
        Lines{"Without a gap: 2 of 4 trials (1 missing, 1 timed_out). They are in no mean on this "
              "page.",
              "2 settings judged by fewer repeats than asked for."});
  CHECK(missing({{NAN}}) ==
        Lines{"Without a gap: 1 of 1 trial (1 missing). They are in no mean on this page."});
}

TEST_CASE("Why a parameter has no effect is told of those in which none is seen") {
  sweep::Explanation explanation;
  const auto add = [&](const std::string& name, bool is_inert, bool is_detected,
                       const Lines& sentences) {
    sweep::Inertness inert{.parameter = name, .is_detected = is_detected, .sentences = sentences};
    inert.is_explained = is_inert;
    explanation.inert.push_back(inert);
  };
  add("a", false, false, {"it hardly varied", "few trials"});
  add("b", true, false, {"it never bound", "nor did it later"});
  add("c", true, true, {"it is seen"});
  add("d", true, false, {});
  CHECK(WithLinks(Values({{0.02}}), explanation, "Because of what?") ==
        Lines{"b is inert: it never bound; nor did it later.", "It hardly varied; few trials."});
}

TEST_CASE("Verdicts say how many settings were judged together, here or in the whole sweep") {
  sweep::SweepResult result = Values({{0.02}, {0.03}});
  result.judged_by = {.share = 0.2, .confidence = 0.9};
  const std::string end =
      " judged together: at most 10 % of the decided ones are wrong on average)";
  CHECK_THAT(VerdictCounts(result).Text(),
             Catch::Contains("(falsified: more than 20 % of its runs are shown to fail, passed: "
                             "fewer; 2" +
                             end));
  result.judged_settings = 99;
  CHECK_THAT(VerdictCounts(result).Text(), Catch::Contains("; 99" + end));
  result.judged_settings = 1;
  CHECK_THAT(VerdictCounts(result).Text(), Catch::Contains("; 2" + end));
}

TEST_CASE("Three trials without a gap are named, and of more those that follow are counted") {
  sweep::SweepResult result = Values({{0.02}, {NAN, NAN, NAN}});
  for (size_t i = 1; i < result.rows.size(); ++i) {
    result.rows[i].reason = "reason " + std::to_string(i);
  }
  const std::string three =
      "without gap: row 2: reason 1\nwithout gap: row 3: reason 2\nwithout gap: row 4: reason 3\n";
  CHECK_THAT(SweepText(result), Catch::Contains(three + "settings: "));
  result = Values({{0.02}, {NAN, NAN, NAN}, {-1.0, NAN, 0.03, -1.0}});
  for (size_t i = 1; i < result.rows.size(); ++i) {
    result.rows[i].reason = "reason " + std::to_string(i);
  }
  CHECK_THAT(SweepText(result), Catch::Contains(three + "without gap: 3 more: 1 missing, 2 "
                                                        "timed_out\nsettings: "));
}

TEST_CASE("A search whose worst setting never arrived says so") {
  sweep::SweepResult result = Values({{0.02}, {-1.0, -1.0}});
  result.falsification = sweep::Falsification{.strategy = "random",
                                              .verdict = gap::Verdict::kUndecided,
                                              .evaluations = 2,
                                              .budget = 7,
                                              .worst_setting = 1,
                                              .ended = "the budget"};
  CHECK_THAT(SweepText(result),
             Catch::Contains("undecided: 2 settings tried of 7 (random, ended by the budget)\n"
                             "worst setting: no run arrived, 2 of 2 trials failed (surface s1)\n"));
}

TEST_CASE("Suggestions are numbered, and where there are none it is said why") {
  const sweep::SweepResult result = Values({{0.02}});
  sweep::Explanation explanation;
  CHECK_THAT(ExplanationText(result, explanation, true),
             Catch::EndsWith("\nno experiment can be suggested: no trial tells\n"));
  explanation.suggestions.note = "none is worth a trial";
  CHECK_THAT(ExplanationText(result, explanation, true),
             Catch::EndsWith("\n\nnone is worth a trial\n"));
  CHECK_THAT(ExplanationText(result, explanation, false), !Catch::Contains("worth a trial"));
  explanation.suggestions.list = {{.sentence = "first: a"}, {.sentence = "second: b"}};
  CHECK_THAT(ExplanationText(result, explanation, true),
             Catch::EndsWith("\nnext experiments on the robot, the best first:\n1. first: a\n2. "
                             "second: b\n\nnone is worth a trial\n"));
}

TEST_CASE("Of two parameters that are nearly as far apart the one that is farther is told") {
  // Of thirty trials of each setting so many fail: values of a are 22 of 60 apart, those of b 20.
  for (const bool is_a : {true, false}) {
    sweep::SweepResult result;
    for (const char* name : {"a", "b"}) {
      result.parameters.push_back(
          {.key = name, .levels = {synthetic::Numeric("0"), synthetic::Numeric("1")}});
    }
    for (const auto& [first, second, failures] :
         {std::tuple{0, 0, 25}, {0, 1, 10}, {1, 0, 9}, {1, 1, 4}}) {
      for (int trial = 0; trial < 30; ++trial) {
        const auto& a = result.parameters[0].levels[is_a ? first : second];
        const auto& b = result.parameters[1].levels[is_a ? second : first];
        result.rows.push_back(
            synthetic::Row({a, b}, std::to_string(trial), trial < failures ? 0.09 : 0.02));
      }
    }
    sweep::Summarise(result);
    std::string text;
    for (const Finding& finding : Findings(result, {})) {
      for (const Sentence& sentence : finding.sentences) text += sentence.Text() + "\n";
    }
    CHECK_THAT(text, Catch::Contains(is_a ? "Most often at a 0 (35" : "Most often at b 0 (35"));
  }
}

}  // namespace
}  // namespace rift::report
