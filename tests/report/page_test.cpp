#include "rift/report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "report/synthetic_sweep.hpp"
#include "rift/sweep/falsify/evidence.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;
using nlohmann::json;

/// What stands before the first script: the words of the page.
std::string Words(const std::string& page) {
  static const std::regex kLinks("</?a[^>]*>");
  return std::regex_replace(page.substr(0, page.find("<script")), kLinks, "");
}

json Data(const std::string& page) {
  const std::string open = R"(<script type="application/json" id="page-data">)";
  const std::size_t begin = page.find(open) + open.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

TEST_CASE("A level with one trial is compared with others and one without any is not") {
  sweep::SweepResult result = synthetic::Grid();
  for (std::size_t i = 1; i < 16; ++i) synthetic::LoseGap(&result.rows[i], "no file");
  sweep::Summarise(result);
  CHECK_THAT(Words(RenderPage(result)),
             Contains("Most often at surface rock (8 of 8 trials), least often at ice (0 of 1 "
                      "trials)."));
}

TEST_CASE("Where it fails is told of the parameter whose levels are furthest apart") {
  sweep::SweepResult result = synthetic::Grid();
  for (sweep::TrialRow& row : result.rows) {
    if (!row.IsOk()) continue;
    const bool is_fast = row.theta[2].text == "0.50", is_rock = row.theta[0].text == "rock";
    const double gap_m = is_fast || (is_rock && row.trial == "1") ? 0.08 : 0.01;
    row = synthetic::Row(row.theta, row.trial, gap_m);
  }
  sweep::Summarise(result);
  CHECK_THAT(Words(RenderPage(result)),
             Contains("Most often at v_max 0.50 (12 of 12 trials), least often at 0.30 (2 of 11 "
                      "trials)."));
}

TEST_CASE("The first screen answers from the data") {
  const sweep::SweepResult result = synthetic::Grid();
  const std::string words = Words(RenderPage(result));
  // 24 trials, one lost; the 8 on rock have 0.066 and 0.074 m, all above 0.06.
  CHECK_THAT(words, Contains("It fails: 8 of 23 measured trials exceed 0.06 m (35 %)"));
  CHECK_THAT(words, Contains("Most often at surface rock (8 of 8 trials), least often at ice (0 of "
                             "7 trials)."));
  CHECK_THAT(words, Contains("The largest gap, 0.0740 m, is rock, v_min 0.15, v_max 0.30, trial 2, "
                             "at u = 0.75"));
  CHECK_THAT(words, Contains("0 of 12 falsified, 0 passed, 8 not seen to fail, 4 undecided"));
  CHECK_THAT(words, Contains("Without a gap: 1 of 24 trials (1 missing)."));
  CHECK_THAT(words, Contains("1 setting judged by fewer repeats than asked for."));
  CHECK_THAT(words, Contains("ice, v_min 0.15, v_max 0.30, trial 2: missing – no file real2.csv"));
}

TEST_CASE("Each parameter's effect stands on the page by the one measure") {
  const sweep::SweepResult result = synthetic::Grid();
  const std::string words = Words(RenderPage(result));
  const sweep::Effects effects = sweep::MeasureEffects(result);
  REQUIRE(effects.parameters.size() == 3);
  CHECK(effects.parameters.front().name == "surface");
  CHECK(effects.parameters.front().IsSeen());
  const std::string& sentence = effects.parameters.front().sentence;
  CHECK_THAT(words, Contains(sentence.substr(0, sentence.find('\''))));
  for (const sweep::ParameterEffect& effect : effects.parameters) {
    CHECK_THAT(words, Contains(effect.name));
  }
}

TEST_CASE("The gap stands beside the noise floor and the share of the start pose") {
  const sweep::SweepResult result = synthetic::Grid();
  const double mean_m = result.all.mean_gap_m;
  const std::string words = Words(RenderPage(result));
  CHECK_THAT(words, Contains(fmt::format("0.0200 m apart from each other (noise floor, mean of 12 "
                                         "settings); the mean gap to the candidate is {:.4f} m, "
                                         "{:.2f} times that",
                                         mean_m, mean_m / 0.02)));
  // Over the settings, of which the first lost a trial: 0.026 m instead of 0.03 m.
  const double of_settings_m = (12.0 * 0.05 - 0.004) / 12.0;
  CHECK_THAT(words, Contains(fmt::format("Mean gap over the settings {:.4f} m; with the first "
                                         "points laid together {:.4f} m (-20 %); {:.4f} m is shape",
                                         of_settings_m, 0.8 * of_settings_m, 0.5 * of_settings_m)));
}

TEST_CASE("Settings with failures that are too few to decide are counted as undecided") {
  sweep::SweepResult result = synthetic::Grid();
  for (auto& row : result.rows) {
    if (!row.IsOk()) continue;
    row.comparison.gap_m += 0.01;
    row.falsified = row.comparison.gap_m > 0.06;
  }
  sweep::Summarise(result);
  CHECK_THAT(Words(RenderPage(result)),
             Contains("0 of 12 falsified, 0 passed, 4 not seen to fail, 8 undecided"));
}

TEST_CASE("A sweep that holds says so") {
  sweep::SweepResult result = synthetic::Grid({"ice"});
  CHECK_THAT(Words(RenderPage(result)),
             Contains("No failure: none of 7 measured trials exceeds 0.06 m"));
}

TEST_CASE("A sweep without a single gap claims nothing") {
  sweep::SweepResult result = synthetic::Grid();
  for (auto& row : result.rows) synthetic::LoseGap(&row, "gone");
  sweep::Summarise(result);
  for (auto& setting : result.settings) setting.noise_floor_m = gap::kNotComputed;
  const std::string page = RenderPage(result);
  CHECK_THAT(Words(page), Contains("Not known whether it fails: no trial has a gap."));
  CHECK_THAT(Words(page), Contains("0 not seen to fail, 12 undecided"));
  CHECK_THAT(Words(page), !Contains("nan"));
  CHECK(Data(page)["charts"].empty());
}

TEST_CASE("Names cannot become markup") {
  const std::string hostile = "</script><script>alert('x')</script><!-- \"ü\" & {{name}}";
  sweep::SweepResult result = synthetic::Grid({"ice", hostile, "rock"});
  result.name = hostile;
  synthetic::LoseGap(&result.rows[9], hostile);
  sweep::Summarise(result);
  const std::string page = RenderPage(result);
  CHECK_THAT(page, !Contains("<script>alert") && !Contains("<!-- \""));
  CHECK_THAT(page, Contains("&lt;script&gt;alert"));
  CHECK(Data(page)["trials"]["rows"][8][1] == hostile);
}

TEST_CASE("Bytes that are no text do not break the page") {
  sweep::SweepResult result = synthetic::Grid({"ice", "bad\xff\xfe", "rock"});
  result.name = "bad\xff";
  CHECK_THAT(RenderPage(result), !Contains("\xff"));
}

TEST_CASE("The page asks for no other file") {
  const std::string page = RenderPage(synthetic::Grid());
  for (const char* reference : {"src=", "sourceMappingURL", "@import", "url(", "<iframe"}) {
    INFO(reference);
    CHECK_THAT(Words(page), !Contains(reference));
  }
  CHECK_THAT(page, !Contains("sourceMappingURL"));
  CHECK_THAT(page, Contains("default-src 'none'"));
}

TEST_CASE("The same result gives the same page") {
  CHECK(RenderPage(synthetic::Grid()) == RenderPage(synthetic::Grid()));
}

TEST_CASE("The tables hold every trial and setting with numbers as numbers") {
  const sweep::SweepResult result = synthetic::Grid();
  const json data = Data(RenderPage(result));
  CHECK(data["trials"]["rows"].size() == result.rows.size());
  CHECK(data["settings"]["rows"].size() == result.settings.size());
  const json& columns = data["trials"]["columns"];
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i]["title"] != "gap (m)") continue;
    CHECK(data["trials"]["rows"][0][i] == result.rows[0].comparison.gap_m);
    CHECK(data["trials"]["rows"][1][i].is_null());
  }
}

