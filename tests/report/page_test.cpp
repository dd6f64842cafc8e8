#include "rift/report/page/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <regex>

#include "report/synthetic_sweep.hpp"

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

TEST_CASE("The first screen answers from the data") {
  const sweep::SweepResult result = synthetic::Grid();
  const std::string words = Words(RenderPage(result));
  // 24 trials, one lost; the 8 on rock have 0.066 and 0.074 m, all above 0.06.
  CHECK_THAT(words, Contains("It fails: 8 of 23 measured trials exceed 0.06 m (35 %)"));
  CHECK_THAT(words, Contains("Most often at surface rock (8 of 8 trials), least often at ice (0 of "
                             "7 trials)."));
  CHECK_THAT(words, Contains("The largest gap, 0.0740 m, is rock [0.15, 0.30], trial 2, at u = "
                             "0.75"));
  CHECK_THAT(words, Contains("0 of 12 falsified, 0 passed, 8 not seen to fail, 4 undecided"));
  CHECK_THAT(words, Contains("Without a gap: 1 of 24 trials (1 missing)."));
  CHECK_THAT(words, Contains("1 setting judged by fewer repeats than asked for."));
  CHECK_THAT(words, Contains("ice [0.15, 0.30], trial 2: missing – no file real2.csv"));
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
  CHECK_THAT(words, Contains(fmt::format("Mean gap {:.4f} m; with the first points laid together "
                                         "{:.4f} m (-20 %); {:.4f} m is shape",
                                         mean_m, 0.8 * mean_m, 0.5 * mean_m)));
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
  const json data = Data(RenderPage(result, {}, {{}, " --real-format tracker"}));
  CHECK(data["trials"]["columns"].back()["again"] == "gap");
  CHECK(data["trials"]["rows"][0].back() ==
        "'/logs/sim ice.csv' /logs/real1.csv --real-format tracker");
  CHECK(data["trials"]["rows"][1].back().is_null());  // it has no gap
  CHECK(Data(RenderPage(result))["trials"]["rows"][0].back() == 1);
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
