// Words of a report must not contradict each other or the numbers they come from, whatever the
// sweep: ten of different kinds are held to the same rules.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <regex>

#include "rift/report/text/findings.hpp"
#include "rift/report/text/text.hpp"
#include "sweep_kinds.hpp"

namespace rift::report {
namespace {

using sweep::SweepResult;
using synthetic::Kind;
using synthetic::Kinds;

struct Said {
  std::string headline;
  std::vector<std::string> sentences;  ///< of all findings

  bool Has(const std::string& words) const {
    return std::any_of(sentences.begin(), sentences.end(), [&](const std::string& sentence) {
      return sentence.find(words) != sentence.npos;
    });
  }
  std::vector<std::smatch> All(const std::regex& pattern) const {
    std::vector<std::smatch> matches;
    for (const std::string& sentence : sentences) {
      std::smatch match;
      if (std::regex_search(sentence, match, pattern)) matches.push_back(match);
    }
    return matches;
  }
};

Said SayAll(const SweepResult& result, const sweep::Explanation& explanation) {
  Said said{Summary(result).sentence.Text(), {}};
  for (const Finding& finding : Findings(result, explanation)) {
    for (const Sentence& sentence : finding.sentences) said.sentences.push_back(sentence.Text());
  }
  return said;
}

void CheckHeadline(const SweepResult& result, const Said& said) {
  const auto says = [&](const char* words) {
    return said.headline.find(words) != std::string::npos;
  };
  CHECK(says("It fails") + says("No failure") + says("Not known whether") == 1);
  CHECK(says("It fails") == (result.all.failures > 0));
  CHECK(says("As near") + says("Further from") + says("It cannot be told") <= 1);
  if (says("No failure")) {
    CHECK_FALSE(said.Has("Most often at"));
    CHECK_FALSE(said.Has("kinds of failure"));
    CHECK_FALSE(said.Has("Undecided: "));
    CHECK(result.Count(gap::Verdict::kFalsified) == 0);
  }
}

/// "name: 63 % of the loss's variance goes with it (41 to 77 % ..."
void CheckEffects(const SweepResult& result, const sweep::Explanation& explanation,
                  const Said& said) {
  const std::regex seen(
      R"(^(\S+): ([\d.]+) % of the loss's variance goes with it \(([\d.]+) to ([\d.]+) %)");
  double last = 100.0;
  for (const std::smatch& match : said.All(seen)) {
    const std::string name = match[1];
    const double share = std::stod(match[2]);
    CHECK(share <= last);  // the largest first
    last = share;
    CHECK(std::stod(match[3]) <= share);
    CHECK(share <= std::stod(match[4]));
    CHECK_FALSE(said.Has(name + ": no effect seen"));
    CHECK_FALSE(said.Has(name + " is inert"));
    CHECK_FALSE(said.Has(name + " matters"));
  }
  for (const experiment::Parameter& parameter : result.parameters) {
    const std::regex about("^" + parameter.Name() + ": .*variance");
    CHECK(said.All(about).size() <= 1);
  }
  for (const sweep::Inertness& inert : explanation.inert) {
    if (said.Has(inert.parameter + " is inert")) CHECK_FALSE(inert.is_detected);
  }
}

void CheckVerdicts(const SweepResult& result, const Said& said) {
  const std::regex counts(
      R"((\d+) of (\d+) falsified, (\d+) passed, (\d+) not seen to fail, (\d+) undecided)");
  const std::vector<std::smatch> found = said.All(counts);
  REQUIRE(found.size() == 1);
  const auto number = [&](int i) { return std::stoi(found.front()[i]); };
  CHECK(number(1) + number(3) + number(4) + number(5) == number(2));
  const bool has_open = std::any_of(
      result.settings.begin(), result.settings.end(), [](const sweep::SettingResult& setting) {
        return setting.verdict.verdict == gap::Verdict::kUndecided && setting.verdict.repeats > 0;
      });
  CHECK(said.Has("Undecided: ") == has_open);
}

void CheckSuggestions(const sweep::Explanation& explanation, const Said& said) {
  const std::regex risk(R"(calling it wrongly falls from (\d+) to (\d+) %)");
  const std::vector<std::smatch> found = said.All(risk);
  for (const std::smatch& match : found) CHECK(std::stoi(match[2]) <= std::stoi(match[1]));
  CHECK(found.empty() == explanation.suggestions.list.empty());
  if (said.Has("none is worth a trial")) CHECK(found.empty());
  const std::regex robot(R"((\d+) of (\d+) predicted failures confirmed)");
  for (const std::smatch& match : said.All(robot)) {
    CHECK(std::stoi(match[1]) <= std::stoi(match[2]));
    CHECK(std::stoi(match[2]) ==
          std::count_if(explanation.robot.begin(), explanation.robot.end(),
                        [](const auto& d) { return d.is_predicted_to_fail; }));
  }
}

TEST_CASE("No two sentences of a report contradict each other in sweeps of different kinds") {
  const std::vector<Kind> kinds = Kinds();
  CHECK(kinds.size() >= 10);
  for (const Kind& kind : kinds) {
    INFO(kind.name);
    const sweep::Explanation explanation = sweep::Explain(kind.result, {.robot = kind.robot});
    const Said said = SayAll(kind.result, explanation);
    for (const std::string& sentence : said.sentences) UNSCOPED_INFO(sentence);
    CheckHeadline(kind.result, said);
    CheckEffects(kind.result, explanation, said);
    CheckVerdicts(kind.result, said);
    CheckSuggestions(explanation, said);
    for (const std::string& sentence : said.sentences) {
      CHECK(sentence.find("nan") == std::string::npos);
    }
  }
}

TEST_CASE("Each kind of sweep is told as what it is") {
  const std::vector<Kind> kinds = Kinds();
  const auto said = [&](const std::string& name) {
    const auto found = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const Kind& kind) { return kind.name == name; });
    REQUIRE(found != kinds.end());
    return SayAll(found->result, sweep::Explain(found->result, {.robot = found->robot}));
  };
  CHECK(said("above the threshold at the goal alone")
            .Has("48 trials are above the threshold by that alone, and no failures"));
  CHECK(said("an inert parameter").Has("v_max is inert"));
  CHECK(said("two parameters that act together").Has("together with v_min"));
  CHECK(said("a search whose predictions were driven").Has("1 of 2 predicted failures confirmed"));
  CHECK_THAT(said("as far from the robot as the robot from itself").headline,
             Catch::Matchers::StartsWith("As near to the robot"));
}

TEST_CASE("Trials without a gap beyond the first three are counted by what became of them") {
  SweepResult result = synthetic::Grid();
  for (size_t i = 0; i < 9; ++i) synthetic::LoseGap(&result.rows[i], "no gap");
  for (size_t i = 0; i < 5; ++i) result.rows[i].status = sweep::TrialStatus::kHung;
  sweep::Summarise(result);
  const std::string text = SweepText(result);
  INFO(text);
  CHECK(text.find("without gap: row 3: no gap\nwithout gap: 6 more: 4 missing, 2 hung\n") !=
        std::string::npos);
}

}  // namespace
}  // namespace rift::report
