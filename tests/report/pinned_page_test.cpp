// The page of a sweep, that of two sweeps side by side, and what stands in files beside them: every
// word, chart, table, path and link beside what was approved (tests/pinned).

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "rift/report/json/sweep_change.hpp"
#include "rift/report/page/page.hpp"
#include "rift/report/page/sweep_change.hpp"
#include "rift/report/text/sweep_change.hpp"
#include "rift/sweep/falsify/evidence.hpp"
#include "support/pinned.hpp"
#include "uneven_sweep.hpp"

namespace rift::report {
namespace {

using nlohmann::json;
using test::DifferenceFromPinned;

/// Of many entries (views, patches of a map) the first ones and the last.
json Few(json value) {
  constexpr size_t kMost = 24;
  if (!value.is_structured()) return value;
  for (json& entry : value) entry = Few(std::move(entry));
  if (value.is_array() && value.size() > kMost && value.front().is_structured()) {
    json last = value.back();
    value.erase(value.begin() + kMost, value.end());
    value.push_back(std::move(last));
  }
  return value;
}

/// Without its style, its scripts and the data, which is put behind it a value a line.
std::string Readable(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="page-data">)";
  const size_t begin = page.find(open) + open.size();
  const json data = json::parse(page.substr(begin, page.find("</script>", begin) - begin));
  std::string text = page.substr(0, page.find("<script"));
  const size_t style = text.find("<style>");
  text = text.substr(0, style) + text.substr(text.find("</style>"));
  for (const auto& [key, value] : data.items()) {
    if (!value.is_structured()) {
      text += fmt::format("{}: {}\n", key, value.dump());
      continue;
    }
    for (const auto& [inner, item] : value.items()) {
      text += fmt::format("{}.{}", key, inner);
      const bool is_list = item.is_array() && !item.empty() && item.front().is_structured();
      if (is_list) {
        for (const json& line : item) text += "\n  " + Few(line).dump();
      } else if (item.is_object()) {
        for (const auto& [name, line] : item.items()) {
          text += "\n  " + name + ": " + Few(line).dump();
        }
      } else {
        text += ": " + item.dump();
      }
      text += '\n';
    }
  }
  return text;
}

/// Each row has a path and each reference is bent in its own way.
PageEvidence Evidence(sweep::SweepResult& result) {
  PageEvidence evidence;
  for (int i = 0; i < 3; ++i) {
    evidence.references.push_back(
        {fmt::format("robot, trial {}", i + 1),
         sweep::EvenPath(synthetic::Path(0.011 + 0.0173 * i), result.gap),
         sweep::EvenTimes_s(synthetic::Path(0.011 + 0.0173 * i), result.gap)});
  }
  for (size_t i = 0; i < result.rows.size(); ++i) {
    evidence.reference_of_row.push_back(static_cast<int>(i % 4) - 1);
    if (i % 5 == 4) continue;
    result.rows[i].evidence.path_m = sweep::EvenPath(
        synthetic::Path(0.0031 * static_cast<double>(i) - 0.02), synthetic::Path(0.0), result.gap);
    result.rows[i].evidence.path_times_s = sweep::EvenTimes_s(synthetic::Path(0.0), result.gap);
  }
  evidence.worst_path_m = sweep::EvenPath(synthetic::Path(0.123), result.gap);
  evidence.waypoints = {{"start", {0.1, -0.2}}, {"<goal>", {1.3, 0.4}}};
  evidence.figures = {{"One & two", "<svg>1</svg>"}, {"Three", "<svg>22</svg>"}};
  return evidence;
}

/// A cell of a program in which no two measures are alike.
sweep::ProgramCell Cell(const experiment::Theta& theta, int n) {
  sweep::ProgramCell cell{.theta = theta};
  cell.measures = {.runs = 5, .moved = static_cast<size_t>(5 - n % 2)};
  cell.measures.deviation_m = 0.011 + 0.003 * n;
  cell.measures.spread_m = 0.004 + 0.0007 * n * n;
  cell.measures.drift_per_m = 0.021 + 0.0051 * (n % 5);
  cell.measures.slip = {{0.25, 0.01 * n, -0.03 * n}, {0.75, 0.02 + 0.005 * n, NAN}};
  if (n == 3) cell.measures.moved = 0;
  if (n == 4) cell.measures = {};
  return cell;
}

TEST_CASE("The page of an uneven sweep has the words, numbers, order and links approved") {
  sweep::SweepResult result = synthetic::Uneven();
  PageEvidence evidence = Evidence(result);
  int n = 0;
  for (const sweep::SettingResult& setting : result.settings) {
    if (setting.theta[2].text == "0.02") evidence.programs.push_back(Cell(setting.theta, ++n));
  }
  const sweep::Explanation explanation = sweep::Explain(result);
  CHECK(DifferenceFromPinned("report/uneven_page.txt",
                             Readable(RenderPage(result, explanation, evidence))) == "");
}

TEST_CASE("The page of a search that still runs shows the worst of its rows as approved") {
  sweep::SweepResult result = synthetic::Searched();
  for (sweep::TrialRow& row : result.rows) {
    row.candidate = "it's/sim " + row.trial + ".csv";
    row.reference = "real/" + row.trial + ".csv";
  }
  PageEvidence evidence;
  evidence.gap_flags = " --align start --tag-offset 0.03";
  evidence.running = "40 trials so far & more";
  const std::optional<int> worst = sweep::WorstRow(result);
  REQUIRE(worst);
  evidence.worst_path_m = sweep::EvenPath(synthetic::Path(0.123), result.gap);
  evidence.references = {{"undisturbed run", sweep::EvenPath(synthetic::Path(0.05), {})}};
  ReportOptions options;
  options.table_rows = 13;
  CHECK(DifferenceFromPinned(
            "report/searched_page.txt",
            Readable(RenderPage(result, sweep::Explain(result), evidence, options))) == "");
}

TEST_CASE("A sweep over one list of values has its map in a line, as approved") {
  sweep::SweepResult result = synthetic::Uneven();
  result.parameters.resize(1);
  for (sweep::TrialRow& row : result.rows) row.theta.resize(1);
  sweep::Summarise(result);
  result.parameters[0].levels.push_back(synthetic::Numeric("0.30"));  // not tried
  CHECK(DifferenceFromPinned("report/line_page.txt", Readable(RenderPage(result))) == "");
}

sweep::SweepChange Change(double better_low, double better_high) {
  sweep::SweepChange change;
  change.before = "out/before";
  change.after = "out/<after>";
  change.keys = {{"gap.threshold_m", "0.06", "0.07"}, {"seed", "1", std::string(80, '2')}};
  change.settings = {{.setting = "surface ice",
                      .before = {5, 8, 0.071, "falsified"},
                      .after = {2, 7, 0.052, "undecided"},
                      .pairs = 6,
                      .gap_change_m = -0.019,
                      .gap_change_95_m = {-0.031, -0.007}},
                     {.setting = "surface mud",
                      .before = {1, 6, 0.043, "undecided"},
                      .after = {3, 5, 0.058, "undecided"},
                      .pairs = 4,
                      .gap_change_m = 0.015,
                      .gap_change_95_m = {0.002, 0.028}},
                     {.setting = "surface sand",
                      .before = {0, 3, 0.021, "passed"},
                      .after = {1, 4, 0.022, "passed"},
                      .pairs = 3,
                      .gap_change_m = 0.001,
                      .gap_change_95_m = {-0.004, 0.006}},
                     {.setting = "surface unknown", .before = {}, .after = {}}};
  change.only_before = 2;
  change.only_after = 3;
  change.all = {.setting = "all",
                .before = {6, 17, 0.051},
                .after = {6, 16, 0.047},
                .pairs = 13,
                .gap_change_m = -0.004,
                .gap_change_95_m = {-0.012, 0.0041}};
  change.is_over_settings = true;
  change.now_hold = 4;
  change.now_fail = 3;
  change.better_share_95 = {better_low, better_high};
  return change;
}

TEST_CASE("A change from one sweep to another is told as it was approved") {
  std::string text;
  for (const auto& [low, high] : {std::pair{0.2, 0.8}, {0.51, 0.9}, {0.1, 0.49}}) {
    sweep::SweepChange change = Change(low, high);
    const std::string page = RenderChange(change);
    text += fmt::format("==== {} to {}\n", low, high) + ChangeText(change) + ChangeJson(change) +
            page.substr(page.find("<body"));
  }
  sweep::SweepChange change = Change(0.0, 1.0);
  change.keys.assign(23, {"run.timeout_s", "1", "2"});
  change.settings.resize(1);
  change.is_over_settings = false;
  change.now_hold = change.now_fail = change.only_before = 0;
  text += ChangeText(change);
  change.only_after = 0;
  change.settings.assign(63, change.settings.front());
  change.is_over_settings = true;
  text += ChangeText(change);
  change.keys.clear();
  change.settings.resize(1);
  change.is_over_settings = false;
  const std::string page = RenderChange(change);
  text += ChangeText(change) + page.substr(page.find("<body"));
  CHECK(DifferenceFromPinned("report/change.txt", text) == "");
}

}  // namespace
}  // namespace rift::report
