// The numbers of a sweep's documents beside those that follow from its rows by plain loops, and
// those of tests/report/oracle/make.py, which knows the definitions and nothing of rift.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "plain_numbers.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/yaml/enum_name.hpp"
#include "support/inputs/trials.hpp"
#include "support/tree.hpp"

namespace rift::report {
namespace {

using namespace plain;

void CheckLevel(const json& level, const Rows& rows) {
  const Numbers gaps_m = GapsOf(rows);
  CHECK_NUMBER(level["mean_gap_m"], MeanOf(gaps_m));
  CHECK_NUMBER(level["sd_gap_m"], SdOf(gaps_m));
  CHECK(level["n"] == gaps_m.size());
  CHECK(level["failures"] == CountFailing(rows));
  CHECK(level["told"] == CountTold(rows));
  CHECK(level["not_ok"] == rows.size() - gaps_m.size());
}

/// The chance of an F of that size: the incomplete beta function by Simpson's rule.
double TailOfF(double f, double between, double within) {
  const double end = within / (within + between * f), a = 0.5 * within, b = 0.5 * between;
  constexpr int kSteps = 20000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double t = end * i / kSteps;
    const double value = std::pow(t, a - 1.0) * std::pow(1.0 - t, b - 1.0);
    sum += value * (i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0);
  }
  const double beta = std::exp(std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b));
  return sum * end / kSteps / 3.0 / beta;
}

TEST_CASE("Every number of summary.json follows from the rows of its sweep") {
  const sweep::SweepResult result = WithOneRunTwice();
  const double threshold_m = result.gap.threshold_m;
  const json summary = json::parse(SummaryJson(result));
  CheckLevel(summary, All(result));
  CHECK_NUMBER(summary["definition"]["threshold_m"], 0.045);
  CHECK_NUMBER(summary["definition"]["skip_start"], 0.1);
  CHECK_NUMBER(summary["definition"]["tag_offset_m"], 0.03);
  CHECK_NUMBER(summary["verdicts"]["share"], 0.2);
  CHECK_NUMBER(summary["verdicts"]["confidence"], 0.9);
  CHECK(summary["verdicts"]["settings_judged_together"] == 12);
  CHECK(summary["replaced_references"] ==
        json::parse(R"([{"seed": 7, "used": 9, "reason": "fell"}])"));

  Numbers start_m, aligned_m, shape_m;
  for (const auto& row : result.rows) {
    if (!IsOk(row)) continue;
    start_m.push_back(row.comparison.start_offset_m);
    aligned_m.push_back(row.comparison.start_aligned_gap_m);
    shape_m.push_back(row.comparison.shape_gap_m);
  }
  CHECK_NUMBER(summary["attribution"]["start_offset_m"], MeanOf(start_m));
  CHECK_NUMBER(summary["attribution"]["start_aligned_gap_m"], MeanOf(aligned_m));
  CHECK_NUMBER(summary["attribution"]["shape_gap_m"], MeanOf(shape_m));

  const std::map<std::string, std::vector<size_t>> groupings{
      {"v_min", {0}}, {"surface", {1}}, {"delay_s", {2}}, {"[v_min, delay_s]", {0, 2}}};
  REQUIRE(summary["by"].size() == groupings.size());
  for (const auto& [name, parameters] : groupings) {
    const auto groups = Grouped(result, parameters);
    REQUIRE(summary["by"][name].size() == groups.size());
    for (const auto& [label, rows] : groups) {
      INFO(name << " " << label);
      CheckLevel(summary["by"][name][label], rows);
    }
    if (parameters.size() > 1) continue;
    INFO(name);
    const json& anova = summary["anova"][name];
    const Numbers losses_m = LossesOf(All(result), threshold_m);
    double within = 0.0;
    for (const auto& [label, rows] : groups) within += SquaresOf(LossesOf(rows, threshold_m));
    const double total = SquaresOf(losses_m), between = total - within;
    const double df_between = Real(groups.size()) - 1.0,
                 df_within = Real(losses_m.size() - groups.size());
    const double f = between / df_between / (within / df_within);
    CHECK_NUMBER(anova["df"][0], df_between);
    CHECK_NUMBER(anova["df"][1], df_within);
    CHECK_NUMBER(anova["f"], f);
    CHECK(anova["p"].get<double>() == Approx(TailOfF(f, df_between, df_within)).epsilon(1e-6));
    CHECK_NUMBER(anova["eta_squared"], between / total);
    CHECK_NUMBER(anova["omega_squared"], std::max(0.0, (between - df_between * within / df_within) /
                                                           (total + within / df_within)));
  }

  const auto settings = Grouped(result, {0, 1, 2});
  REQUIRE(summary["settings"].size() == settings.size());
  std::map<std::string, int> verdicts{
      {"falsified", 0}, {"passed", 0}, {"not seen to fail", 0}, {"undecided", 0}};
  for (size_t i = 0; i < settings.size(); ++i) {
    const auto& [label, rows] = settings[i];
    INFO(label);
    const json& setting = summary["settings"][i];
    const auto& theta = rows.front()->theta;
    CHECK_NUMBER(setting["theta"]["v_min"], std::stod(theta[0].text));
    CHECK(setting["theta"]["surface"] == theta[1].text);
    CHECK_NUMBER(setting["theta"]["delay_s"], std::stod(theta[2].text));
    CHECK_NUMBER(setting["mean_gap_m"], MeanOf(GapsOf(rows)));
    const Numbers losses_m = LossesOf(rows, threshold_m);
    CHECK_NUMBER(setting["mean_loss_m"], MeanOf(losses_m));
    CHECK_NUMBER(setting["loss_low_m"], MeanOf(losses_m) - HalfWidth(losses_m));
    CHECK_NUMBER(setting["loss_high_m"], MeanOf(losses_m) + HalfWidth(losses_m));
    const Rows distinct = Distinct(rows);
    CHECK(setting["n"] == CountTold(distinct));
    CHECK(setting["failures"] == CountFailing(distinct));
    CHECK_NUMBER(setting["noise_floor_m"], 0.01 + 0.0011 * static_cast<double>(i));
    ++verdicts.at(setting["verdict"]);
    // Two or three runs decide nothing in twelve settings.
    CHECK(setting["verdict"] == (CountFailing(distinct) > 0 ? "undecided" : "not seen to fail"));
    CHECK((setting["share_low"] == 0.0) == (CountFailing(distinct) == 0));
    CHECK((setting["share_high"] == 1.0) == (CountFailing(distinct) == CountTold(distinct)));
  }
  for (const auto& [name, count] : verdicts) CHECK(summary["verdicts"][name] == count);
}