TEST_CASE("A row of recorded logs shows how it is measured again") {
  sweep::SweepResult result = synthetic::Grid();
  result.rows[0].candidate = "/logs/sim ice.csv";
  result.rows[0].reference = "/logs/real1.csv";
  const json data = Data(RenderPage(result, {}, {.gap_flags = " --real-format tracker"}));
  CHECK(data["trials"]["columns"].back()["again"] == "gap");
  CHECK(data["trials"]["rows"][0].back() ==
        "'/logs/sim ice.csv' /logs/real1.csv --real-format tracker");
  CHECK(data["trials"]["rows"][1].back().is_null());  // it has no gap
  CHECK(Data(RenderPage(result))["trials"]["rows"][0].back() == 1);
}

TEST_CASE("The filter offers each value of a parameter and each setting, with its own sentence") {
  const json views = Data(RenderPage(synthetic::Grid()))["views"];
  // All, 3 surfaces, 2 v_min, 2 v_max, 12 settings.
  REQUIRE(views.size() == 1 + 3 + 2 + 2 + 12);
  const auto view = [&](const std::string& query) {
    for (const json& one : views) {
      if (one["query"] == query) return one;
    }
    return json{{"outcome", "there is no view " + query}};
  };
  CHECK(view("")["outcome"] == "fail");
  CHECK_THAT(view("surface=rock")["headline"].dump(), Contains("[\"8\",\".result=failed\"]"));
  CHECK(view("surface=ice")["outcome"] == "pass");
  CHECK(view("surface=rock&v_min=0.15&v_max=0.30")["name"] ==
        "setting rock, v_min 0.15, v_max 0.30");
}

