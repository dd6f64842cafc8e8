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

namespace rift::report {
namespace {

using synthetic::Kind;
using synthetic::Numeric;
using synthetic::Word;
using test::DifferenceFromPinned;

/// No two numbers of it are alike, no axis is as long as another, the threshold is not the
/// default, repeats are uneven, and rows are missing in every way.
sweep::SweepResult Uneven() {
  sweep::SweepResult result;
  result.name = "uneven";
  result.candidate_kind = "simulation";
  result.reference_kind = "logs";
  result.gap.threshold_m = 0.045;
  result.gap.skip_start = 0.1;
  result.tag_offset_m = 0.03;
  result.parameters = {{"control.v_min", {Numeric("0.15"), Numeric("0.20"), Numeric("0.25")}},
                       {"terrain.surface", {Word("ground"), Word("parchment")}},
                       {"simulation.link.delay_s", {Numeric("0.02"), Numeric("0.07")}}};
  std::uint64_t path = 11;
  int n = 0;
  for (int v = 0; v < 3; ++v) {
    for (int s = 0; s < 2; ++s) {
      for (int d = 0; d < 2; ++d) {
        for (int trial = 1; trial <= 2 + (v + s) % 2; ++trial) {
          const double gap_m = 0.02 + 0.011 * v + 0.007 * s * s + 0.004 * d + 0.0013 * (++n % 7);
          sweep::TrialRow row =
              synthetic::Row({result.parameters[0].levels[v], result.parameters[1].levels[s],
                              result.parameters[2].levels[d]},
                             std::to_string(trial), gap_m);
          gap::Comparison& c = row.comparison;
          c.gap_u = 0.3 + 0.013 * n;
          c.exact_gap_m = gap_m + 0.0001 * n;
          c.mean_error_m = 0.41 * gap_m;
          c.rms_error_m = 0.47 * gap_m;
          c.start_offset_m = 0.003 + 0.0002 * n;
          c.start_aligned_gap_m = (0.6 + 0.01 * n) * gap_m;
          c.shape_gap_m = (0.3 + 0.01 * n) * gap_m;
          c.frechet_m = (0.7 + 0.003 * n) * gap_m;
          c.equal_time_m = (1.3 + 0.02 * n) * gap_m;
          c.length_ratio = 1.02 + 0.001 * n;
          c.end_error_m = 0.011 + 0.0003 * n;
          row.way_gap_m = gap_m - 0.0021 * (n % 3);
          row.falsified = row.CountedGap_m() > result.gap.threshold_m;
          row.seed = 100 + static_cast<std::uint64_t>(n);
          row.candidate = fmt::format("sim/{}.csv", n);
          row.reference = fmt::format("real/{}.csv", n);
          row.evidence.fingerprint = path++;
          for (int k = 1; k <= 8; ++k) {
            row.evidence.errors_m.emplace_back(0.001 * k * v, 0.002 * k * (s == 0 ? 1 : -1));
          }
          result.rows.push_back(row);
        }
      }
    }
  }
  synthetic::LoseGap(&result.rows[3], "no file \"real, 4.csv\"");
  sweep::TrialRow& fell = result.rows[8];
  fell.status = sweep::TrialStatus::kFell;
  fell.reason = "fell sideways at 2.5 s";
  fell.comparison = {};
  fell.evidence.errors_m.clear();
  fell.way_gap_m = gap::kNotComputed;
  fell.left_m = 0.37;
  fell.falsified = true;
  result.replaced = {{7, 9, "fell"}};
  result.judged_by = {.share = 0.2, .confidence = 0.9};
  sweep::Summarise(result);
  int i = 0;
  for (sweep::SettingResult& setting : result.settings) setting.noise_floor_m = 0.01 + 0.0011 * i++;
  return result;
}

/// A search: its worst setting, first evaluation and end, over ranges of different width.
sweep::SweepResult Searched() {
  sweep::SweepResult result = synthetic::Continuous(40);
  result.gap.threshold_m = 0.07;
  result.parameters[0].settable = true;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    result.rows[i].falsified = result.rows[i].comparison.gap_m > 0.07;
    result.rows[i].evidence.fingerprint = i + 1;
    result.rows[i].is_random_draw = i % 2 == 0;
  }
  sweep::Summarise(result);
  result.falsification = sweep::Falsification{.strategy = "cmaes",
                                              .verdict = gap::Verdict::kFalsified,
                                              .evaluations = 40,
                                              .budget = 64,
                                              .first_evaluation = 35,
                                              .worst_setting = 38,
                                              .ended = "the first falsified setting"};
  return result;
}

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
      const sweep::RareEvent event{.probability = 0.00123,
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