TEST_CASE("In short: runs off the path, runs that do not arrive and lost logs are counted apart") {
  const sweep::SweepResult result = WithOneRunTwice();
  long off = 0, ended = 0, lost = 0;
  std::map<sweep::TrialStatus, long> kinds;
  for (const auto& row : result.rows) {
    off += IsOk(row) && row.falsified ? 1 : 0;
    ended += !IsOk(row) && row.falsified ? 1 : 0;
    lost += !IsOk(row) && !row.falsified ? 1 : 0;
    if (!IsOk(row) && !row.falsified) ++kinds[row.status];
  }
  REQUIRE((off > 0 && ended > 0 && lost > 0));
  const std::string text = BriefText(result, sweep::Explain(result));
  INFO(text);
  std::string how;
  for (const auto& [status, n] : kinds) {
    how += fmt::format("{}{} {}", how.empty() ? "" : ", ", n, yaml::NameOf(status));
  }
  CHECK(text.find(fmt::format("0 of 12 settings; {} of {} runs exceed 0.045 m, and {} fail by not "
                              "arriving; {} more tell nothing ({})\n",
                              off, CountTold(All(result)), ended, lost, how)) != text.npos);
}

TEST_CASE("What explanation.json says of rows, parts and cells follows from the rows") {
  const sweep::SweepResult result = WithOneRunTwice();
  const json told = json::parse(ExplanationJson(result, sweep::Explain(result)));
  CHECK(told["effects"]["trials"] == LossesOf(All(result), result.gap.threshold_m).size());

  const auto settings = Grouped(result, {0, 1, 2});
  const auto check = [&](const char* key, const auto& of_row) {
    Numbers means;
    for (const auto& [label, rows] : settings) {
      Numbers values;
      for (const auto* row : Distinct(rows)) {
        if (IsOk(*row)) values.push_back(of_row(*row));
      }
      if (!values.empty()) means.push_back(MeanOf(values));
    }
    INFO(key);
    const json& part = told["anatomy"][key];
    CHECK(part["n"] == means.size());
    CHECK_NUMBER(part["mean"], MeanOf(means));
    CHECK_NUMBER(part["low"], MeanOf(means) - HalfWidth(means));
    CHECK_NUMBER(part["high"], MeanOf(means) + HalfWidth(means));
  };
  using Row = sweep::TrialRow;
  check("gap_m", [](const Row& r) { return r.comparison.gap_m; });
  check("start_m",
        [](const Row& r) { return r.comparison.gap_m - r.comparison.start_aligned_gap_m; });
  check("frame_m",
        [](const Row& r) { return r.comparison.start_aligned_gap_m - r.comparison.shape_gap_m; });
  check("shape_m", [](const Row& r) { return r.comparison.shape_gap_m; });
  check("pace_m", [](const Row& r) { return r.comparison.gap_m - r.comparison.frechet_m; });
  check("timing_m", [](const Row& r) { return r.comparison.equal_time_m - r.comparison.gap_m; });
  check("goal_m", [](const Row& r) { return r.comparison.gap_m - r.way_gap_m; });
  Numbers floors_m, removable_m;
  for (size_t i = 0; i < settings.size(); ++i) {
    floors_m.push_back(0.01 + 0.0011 * static_cast<double>(i));
    const double mean_m = MeanOf(GapsOf(Distinct(settings[i].second)));
    if (!std::isnan(mean_m)) removable_m.push_back(mean_m - floors_m.back());
  }
  for (const auto& [key, values] :
       {std::pair{"noise_m", floors_m}, std::pair{"removable_m", removable_m}}) {
    INFO(key);
    CHECK_NUMBER(told["anatomy"][key]["mean"], MeanOf(values));
    CHECK_NUMBER(told["anatomy"][key]["high"], MeanOf(values) + HalfWidth(values));
  }
  long only_at_goal = 0;
  for (const auto& row : result.rows) {
    only_at_goal += IsOk(row) && row.comparison.gap_m > 0.045 && row.way_gap_m <= 0.045 ? 1 : 0;
  }
  CHECK(told["anatomy"]["only_at_goal"] == only_at_goal);
  REQUIRE(only_at_goal > 0);

  // Each failing row is of one kind, and a kind tells the means of its rows.
  std::set<int> failing, grouped;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    if (result.rows[i].falsified) failing.insert(static_cast<int>(i) + 1);
  }
  for (const json& kind : told["failures"]) {
    Numbers gaps_m, places;
    for (const int id : kind["rows"]) {
      const sweep::TrialRow& row = result.rows[id - 1];
      CHECK(grouped.insert(id).second);
      CHECK(kind["status"] == (IsOk(row) ? "ok" : "fell"));
      if (!IsOk(row)) continue;
      gaps_m.push_back(row.comparison.gap_m);
      places.push_back(row.comparison.gap_u);
    }
    CHECK(kind["trials"] == kind["rows"].size());
    CHECK(kind["typical_row"] == kind["rows"][0]);
    CHECK_NUMBER(kind["mean_gap_m"], MeanOf(gaps_m));
    CHECK_NUMBER(kind["mean_u"], MeanOf(places));
  }
  for (const int id : grouped) CHECK(failing.count(id) == 1);

  const json& region = told["failing_region"];
  const std::map<std::string, size_t> place{{"v_min", 0}, {"surface", 1}, {"delay_s", 2}};
  const size_t x = place.at(region["x"]), y = place.at(region["y"]);
  std::set<std::pair<std::string, std::string>> cells;
  for (const json& cell : region["cells"]) {
    Rows rows;
    for (const auto* row : All(result)) {
      if (row->theta[x].text == cell["x"] && row->theta[y].text == cell["y"]) rows.push_back(row);
    }
    INFO(cell.dump());
    cells.emplace(cell["x"].get<std::string>(), cell["y"].get<std::string>());
    CHECK(cell["trials"] == CountTold(rows));
    CHECK_NUMBER(cell["share"], CountFailing(rows) / static_cast<double>(CountTold(rows)));
  }
  CHECK(cells.size() == result.parameters[x].levels.size() * result.parameters[y].levels.size());

  size_t undecided = 0;
  for (const auto& [label, rows] : settings) {
    const Rows distinct = Distinct(rows);
    if (CountFailing(distinct) == 0) continue;
    REQUIRE(undecided < told["undecided"].size());
    const json& setting = told["undecided"][undecided++];
    INFO(label);
    CHECK(setting["failures"] == CountFailing(distinct));
    CHECK(setting["n"] == CountTold(distinct));
    CHECK_NUMBER(setting["mean_gap_m"], MeanOf(GapsOf(rows)));
    json ids = json::array();
    for (const auto* row : rows) ids.push_back(row - result.rows.data() + 1);
    CHECK(setting["rows"] == ids);
  }
  CHECK(undecided == told["undecided"].size());
}

