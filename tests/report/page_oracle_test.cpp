// The numbers of a sweep's page, and where its links lead, beside what follows from its rows by
// plain loops.

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "plain_numbers.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/page/page.hpp"
#include "rift/report/text/findings.hpp"
#include "rift/sweep/falsify/evidence.hpp"

namespace rift::report {
namespace {

using namespace plain;

json Data(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="page-data">)";
  const size_t begin = page.find(open) + open.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::string Decoded(const std::string& text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%') {
      plain += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

/// A parameter's own, which holds no dot; of the page's own columns the title after one.
std::string NameInLinks(const json& column) {
  if (column.contains("name")) return column["name"];
  return "." + column["title"].get<std::string>();
}

/// What page.js shows for a link: the rows whose cells are the values of the query.
std::vector<size_t> LinkedRows(const json& table, const std::string& query) {
  std::vector<size_t> rows;
  for (size_t i = 0; i < table["rows"].size(); ++i) rows.push_back(i);
  for (size_t begin = 0; begin < query.size();) {
    const size_t end = std::min(query.find('&', begin), query.size());
    const size_t equals = query.find('=', begin);
    const std::string name = Decoded(query.substr(begin, equals - begin));
    const std::string value = Decoded(query.substr(equals + 1, end - equals - 1));
    std::set<std::string> values{value};
    if (name == ".row") {
      values.clear();
      for (size_t at = 0; at <= value.size();) {
        const size_t comma = std::min(value.find(',', at), value.size());
        values.insert(value.substr(at, comma - at));
        at = comma + 1;
      }
    }
    size_t column = 0;
    while (NameInLinks(table["columns"][column]) != name) {
      ++column;
    }
    std::erase_if(rows, [&](size_t row) {
      if (name == ".result" && value == "failed") return table["marks"][row] != "fail";
      const json& cell = table["rows"][row][column];
      return values.count(cell.is_string() ? cell.get<std::string>() : cell.dump()) == 0;
    });
    begin = end + 1;
  }
  return rows;
}

size_t ColumnOf(const json& table, const std::string& title) {
  for (size_t i = 0; i < table["columns"].size(); ++i) {
    if (table["columns"][i]["title"] == title) return i;
  }
  FAIL("there is no column " << title);
  return 0;
}

TEST_CASE("Every cell of the page's table of trials is that of its row") {
  const sweep::SweepResult result = WithOneRunTwice();
  const json table = Data(RenderPage(result))["trials"];
  REQUIRE(table["rows"].size() == result.rows.size());
  const std::vector<std::pair<const char*, double gap::Comparison::*>> columns{
      {"gap (m)", &gap::Comparison::gap_m},
      {"at u", &gap::Comparison::gap_u},
      {"exact gap (m)", &gap::Comparison::exact_gap_m},
      {"mean error (m)", &gap::Comparison::mean_error_m},
      {"start offset (m)", &gap::Comparison::start_offset_m},
      {"start-aligned gap (m)", &gap::Comparison::start_aligned_gap_m},
      {"shape gap (m)", &gap::Comparison::shape_gap_m},
      {"end error (m)", &gap::Comparison::end_error_m},
      {"length ratio", &gap::Comparison::length_ratio}};
  for (size_t i = 0; i < result.rows.size(); ++i) {
    const sweep::TrialRow& row = result.rows[i];
    const json& cells = table["rows"][i];
    INFO("row " << i + 1);
    CHECK(cells[ColumnOf(table, "row")] == i + 1);
    CHECK(cells[ColumnOf(table, "v_min")] == row.theta[0].text);
    CHECK(cells[ColumnOf(table, "surface")] == row.theta[1].text);
    CHECK(cells[ColumnOf(table, "delay (s)")] == row.theta[2].text);
    CHECK(cells[ColumnOf(table, "trial")] == row.trial);
    CHECK(cells[ColumnOf(table, "reason")] == row.reason);
    CHECK(cells.back() == i + 1);
    const bool is_missing = row.status == sweep::TrialStatus::kMissing;
    CHECK(cells[ColumnOf(table, "result")] == (!IsOk(row)      ? is_missing ? "missing" : "fell"
                                               : row.falsified ? "above threshold"
                                                               : "holds"));
    CHECK(table["marks"][i] == (row.falsified ? "fail" : is_missing ? "unknown" : ""));
    for (const auto& [title, member] : columns) {
      CHECK_NUMBER(cells[ColumnOf(table, title)], IsOk(row) ? row.comparison.*member : NAN);
    }
  }
}

TEST_CASE("The page's table of settings begins with the worst and counts their trials") {
  const sweep::SweepResult result = WithOneRunTwice();
  const json table = Data(RenderPage(result))["settings"];
  const json summary = json::parse(SummaryJson(result));
  const auto groups = Grouped(result, {0, 1, 2});
  REQUIRE(table["rows"].size() == groups.size());
  std::pair last(HUGE_VAL, HUGE_VAL);  // share that fails, mean loss
  for (size_t i = 0; i < groups.size(); ++i) {
    const json& cells = table["rows"][i];
    const std::string label = fmt::format("[{}, {}, {}]", cells[0].get<std::string>(),
                                          cells[1].get<std::string>(), cells[2].get<std::string>());
    INFO(label);
    size_t at = 0;
    while (groups.at(at).first != label) ++at;
    const Rows& rows = groups[at].second;
    const double mean_m = MeanOf(GapsOf(rows));
    CHECK_NUMBER(cells[ColumnOf(table, "mean gap (m)")], mean_m);
    const double share = static_cast<double>(CountFailing(Distinct(rows))) /
                         std::max<double>(1.0, CountTold(Distinct(rows)));
    CHECK(share <= last.first);
    if (share == last.first && std::isfinite(mean_m)) CHECK(mean_m <= last.second + 1e-9);
    last = {share, std::isfinite(mean_m) ? mean_m : last.second};
    CHECK(cells[ColumnOf(table, "failed")] == CountFailing(Distinct(rows)));
    CHECK(cells[ColumnOf(table, "trials")] == CountTold(Distinct(rows)));
    CHECK(cells[ColumnOf(table, "without gap")] == rows.size() - GapsOf(rows).size());
    CHECK_NUMBER(cells[ColumnOf(table, "noise floor (m)")],
                 0.01 + 0.0011 * static_cast<double>(at));
    const json& setting = summary["settings"][at];
    CHECK_NUMBER(cells[ColumnOf(table, "share from (%)")],
                 100.0 * setting["share_low"].get<double>());
    CHECK_NUMBER(cells[ColumnOf(table, "share to (%)")],
                 100.0 * setting["share_high"].get<double>());
    CHECK(table["marks"][i] == (CountFailing(Distinct(rows)) > 0 ? "unknown" : ""));
  }
}

/// Of trials, those that the query's parameters choose.
void CheckLinks(const json& pieces, const json& table, const sweep::SweepResult& result) {
  for (const json& piece : pieces) {
    const std::string text = piece[0], query = piece[1];
    if (query.empty()) continue;
    INFO("\"" << text << "\" leads to " << query);
    const std::vector<size_t> rows = LinkedRows(table, query);
    CHECK(!rows.empty());
    size_t end = 0;
    const double number =
        std::isdigit(static_cast<unsigned char>(text[0])) != 0 ? std::stod(text, &end) : NAN;
    const std::string unit = text.substr(end);
    if (unit == " m") {
      REQUIRE(rows.size() == 1);
      CHECK(number == Approx(result.rows[rows[0]].comparison.gap_m).margin(5e-5));
    } else if (unit == " trials" || unit.empty()) {
      const auto tells = [&](size_t row) {
        return result.rows[row].falsified || IsOk(result.rows[row]);
      };
      CHECK(number == Real(std::count_if(rows.begin(), rows.end(), tells)));
    }
  }
}

TEST_CASE("Each linked number of the page leads to as many rows of its table") {
  const sweep::SweepResult result = WithOneRunTwice();
  const sweep::Explanation explanation = sweep::Explain(result);
  const json data = Data(RenderPage(result));
  const auto pieces = [](const Sentence& sentence) {
    json list = json::array();
    for (const Piece& piece : sentence.pieces()) list.push_back({piece.text, piece.query});
    return list;
  };
  const std::vector<Finding> findings = Findings(result, explanation);
  for (const size_t question : {size_t{0}, size_t{2}, size_t{4}, size_t{5}, size_t{6}}) {
    for (const Sentence& sentence : findings[question].sentences) {
      CheckLinks(pieces(sentence), data["trials"], result);
    }
  }
  REQUIRE(data["views"].size() == 1 + 3 + 2 + 2 + 12);
  for (size_t k = 0; k < data["views"].size(); ++k) {
    const json& view = data["views"][k];
    // Links of a view add to the rows that it shows.
    json trials = data["trials"];
    json shown = json::array(), marks = json::array();
    sweep::SweepResult part = result;
    part.rows.clear();
    Rows rows;
    for (const size_t row : LinkedRows(trials, view["query"])) {
      shown.push_back(trials["rows"][row]);
      marks.push_back(trials["marks"][row]);
      part.rows.push_back(result.rows[row]);
      rows.push_back(&result.rows[row]);
    }
    trials["rows"] = shown;
    trials["marks"] = marks;
    INFO("view " << view["name"]);
    CheckLinks(view["headline"], trials, part);
    CHECK(view["outcome"] == (CountFailing(rows) > 0 ? "fail" : "pass"));
    std::string text;
    for (const json& piece : view["headline"]) text += piece[0].get<std::string>();
    INFO(text);
    const double mean_m = MeanOf(GapsOf(rows));
    if (CountFailing(rows) > 0) {
      CHECK(text.find(fmt::format("It fails: {} of {} measured trial", CountFailing(rows),
                                  CountTold(rows))) != text.npos);
      CHECK(text.find(fmt::format("({:.0f} %)", 100.0 * CountFailing(rows) / CountTold(rows))) !=
            text.npos);
    } else {
      CHECK(text.find(fmt::format("none of {} measured trial", CountTold(rows))) != text.npos);
    }
    CHECK(text.find(fmt::format("mean gap {:.4f} m", mean_m)) != text.npos);

    // The map and the histogram of the view.
    const json& map = data["charts"][0];
    for (size_t i = 0; i < map["views"][k].size(); ++i) {
      const json& cell = map["spec"]["data"][0]["values"][i];
      Rows in_cell;
      for (const size_t row : LinkedRows(data["trials"], cell["query"])) {
        const auto* one = &result.rows[row];
        if (std::find(rows.begin(), rows.end(), one) != rows.end()) in_cell.push_back(one);
      }
      INFO("cell " << cell["tip"].dump());
      CHECK(map["views"][k][i][1] == CountTold(in_cell));
      const double share = CountTold(in_cell) == 0 ? NAN
                                                   : 100.0 * CountFailing(in_cell) /
                                                         static_cast<double>(CountTold(in_cell));
      if (std::isnan(share)) {
        CHECK(map["views"][k][i][0].is_null());
      } else {
        CHECK(map["views"][k][i][0].get<double>() == Approx(share).margin(0.051));
      }
    }
    const json& histogram = data["charts"].back();
    REQUIRE(histogram["fields"] == json({"count"}));
    const json& bins = histogram["spec"]["data"][0]["values"];
    for (size_t i = 0; i < bins.size(); ++i) {
      const double from_m = bins[i]["from"], to_m = bins[i]["to"];
      long count = 0;
      for (const double gap_m : GapsOf(rows)) count += gap_m > from_m && gap_m <= to_m ? 1 : 0;
      INFO("bin " << from_m << " to " << to_m);
      CHECK(histogram["views"][k][i][0] == count);
      if (k == 0) CHECK((bins[i]["colour"] == bins.back()["colour"]) == (from_m > 0.0449));
    }
  }
}

TEST_CASE("Axes of the page's map are the parameters of its cells, and its cells lead there") {
  const sweep::SweepResult result = WithOneRunTwice();
  const json data = Data(RenderPage(result));
  const json& spec = data["charts"][0]["spec"];
  std::map<std::string, json> signals;
  for (const json& signal : spec["signals"])
    signals[signal["name"]] = signal.value("value", json());
  CHECK(signals["x_title"] == "delay (s)");
  CHECK(signals["y_title"] == "v_min");
  for (const json& cell : spec["data"][0]["values"]) {
    CHECK(cell["tip"] == json({{"delay (s)", cell["column"]}, {"v_min", cell["line"]}}));
    CHECK(cell["query"] == fmt::format("delay_s={}&v_min={}", cell["column"].get<std::string>(),
                                       cell["line"].get<std::string>()));
  }
  CHECK(data["paths"]["threshold_m"] == 0.045);
  const json& histogram = data["charts"].back()["spec"];
  for (const json& signal : histogram["signals"]) {
    if (signal["name"] == "threshold") CHECK(signal["value"] == 0.045);
    if (signal["name"] == "x_title") CHECK(signal["value"] == "gap (m)");
  }
}

/// From y = 0, the way it goes along x, the worst row apart from all others.
TEST_CASE("The paths of the page are those of their rows, references and views") {
  sweep::SweepResult result = WithOneRunTwice();
  PageEvidence evidence;
  for (int i = 0; i < 2; ++i) {
    evidence.references.push_back({fmt::format("robot, trial {}", i + 1), {}});
    for (int k = 0; k <= sweep::kPathSteps; ++k) {
      evidence.references[i].path_m.emplace_back(0.01F * static_cast<float>(k),
                                                 0.1F * static_cast<float>(i + 1));
      if (i == 1) evidence.references[i].times_s.push_back(0.25F * static_cast<float>(k));
    }
  }
  for (size_t i = 0; i < result.rows.size(); ++i) {
    evidence.reference_of_row.push_back(result.rows[i].theta[1].text == "ground" ? 0 : 1);
    for (int k = 0; k <= sweep::kPathSteps; ++k) {
      result.rows[i].evidence.path_m.emplace_back(0.01F * static_cast<float>(k),
                                                  0.001F * static_cast<float>(i + 1));
      result.rows[i].evidence.path_times_s.push_back(0.1F * static_cast<float>((i + 1) * k));
    }
  }
  result.rows[1].evidence.path_times_s.back() = NAN;
  evidence.waypoints = {{"a", {0.25, -0.5}}};
  const json data = Data(RenderPage(result, sweep::Explain(result), evidence));
  const json& paths = data["paths"];
  CHECK(paths["waypoints"] == json::parse(R"([{"name": "a", "x": 0.25, "y": -0.5}])"));
  const auto points = [&](const json& steps) {
    std::vector<std::pair<double, double>> all;
    double x = 0.0, y = 0.0;
    for (size_t i = 0; i + 1 < steps.size(); i += 2) {
      x += paths["unit_m"].get<double>() * steps[i].get<double>();
      y += paths["unit_m"].get<double>() * steps[i + 1].get<double>();
      all.emplace_back(x, y);
    }
    return all;
  };
  for (size_t i = 0; i < 2; ++i) {
    CHECK(paths["references"][i]["name"] == fmt::format("robot, trial {}", i + 1));
    const auto line = points(paths["references"][i]["d"]);
    REQUIRE(line.size() == 65);
    for (const auto& [x, y] : line) CHECK(y == Approx(0.1 * Real(i + 1)).margin(2e-4));
    CHECK(line.back().first == Approx(0.64).margin(2e-4));
  }
  const auto seconds = [&](const json& steps) {
    double sum_s = 0.0;
    for (const json& step : steps) sum_s += paths["unit_s"].get<double>() * step.get<double>();
    return sum_s;
  };
  CHECK(paths["references"][0]["t"] == json::array());
  CHECK(paths["references"][1]["t"].size() == 64);
  CHECK(seconds(paths["references"][1]["t"]) == Approx(16.0).margin(0.0006));
  CHECK(paths["rows"]["2"]["t"] == json::array());
  REQUIRE(paths["rows"].size() == result.rows.size());
  for (size_t i = 0; i < result.rows.size(); ++i) {
    const sweep::TrialRow& row = result.rows[i];
    const json& drawn = paths["rows"][std::to_string(i + 1)];
    const auto line = points(drawn["d"]);
    REQUIRE(line.size() == 65);
    CHECK(line.back().first == Approx(0.64).margin(2e-4));
    CHECK(line[7].second == Approx(0.001 * Real(i + 1)).margin(2e-4));
    if (i != 1) CHECK(seconds(drawn["t"]) == Approx(6.4 * Real(i + 1)).margin(0.0006));
    CHECK(drawn["fails"] == row.falsified);
    CHECK(drawn["reference"] == (row.theta[1].text == "ground" ? 0 : 1));
    if (IsOk(row)) {
      CHECK(drawn["u"].get<double>() == Approx(row.comparison.gap_u).margin(5.1e-5));
    } else {
      CHECK(drawn["u"].is_null());
    }
  }
  for (size_t k = 0; k < data["views"].size(); ++k) {
    const std::vector<size_t> rows = LinkedRows(data["trials"], data["views"][k]["query"]);
    const json& view = paths["views"][k];
    json ids = json::array();
    std::set<int> references;
    std::optional<size_t> worst;
    Numbers offsets_m;
    for (const size_t row : rows) {
      ids.push_back(row + 1);
      references.insert(evidence.reference_of_row[row]);
      if (!IsOk(result.rows[row])) continue;
      offsets_m.push_back(0.001 * Real(row + 1));
      const bool is_worse =
          !worst || result.rows[row].comparison.gap_m > result.rows[*worst].comparison.gap_m;
      if (is_worse) worst = row;
    }
    INFO("view " << data["views"][k]["name"]);
    const json& lines = view["lines"];  // of more than 30 some
    CHECK(lines.size() == std::min<size_t>(30, rows.size()));
    CHECK(std::includes(ids.begin(), ids.end(), lines.begin(), lines.end()));
    CHECK(view["drawn_of"] == rows.size());
    CHECK(view["references"] == json(references));
    REQUIRE(worst);
    CHECK(view["worst"] == *worst + 1);
    CHECK(view.contains("band") == (offsets_m.size() >= 8));
    if (!view.contains("band")) continue;
    CHECK(view["band_of"] == offsets_m.size());
    // Up the left side at the 95 % quantile, down the right one at the 5 % quantile.
    const auto band = points(view["band"]);
    REQUIRE(band.size() == 130);
    const auto quantile = [&](double share) {
      const double place = share * Real(offsets_m.size() - 1);
      const size_t below = static_cast<size_t>(place);
      return offsets_m[below] + (place - Real(below)) * (offsets_m[below + 1] - offsets_m[below]);
    };
    CHECK(band[30].second == Approx(quantile(0.95)).margin(4e-4));
    CHECK(band[100].second == Approx(quantile(0.05)).margin(4e-4));
    CHECK(band[30].first == Approx(0.30).margin(4e-4));
    CHECK(band[100].first == Approx(0.29).margin(4e-4));
  }
}

}  // namespace
}  // namespace rift::report
