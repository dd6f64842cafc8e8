// Everything that is said of sweeps of different kinds, word for word and number for number, beside
// what was read and approved once (tests/pinned): an exchanged column, axis, sign, order or link is
// a difference.

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/findings.hpp"
#include "rift/report/text/text.hpp"
#include "support/pinned.hpp"
#include "sweep_kinds.hpp"
#include "uneven_sweep.hpp"

namespace rift::report {
namespace {

using synthetic::Kind;
using synthetic::Searched;
using synthetic::Uneven;
using test::DifferenceFromPinned;

std::vector<Kind> AllKinds() {
  std::vector<Kind> kinds = synthetic::Kinds();
  kinds.push_back({"uneven", Uneven()});
  kinds.push_back({"a search", Searched(), {{{experiment::NumberValue(0.7)}, true, 4, 3}}});
  return kinds;
}

/// Words, and in brackets behind them the rows that they lead to.
std::string WithLinks(const Sentence& sentence) {
  std::string text;
  for (const Piece& piece : sentence.pieces()) {
    text += piece.text + (piece.query.empty() ? "" : "[" + piece.query + "]");
  }
  return text + "\n";
}

TEST_CASE("Words and links about sweeps of all kinds are those that were approved") {
  std::string text;
  for (const Kind& kind : AllKinds()) {
    const sweep::Explanation explanation = sweep::Explain(kind.result, {.robot = kind.robot});
    const Headline headline = Summary(kind.result);
    text += fmt::format("==== {}\n{} ", kind.name, static_cast<int>(headline.outcome)) +
            WithLinks(headline.sentence);
    for (const Finding& finding : Findings(kind.result, explanation)) {
      text += "## " + finding.question + "\n";
      for (const Sentence& sentence : finding.sentences) text += WithLinks(sentence);
    }
    text += "## unmeasured\n";
    for (const std::string& line : UnmeasuredTrials(kind.result)) text += line + "\n";
    text += "## terminal\n" + SweepText(kind.result) +
            ExplanationText(kind.result, explanation, true) + BriefText(kind.result, explanation);
  }
  CHECK(DifferenceFromPinned("report/sweep_words.txt", text) == "");
}

TEST_CASE("Documents about uneven sweeps hold the numbers that were approved") {
  for (const auto& [name, result] : {std::pair{"uneven", Uneven()}, {"searched", Searched()}}) {
    const sweep::Explanation explanation = sweep::Explain(result);
    CHECK(DifferenceFromPinned(fmt::format("report/{}_summary.json", name), SummaryJson(result)) ==
          "");
    CHECK(DifferenceFromPinned(fmt::format("report/{}_explanation.json", name),
                               ExplanationJson(result, explanation)) == "");
    CHECK(DifferenceFromPinned(fmt::format("report/{}_table.csv", name), TableCsv(result)) == "");
  }
}

TEST_CASE("Figures of an uneven sweep have the data, axes, order and threshold approved") {
  std::string text;
  ReportOptions options;
  for (const auto& result : {Uneven(), Searched()}) {
    const SweepFigureSet set = SweepFigures(result, synthetic::Pair(0.1), options);
    for (const Figure& figure : set.figures) {
      text += fmt::format("==== {} {} {} x {}\n{}\n", figure.name, figure.title, figure.width_px,
                          figure.height_px, figure.plot);
    }
    for (const OmittedFigure& figure : set.omitted) {
      text += fmt::format("omitted {}: {}\n", figure.name, figure.reason);
    }
  }
  CHECK(DifferenceFromPinned("report/sweep_figures.txt", text) == "");
}

/// A row that failed, what it shrank to, and each change taken back.
TEST_CASE("A shrunk row is told as it was approved") {
  const sweep::SweepResult result = Uneven();
  sweep::ShrunkRow found{.id = 20, .nominal = result.rows[0].theta};
  found.shrunk.theta = result.rows.back().theta;
  found.shrunk.theta[1] = found.nominal[1];
  found.shrunk.changed = {0, 2};
  found.shrunk.evaluations = 17;
  found.shrunk.robustness = -0.004;
  found.rows = {result.rows.back(), result.rows[12], result.rows[5], result.rows[3]};
  std::string text;
  for (int flags = 0; flags < 4; ++flags) {
    found.shrunk.is_minimal = (flags & 1) != 0;
    found.shrunk.is_fewest = (flags & 2) != 0;
    text += ShrunkText(result, found, "out/shrunk") + ShrunkJson(result, found, "out/shrunk");
  }
  found.shrunk.changed.clear();
  text += ShrunkText(result, found, "out/shrunk") + ReplayCommand("out/sweep", 4) + "\n";
  for (const bool is_reached : {false, true}) {
    for (const int levels : {1, 3}) {
      const sweep::RareEvent event{.probability = is_reached ? 0.00123 : gap::kNotComputed,
                                   .low = 0.0004,
                                   .high = 0.0031,
                                   .coefficient_of_variation = 0.31,
                                   .levels = levels,
                                   .evaluations = 2345,
                                   .is_reached = is_reached};
      text += RareEventSentence(event) + "\n" + RareEventJson(event, {});
    }
  }
  CHECK(DifferenceFromPinned("report/shrunk_and_rare.txt", text) == "");
}

}  // namespace
}  // namespace rift::report
