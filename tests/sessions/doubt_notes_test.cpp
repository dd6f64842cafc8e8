// Doubts about the trajectories of a sweep, told while it runs and at its end.
#include "sessions/sweep/doubt_notes.hpp"

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace rift::sessions {
namespace {

using sweep::DoubtAbout;

sweep::TrialRow Row(std::vector<sweep::TrialDoubt> doubts) {
  sweep::TrialRow row;
  row.candidate = "sim.csv";
  row.reference = "real.csv";
  row.doubts = std::move(doubts);
  return row;
}

const sweep::TrialDoubt kSlow{DoubtAbout::kCandidate, "its clock is 60 times slow"};
const sweep::TrialDoubt kSlower{DoubtAbout::kCandidate, "its clock is 61.5 times slow"};
const sweep::TrialDoubt kPair{DoubtAbout::kPair, "mirrored y"};

struct Notes {
  explicit Notes(const std::string& candidate, const std::string& reference = "program") {
    kinds.candidate_kind = candidate;
    kinds.reference_kind = reference;
  }
  sweep::SweepResult kinds;
  std::vector<std::string> told{};
  DoubtNotes notes{kinds, [this](const std::string& line) { told.push_back(line); }};
};

TEST_CASE("A doubt about logs is told with the third trial that has a gap, once for its kind") {
  Notes run("logs");
  run.notes.Seen(Row({kSlow}));
  run.notes.Seen(Row({kSlow}));
  CHECK(run.told.empty());
  run.notes.Seen(Row({kSlower}));
  CHECK(run.told ==
        std::vector<std::string>{
            "warning: sim.csv (and 2 more trials so far): its clock is 61.5 times slow"});
  run.notes.Seen(Row({kSlow}));
  CHECK(run.told.size() == 1);
}

TEST_CASE("A first doubt that comes late stands alone, of a pair with both logs") {
  Notes run("logs", "logs");
  for (int i = 0; i < 3; ++i) run.notes.Seen(Row({}));
  run.notes.Seen(Row({kPair}));
  CHECK(run.told == std::vector<std::string>{"warning: SIM sim.csv and REAL real.csv: mirrored y"});
}

TEST_CASE("A doubt of computed runs is told once half of the trials with a gap show it") {
  Notes run("program");
  run.notes.Seen(Row({kSlow}));
  run.notes.Seen(Row({}));
  run.notes.Seen(Row({}));
  CHECK(run.told.empty());  // one of three
  run.notes.Seen(Row({kSlow}));
  CHECK(run.told.size() == 1);  // two of four
}

TEST_CASE("Trials without a gap do not make a doubt surer") {
  Notes run("logs");
  run.notes.Seen(Row({kSlow}));
  sweep::TrialRow missing = Row({});
  missing.status = sweep::TrialStatus::kMissing;
  run.notes.Seen(missing);
  run.notes.Seen(missing);
  run.notes.Seen(missing);
  CHECK(run.told.empty());
}

TEST_CASE("At the end what was not told yet is told, with what the whole sweep says of it") {
  Notes run("logs");
  for (int i = 0; i < 3; ++i) run.notes.Seen(Row({kSlow}));
  REQUIRE(run.told.size() == 1);
  sweep::SweepResult result = run.kinds;
  result.rows = {Row({kSlow, kPair}), Row({kSlow, kPair}), Row({kSlow})};
  result.doubts = {{kSlower, 3, 0}, {kPair, 2, 1}};
  run.notes.End(result);
  CHECK(run.told.size() == 2);
  CHECK(run.told.back() ==
        "warning: SIM sim.csv and REAL real.csv (and 1 more trials): mirrored y");
  run.notes.End(result);
  CHECK(run.told.size() == 2);
}

}  // namespace
}  // namespace rift::sessions
