// What is said of two sweeps, at the shares and names from which on it is another.
#include "rift/report/text/sweep_change.hpp"

#include <catch2/catch.hpp>

#include "rift/report/page/sweep_change.hpp"

namespace rift::report {
namespace {

using Catch::Matchers::Contains;

TEST_CASE("One sweep is better than another where its share is beyond a half, not at it") {
  sweep::SweepChange change;
  change.now_hold = 1;
  const auto word = [&](double low, double high) {
    change.better_share_95 = {low, high};
    return ChangeSentence(change);
  };
  CHECK_THAT(word(0.5, 1.0), Contains(": it cannot be told which is better (1 now hold"));
  CHECK_THAT(word(0.0, 0.5), Contains(": it cannot be told which is better (1 now hold"));
  CHECK_THAT(word(0.5001, 1.0), Contains(": better ("));
  CHECK_THAT(word(0.0, 0.4999), Contains(": worse ("));
}

TEST_CASE("The table of a change is as wide as its words where the settings' names are short") {
  sweep::SweepChange change;
  change.settings = {{.setting = "x", .before = {1, 4, 0.05}, .after = {2, 3, 0.07}}};
  change.all = {.setting = "all", .before = {1, 4, 0.05}, .after = {2, 3, 0.07}};
  const std::string text = ChangeText(change);
  INFO(text);
  CHECK_THAT(text, Contains("\nsetting  fail before   fail after   gap (m)     after  "
                            "                        change  verdict\n"
                            "x             1 of 4       2 of 3    0.0500    0.0700  "
                            "                             -\nall           1 of 4 "));
}

TEST_CASE("A setting is marked better or worse where all of its interval is on one side of zero") {
  sweep::SweepChange change;
  change.all = {.setting = "all"};
  const auto mark = [&](double low, double high) -> std::string {
    change.settings = {{.setting = "x", .gap_change_m = 0.5 * (low + high)}};
    change.settings[0].gap_change_95_m = {low, high};
    const std::string page = RenderChange(change), open = R"(<td class="number)";
    const bool is_better = page.find(open + " better\"") != page.npos;
    const bool is_worse = page.find(open + " worse\"") != page.npos;
    return std::string(is_better ? "better" : "") + (is_worse ? "worse" : "");
  };
  CHECK(mark(-0.02, -0.01) == "better");
  CHECK(mark(0.01, 0.02) == "worse");
  CHECK(mark(-0.01, 0.02).empty());
  CHECK(mark(-0.02, 0.0).empty());
  CHECK(mark(0.0, 0.02).empty());
}

TEST_CASE("The headline of a change is marked by its share, beyond a half alone") {
  sweep::SweepChange change;
  change.now_hold = 1;
  const auto has = [&](double low, double high, const std::string& mark) {
    change.better_share_95 = {low, high};
    return RenderChange(change).find("headline " + mark) != std::string::npos;
  };
  CHECK(has(0.5, 1.0, "unknown"));
  CHECK(has(0.0, 0.5, "unknown"));
  CHECK(has(0.51, 1.0, "pass"));
  CHECK(has(0.0, 0.49, "fail"));
}

TEST_CASE("Settings of one sweep alone are counted where there are some, of either") {
  for (const auto& [before, after] : {std::pair{0, 0}, {2, 0}, {0, 3}}) {
    sweep::SweepChange change;
    change.only_before = before;
    change.only_after = after;
    const std::string line = "not compared: " + std::to_string(before) +
                             " settings of the first and " + std::to_string(after) +
                             " of the second alone\n";
    CHECK((ChangeText(change).find(line) != std::string::npos) == (before + after > 0));
  }
}

}  // namespace
}  // namespace rift::report
