#include "rift/sweep/explain/sweep_change.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace rift::sweep {
namespace {

TabledTrial Trial(const std::string& key, const std::string& trial, double gap_m, bool falsified) {
  return {.key = key,
          .setting = "setting " + key,
          .trial = trial,
          .is_told = true,
          .falsified = falsified,
          .gap_m = gap_m};
}

TabledTrial Lost(const std::string& key, const std::string& trial) {
  return {.key = key, .setting = "setting " + key, .trial = trial};
}

/// No two numbers alike: "a" becomes better, "b" worse, "c" and "d" are of one sweep alone.
struct Two {
  TabledSweep before{
      .folder = "first",
      .trials = {Trial("a", "1", 0.081, true), Trial("a", "2", 0.072, true),
                 Trial("a", "3", 0.065, true), Trial("b", "1", 0.021, false),
                 Trial("b", "2", 0.034, false), Lost("b", "3"), Trial("c", "1", 0.5, true)},
      .verdicts = {{"a", "falsified"}, {"b", "passed"}}};
  TabledSweep after{.folder = "second",
                    .trials = {Trial("a", "1", 0.041, false), Trial("a", "2", 0.052, false),
                               Trial("a", "3", 0.069, true), Trial("b", "1", 0.066, true),
                               Trial("b", "2", 0.036, false), Trial("b", "3", 0.031, false),
                               Trial("d", "1", 0.4, true), Trial("e", "1", 0.3, true)},
                    .verdicts = {{"a", "undecided"}, {"b", "not seen to fail"}}};
};

TEST_CASE("Two sweeps are paired by setting and trial, and what one alone has is left out") {
  const Two two;
  const SweepChange change = CompareSweeps(two.before, two.after, {{"seed", "1", "2"}});
  CHECK(change.before == "first");
  CHECK(change.after == "second");
  REQUIRE(change.keys.size() == 1);
  CHECK(change.keys[0].after == "2");
  CHECK(change.only_before == 1);
  CHECK(change.only_after == 2);
  CHECK(change.now_hold == 2);
  CHECK(change.now_fail == 1);
  // Clopper-Pearson of 2 in 3, from a table.
  CHECK(change.better_share_95.low == Approx(0.0943).margin(1e-4));
  CHECK(change.better_share_95.high == Approx(0.9916).margin(1e-4));

  REQUIRE(change.settings.size() == 2);
  const SettingChange &a = change.settings[0], &b = change.settings[1];
  CHECK(a.setting == "setting a");  // by 2 of 3 against 1 of 3
  CHECK(b.setting == "setting b");
  CHECK(a.before.failures == 3);
  CHECK(a.before.told == 3);
  CHECK(a.before.mean_gap_m == Approx((0.081 + 0.072 + 0.065) / 3.0));
  CHECK(a.before.verdict == "falsified");
  CHECK(a.after.failures == 1);
  CHECK(a.after.told == 3);
  CHECK(a.after.mean_gap_m == Approx((0.041 + 0.052 + 0.069) / 3.0));
  CHECK(a.after.verdict == "undecided");
  CHECK(a.pairs == 3);
  CHECK(a.gap_change_m == Approx((-0.040 - 0.020 + 0.004) / 3.0));
  const double mean = a.gap_change_m;
  const double sd = std::sqrt(
      (std::pow(-0.040 - mean, 2) + std::pow(-0.020 - mean, 2) + std::pow(0.004 - mean, 2)) / 2.0);
  const double half = 4.302652729749462 * sd / std::sqrt(3.0);
  CHECK(a.gap_change_95_m.low == Approx(mean - half));
  CHECK(a.gap_change_95_m.high == Approx(mean + half));
  CHECK(b.before.failures == 0);
  CHECK(b.before.told == 2);
  CHECK(b.before.mean_gap_m == Approx(0.0275));
  CHECK(b.after.failures == 1);
  CHECK(b.after.told == 3);
  CHECK(b.pairs == 2);
  CHECK(b.gap_change_m == Approx(0.0235));

  // Over all: the settings of both alone, and the interval over settings.
  CHECK(change.all.before.failures == 3);
  CHECK(change.all.before.told == 5);
  CHECK(change.all.before.mean_gap_m == Approx((0.081 + 0.072 + 0.065 + 0.021 + 0.034) / 5.0));
  CHECK(change.all.after.failures == 2);
  CHECK(change.all.after.told == 6);
  CHECK(change.all.after.verdict.empty());
  CHECK(change.all.pairs == 5);
  const double over_settings = 0.5 * (a.gap_change_m + b.gap_change_m);
  CHECK(change.all.gap_change_m == Approx(over_settings));
  const double apart = 12.706204736174698 * std::abs(b.gap_change_m - a.gap_change_m) / 2.0;
  CHECK(change.all.gap_change_95_m.low == Approx(over_settings - apart));
  CHECK(change.all.gap_change_95_m.high == Approx(over_settings + apart));
  CHECK(change.is_over_settings);
}

TEST_CASE("Repeats of one name count each, and are paired in their order") {
  TabledSweep before{.folder = "b",
                     .trials = {Trial("a", "1", 0.07, true), Trial("a", "1", 0.08, true),
                                Trial("a", "1", 0.02, false), Trial("a", "2", 0.03, false)}};
  TabledSweep after = before;
  const SweepChange same = CompareSweeps(before, after, {});
  CHECK(same.all.before.told == 4);
  CHECK(same.all.before.failures == 2);
  CHECK(same.all.before.mean_gap_m == Approx(0.05));
  CHECK(same.all.pairs == 4);
  CHECK(same.all.gap_change_m == 0.0);
  CHECK(same.now_hold + same.now_fail == 0);
  after.trials.pop_back();
  after.trials[0] = Trial("a", "1", 0.04, false);
  const SweepChange change = CompareSweeps(before, after, {});
  CHECK(change.all.pairs == 3);
  CHECK(change.all.gap_change_m == Approx(-0.01));
  CHECK(change.now_hold == 1);
  CHECK(change.now_fail == 0);
}

TEST_CASE("Repeats that are one run in both sweeps change sides once") {
  // Without chance "a" and "b" hold after, "c" fails; of "d" the repeats of one sweep alone agree.
  const auto sweep = [](bool is_after) {
    TabledSweep made{.folder = is_after ? "after" : "before"};
    for (const std::string trial : {"1", "2", "3", "4", "5"}) {
      const double own_m = 0.0001 * std::stoi(trial);
      made.trials.push_back(Trial("a", trial, is_after ? 0.02 : 0.08, !is_after));
      made.trials.push_back(Trial("b", trial, is_after ? 0.03 : kNotKnown, !is_after));  // it fell
      made.trials.push_back(Trial("c", trial, is_after ? 0.09 : 0.01, is_after));
      made.trials.push_back(Trial("d", trial, is_after ? 0.04 : 0.07 + own_m, !is_after));
    }
    return made;
  };
  const SweepChange change = CompareSweeps(sweep(false), sweep(true), {});
  CHECK(change.all.before.failures == 15);
  CHECK(change.all.after.failures == 5);
  CHECK(change.now_hold == 1 + 1 + 5);
  CHECK(change.now_fail == 1);
  CHECK(change.copies == 3 * 4);
  // Clopper-Pearson of 7 in 8: with this share 7 or more hold with 2.5 %.
  const double low = change.better_share_95.low;
  CHECK(8.0 * std::pow(low, 7) - 7.0 * std::pow(low, 8) == Approx(0.025));
}

/// A trial of two parameters.
TabledTrial At(const std::string& a, const std::string& b, const std::string& trial, double gap_m) {
  TabledTrial made = Trial(a + b, trial, gap_m, gap_m > 0.06);
  made.theta = {{a, {}}, {b, {}}};
  return made;
}

TEST_CASE("Settings that differ in a parameter that does nothing change sides once") {
  TabledSweep before{.folder = "b"}, after{.folder = "a"};
  for (const std::string b : {"1", "2", "3", "4", "5", "6"}) {
    before.trials.push_back(At("x", b, "1", 0.08));
    after.trials.push_back(At("x", b, "1", 0.04));
  }
  const SweepChange change = CompareSweeps(before, after, {});
  CHECK(change.now_hold == 1);
  CHECK(change.now_fail == 0);
  CHECK(change.copies == 5);
  CHECK(change.better_share_95.low == Approx(0.025));  // of 1 in 1: it cannot be told
  CHECK(change.settings.size() == 6);
  CHECK(change.all.before.failures == 6);
  CHECK(change.all.pairs == 6);
  CHECK_FALSE(change.is_over_settings);
  CHECK(change.all.gap_change_m == Approx(-0.04));
  CHECK(std::isnan(change.all.gap_change_95_m.low));
}

TEST_CASE("Settings that a trial of either sweep parts count each, and those apart in two too") {
  TabledSweep before{.folder = "b"}, after{.folder = "a"};
  const auto add = [&](const std::string& a, const std::string& b, double second_before_m,
                       double second_after_m) {
    before.trials.push_back(At(a, b, "1", 0.08));
    before.trials.push_back(At(a, b, "2", second_before_m));
    after.trials.push_back(At(a, b, "1", 0.04));
    after.trials.push_back(At(a, b, "2", second_after_m));
  };
  add("x", "1", 0.07, 0.05);
  add("y", "2", 0.07, 0.05);  // another in both parameters
  CHECK(CompareSweeps(before, after, {}).now_hold == 4);
  add("z", "1", 0.0701, 0.05);
  add("w", "2", 0.07, 0.0501);
  const SweepChange parted = CompareSweeps(before, after, {});
  CHECK(parted.now_hold == 8);
  CHECK(parted.copies == 0);
  CHECK(parted.is_over_settings);
  add("y", "1", 0.07, 0.05);  // between the first two, which are one with it
  const SweepChange joined = CompareSweeps(before, after, {});
  CHECK(joined.now_hold == 6);
  CHECK(joined.copies == 4);
}

TEST_CASE("Back again everything is the other way round, and one setting counts by its trials") {
  Two two;
  const SweepChange there = CompareSweeps(two.before, two.after, {});
  const SweepChange back = CompareSweeps(two.after, two.before, {});
  CHECK(back.now_hold == there.now_fail);
  CHECK(back.now_fail == there.now_hold);
  CHECK(back.only_before == there.only_after);
  CHECK(back.all.gap_change_m == Approx(-there.all.gap_change_m));
  CHECK(back.better_share_95.low == Approx(1.0 - there.better_share_95.high));
  std::erase_if(two.before.trials, [](const TabledTrial& trial) { return trial.key != "a"; });
  const SweepChange one = CompareSweeps(two.before, two.after, {});
  REQUIRE(one.settings.size() == 1);
  CHECK_FALSE(one.is_over_settings);
  CHECK(one.all.gap_change_95_m.low == Approx(there.settings[0].gap_change_95_m.low));
  std::erase_if(two.after.trials, [](const TabledTrial& trial) { return trial.key == "a"; });
  CHECK_THROWS_WITH(CompareSweeps(two.before, two.after, {}),
                    Catch::Contains("first and second have no setting in common"));
}

TEST_CASE("Settings stand by how much their share of failures changed, equal ones by their keys") {
  const auto sweep = [](bool is_after) {
    TabledSweep made{.folder = is_after ? "after" : "before"};
    const auto add = [&](const char* key, int failures_before, int failures_after) {
      for (int i = 0; i < 4; ++i) {
        made.trials.push_back(Trial(key, std::to_string(i), 0.05 + 0.001 * i,
                                    i < (is_after ? failures_after : failures_before)));
      }
    };
    add("d", 2, 1);  // by a quarter
    add("c", 0, 2);  // by a half, worse
    add("b", 3, 1);  // by a half, better
    add("a", 1, 1);
    add("e", 4, 0);
    return made;
  };
  const SweepChange change = CompareSweeps(sweep(false), sweep(true), {});
  std::string order;
  for (const SettingChange& setting : change.settings) order += setting.setting.back();
  CHECK(order == "ebcda");
  CHECK(change.now_hold == 2 + 4 + 1);
  CHECK(change.now_fail == 2);
}

TEST_CASE("Trials that do not tell change nothing, and without a gap they are no pair") {
  TabledSweep before{.folder = "b", .trials = {Lost("a", "1"), Trial("a", "2", 0.02, false)}};
  TabledSweep after{.folder = "a", .trials = {Trial("a", "1", 0.09, true), Lost("a", "2")}};
  before.trials[0].falsified = true;  // of a trial that does not tell
  const SweepChange change = CompareSweeps(before, after, {});
  CHECK(change.now_hold == 0);
  CHECK(change.now_fail == 0);
  REQUIRE(change.settings.size() == 1);
  CHECK(change.settings[0].pairs == 0);
  CHECK(std::isnan(change.settings[0].gap_change_m));
  CHECK(change.settings[0].before.told == 1);
  CHECK(change.settings[0].before.failures == 0);
  CHECK(change.settings[0].after.failures == 1);
  CHECK(change.settings[0].before.verdict.empty());
  CHECK(change.all.pairs == 0);
  CHECK_FALSE(change.is_over_settings);
  CHECK(change.all.before.mean_gap_m == Approx(0.02));
  CHECK(change.all.after.mean_gap_m == Approx(0.09));
}

TEST_CASE("A setting without a pair takes no part in the mean change over settings") {
  Two two;
  const SweepChange without = CompareSweeps(two.before, two.after, {});
  two.before.trials.push_back(Lost("f", "1"));
  two.after.trials.push_back(Trial("f", "1", 0.05, false));
  const SweepChange with = CompareSweeps(two.before, two.after, {});
  CHECK(with.settings.size() == 3);
  CHECK(with.is_over_settings);
  CHECK(with.all.gap_change_m == Approx(without.all.gap_change_m));
  CHECK(with.all.gap_change_95_m.low == Approx(without.all.gap_change_95_m.low));
  CHECK(with.all.gap_change_95_m.high == Approx(without.all.gap_change_95_m.high));
}

TEST_CASE("Settings of one pair each are compared over settings") {
  const TabledSweep before{.folder = "b",
                           .trials = {Trial("a", "1", 0.08, true), Trial("b", "1", 0.02, false)}};
  const TabledSweep after{.folder = "a",
                          .trials = {Trial("a", "1", 0.05, false), Trial("b", "1", 0.03, false)}};
  const SweepChange change = CompareSweeps(before, after, {});
  CHECK(change.is_over_settings);
  CHECK(change.all.pairs == 2);
  CHECK(change.all.gap_change_m == Approx(-0.01));
  CHECK(change.all.gap_change_95_m.high == Approx(-0.01 + 12.706204736174698 * 0.02));
}

}  // namespace
}  // namespace rift::sweep