TEST_CASE("Each number of summary.json and explanation.json is the one that SciPy has for it") {
  const json oracle =
      json::parse(test::ReadFile(test::SourceDir() + "/tests/report/oracle/values.json"));
  const sweep::SweepResult result = synthetic::Uneven();
  // What the sweep was told, and no result.
  const std::vector<std::string> settings{"/definition/", "/replaced_references/",
                                          "/verdicts/share", "/verdicts/confidence"};
  size_t checked = 0;
  for (const auto& [name, text] : std::map<std::string, std::string>{
           {"summary", SummaryJson(result)},
           {"explanation", ExplanationJson(result, sweep::Explain(result))}}) {
    const json told = json::parse(text).flatten();
    for (const auto& [pointer, expected] : oracle[name].items()) {
      INFO(name << " " << pointer << " " << expected);
      REQUIRE(told.contains(pointer));
      INFO(told[pointer]);
      if (expected.is_number()) {
        REQUIRE(told[pointer].is_number());
        CHECK(told[pointer].get<double>() ==
              Approx(expected.get<double>()).epsilon(1e-8).margin(1e-12));
      } else {
        CHECK(told[pointer] == expected);
      }
      ++checked;
    }
    for (const auto& item : told.items()) {
      const std::string& pointer = item.key();
      INFO(name << " " << pointer << " is " << item.value()
                << ", of which the oracle does not know");
      const bool is_setting =
          std::any_of(settings.begin(), settings.end(),
                      [&](const std::string& start) { return pointer.rfind(start, 0) == 0; });
      CHECK((!item.value().is_number() || is_setting || oracle[name].contains(pointer)));
    }
  }
  CHECK(checked > 450);
}

}  // namespace
}  // namespace rift::report