TEST_CASE("The map and the histogram of a view count its trials alone") {
  const json data = Data(RenderPage(synthetic::Grid()));
  const json& map = data["charts"][0];
  const json& histogram = data["charts"].back();
  REQUIRE(map["fields"] == json({"value", "trials"}));
  REQUIRE(histogram["fields"] == json({"count"}));
  const auto told = [](const json& chart, std::size_t view, int field) {
    int sum = 0;
    for (const json& entry : chart["views"][view]) sum += entry[field].get<int>();
    return sum;
  };
  CHECK(told(map, 0, 1) == 23);  // one of the 24 is lost
  CHECK(told(histogram, 0, 0) == 23);
  CHECK(data["views"][3]["query"] == "surface=rock");
  CHECK(told(map, 3, 1) == 8);
  CHECK(told(histogram, 3, 0) == 8);
}

sweep::SweepResult WithPaths(sweep::SweepResult result) {
  for (std::size_t i = 0; i < result.rows.size(); ++i) {
    const double bulge_m = 0.002 * static_cast<double>(i);
    if (!result.rows[i].IsOk()) continue;
    result.rows[i].evidence.path_m =
        sweep::EvenPath(synthetic::Path(bulge_m), synthetic::Path(0.0), {});
  }
  return result;
}

TEST_CASE("The paths of a view are its runs, its references and a band of the middle of them") {
  const sweep::SweepResult result = WithPaths(synthetic::Grid());
  PageEvidence evidence{
      .references = {{"robot, trial 1", sweep::EvenPath(synthetic::Path(0.0), {})}},
      .reference_of_row = std::vector<int>(result.rows.size(), 0)};
  const json data = Data(RenderPage(result, {}, evidence));
  const json& paths = data["paths"];
  CHECK(paths["rows"].size() == 23);
  CHECK(paths["rows"]["1"]["text"] ==
        fmt::format("ice, v_min 0.15, v_max 0.30, trial 1: gap {:.4f} m",
                    result.rows[0].comparison.gap_m));
  CHECK(paths["references"][0]["name"] == "robot, trial 1");
  // Row 24 bulges by 46 mm: 230 units of 0.2 mm at the middle of its 65 points.
  const json& steps = paths["rows"]["24"]["d"];
  REQUIRE(steps.size() == 2 * 65);
  int y = 0;
  for (std::size_t i = 1; i <= 65; i += 2) y += steps[i].get<int>();
  CHECK(y == Approx(230).margin(2));
  const json& whole = paths["views"][0];
  CHECK(whole["lines"].size() == 23);
  CHECK(whole["band_of"] == 23);
  const int worst = whole["worst"];
  CHECK(result.rows[worst - 1].comparison.gap_m == Approx(0.074));
  // The band ends on one side at the 95 % quantile of the bulges of 0, 4, ... 46 mm (without 2).
  int band_y = 0, most = -1000;
  for (std::size_t i = 1; i < whole["band"].size(); i += 2) {
    band_y += whole["band"][i].get<int>();
    most = std::max(most, band_y);
  }
  CHECK(0.2 * most == Approx(43.8).margin(0.6));
  CHECK_FALSE(paths["views"].back().contains("band"));  // a setting has two runs
}

TEST_CASE("A page of a thousand trials with their paths stays below 2 MB without its figures") {
  sweep::SweepResult result = WithPaths(synthetic::Continuous(1000));
  CHECK(RenderPage(result).size() < 2'000'000);
}

TEST_CASE("A row without a path and a sweep without references are no error") {
  const json data = Data(RenderPage(synthetic::Grid()));
  CHECK(data["paths"]["rows"].empty());
  CHECK(data["paths"]["views"][0]["references"].empty());
}

TEST_CASE("A figure is part of the page and its bytes come back") {
  PageEvidence evidence{.figures = {{"Gap by <surface>", "<svg>\xc3\xa4?</svg>"}}};
  const std::string page = RenderPage(synthetic::Grid(), {}, evidence);
  CHECK_THAT(page, Contains("alt=\"Gap by &lt;surface&gt;\"") &&
                       Contains("data:image/svg+xml;base64,PHN2Zz7DpD88L3N2Zz4=\""));
}

TEST_CASE("The words of the parameters are explained from the schema") {
  const json words = Data(RenderPage(synthetic::Grid()))["words"];
  CHECK(words["v_min"] == "least forward power between waypoints (control.v_min)");
  CHECK_THAT(words["threshold"].get<std::string>(), Contains("0.06 m"));
}

TEST_CASE("Of many thousand trials the worst are shown and the page says so") {
  const std::string page = RenderPage(synthetic::Continuous(8000));
  const json data = Data(page);
  CHECK(data["trials"]["rows"].size() == 500);
  CHECK_THAT(Words(page), Contains("The worst 500 of 8000 trials"));
  CHECK(page.size() < 3'000'000);
  double least_m = 1.0;
  for (const json& row : data["trials"]["rows"]) least_m = std::min(least_m, row[5].get<double>());
  CHECK(least_m == Approx(0.08 - 0.06 * 500 / 8000).margin(1e-4));
}

}  // namespace
}  // namespace rift::report
