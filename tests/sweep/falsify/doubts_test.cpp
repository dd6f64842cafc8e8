#include "rift/sweep/falsify/doubts.hpp"

#include <catch2/catch.hpp>

#include "support/inputs/paths.hpp"

namespace rift::sweep {
namespace {

SweepResult Of(const std::string& candidate_kind, const std::string& reference_kind) {
  SweepResult result;
  result.candidate_kind = candidate_kind;
  result.reference_kind = reference_kind;
  return result;
}

TrialRow Row(const std::vector<TrialDoubt>& doubts) {
  TrialRow row;
  row.candidate = "a.csv";
  row.reference = "b.csv";
  row.doubts = doubts;
  return row;
}

TEST_CASE("Doubts that differ in their numbers are of one kind, of another side another") {
  const TrialDoubt one{DoubtAbout::kPair, "SIM is -12.5 times as long"};
  CHECK(KindOf(one) == KindOf({DoubtAbout::kPair, "SIM is +0.98 times as long"}));
  CHECK(KindOf(one) != KindOf({DoubtAbout::kPair, "REAL is 12.5 times as long"}));
  CHECK(KindOf(one) != KindOf({DoubtAbout::kCandidate, one.text}));
  CHECK(KindOf({DoubtAbout::kReference, "9 of 10"}) == "reference of ");
}

TEST_CASE("A doubt about recorded logs counts from the first, one of runs from half of them") {
  struct Case {
    const char *candidate, *reference;
    DoubtAbout about;
    bool is_recorded;
  };
  const Case table[] = {{"logs", "logs", DoubtAbout::kCandidate, true},
                        {"logs", "logs", DoubtAbout::kReference, true},
                        {"logs", "logs", DoubtAbout::kPair, true},
                        {"logs", "path", DoubtAbout::kCandidate, true},
                        {"logs", "path", DoubtAbout::kReference, false},
                        {"logs", "path", DoubtAbout::kPair, false},
                        {"program", "logs", DoubtAbout::kCandidate, false},
                        {"program", "logs", DoubtAbout::kReference, true},
                        {"program", "logs", DoubtAbout::kPair, false}};
  for (const Case& one : table) {
    INFO(one.candidate << " " << one.reference << " " << static_cast<int>(one.about));
    const SweepResult result = Of(one.candidate, one.reference);
    const TrialDoubt doubt{one.about, "doubt"};
    CHECK(CountsAsDoubt(result, doubt, 1, 10) == one.is_recorded);
    CHECK(CountsAsDoubt(result, doubt, 4, 9) == one.is_recorded);
    CHECK(CountsAsDoubt(result, doubt, 5, 10));
    CHECK(CountsAsDoubt(result, doubt, 10, 10));
    if (one.is_recorded) CHECK_FALSE(CountsAsDoubt(result, doubt, 0, 10));
  }
}

TEST_CASE("A sweep is doubted once for each kind, as its first row has it, with all its trials") {
  SweepResult result = Of("logs", "path");
  const auto about_sim = [](const char* text) { return TrialDoubt{DoubtAbout::kCandidate, text}; };
  const TrialDoubt rare{DoubtAbout::kPair, "slides sideways"};
  result.rows = {Row({}), Row({about_sim("9 rows"), rare}), Row({about_sim("8 rows")}),
                 Row({about_sim("other"), about_sim("7 rows")}), Row({})};
  const std::vector<SweepDoubt> doubts = DoubtsOf(result);
  REQUIRE(doubts.size() == 2);  // one of five runs slides
  CHECK(doubts[0].first.text == "9 rows");
  CHECK(doubts[0].trials == 3);
  CHECK(doubts[0].row == 1);
  CHECK(doubts[1].first.text == "other");
  CHECK(doubts[1].trials == 1);
  CHECK(doubts[1].row == 3);
  CHECK(DoubtText(result, doubts[0]) == "a.csv (and 2 more trials): 9 rows");
  CHECK(DoubtText(result, doubts[1]) == "a.csv: other");
  SweepResult last = Of("logs", "path");
  last.rows = {Row({}), Row({about_sim("6 rows")})};
  REQUIRE(DoubtsOf(last).size() == 1);
  CHECK(DoubtsOf(last)[0].row == 1);
  // Trials without a gap are not those that a run is counted among.
  for (const size_t i : {0, 2, 4}) result.rows[i].status = TrialStatus::kFell;
  CHECK(DoubtsOf(result).size() == 3);
}

TEST_CASE("A doubt names the log that it is about, or both") {
  const TrialRow row = Row({});
  CHECK(SidesText(row, DoubtAbout::kCandidate) == "a.csv");
  CHECK(SidesText(row, DoubtAbout::kReference) == "b.csv");
  CHECK(SidesText(row, DoubtAbout::kPair) == "SIM a.csv and REAL b.csv");
}

TEST_CASE("Doubts of both logs stand with their side") {
  experiment::Experiment experiment;
  Recording candidate{.trajectory = test::StraightPath(1.0, 40)};
  Recording reference = candidate;
  candidate.doubts = {"in mm?"};
  reference.doubts = {"no yaw", "in m?"};
  const std::vector<TrialDoubt> doubts = DoubtsOf(experiment, candidate, reference);
  REQUIRE(doubts.size() == 3);
  CHECK(doubts[0].about == DoubtAbout::kCandidate);
  CHECK(doubts[0].text == "in mm?");
  CHECK(doubts[1].about == DoubtAbout::kReference);
  CHECK(doubts[1].text == "no yaw");
  CHECK(doubts[2].text == "in m?");
}

TEST_CASE("Only sides from different hands are doubted as a pair, with the key that mends it") {
  using Kind = experiment::ReferenceKind;
  const Recording candidate{.trajectory = test::StraightPath(1.0, 40)};
  const Recording reference{.trajectory = test::StraightPath(1000.0, 40)};  // in mm
  experiment::Experiment experiment;
  for (const Kind kind : {Kind::kLogs, Kind::kProgram, Kind::kNominal, Kind::kPath}) {
    experiment.reference.kind = kind;
    const std::vector<TrialDoubt> doubts = DoubtsOf(experiment, candidate, reference);
    const bool is_of_others = kind == Kind::kLogs || kind == Kind::kProgram;
    INFO(static_cast<int>(kind));
    REQUIRE(doubts.empty() != is_of_others);
    if (is_of_others) {  // of units first, then of clocks
      const std::string& of_units = doubts.front().text;
      CHECK(of_units.find("as in --set reference.units=mm") != std::string::npos);
      CHECK(of_units.find("--set reference.columns='t=...,x=...:mm") != std::string::npos);
    }
    for (const TrialDoubt& doubt : doubts) {
      CHECK(doubt.about == DoubtAbout::kPair);
      CHECK(doubt.text.find("--real-") == std::string::npos);
    }
  }
}

}  // namespace
}  // namespace rift::sweep
