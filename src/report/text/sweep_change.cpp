#include "rift/report/text/sweep_change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {
namespace {

constexpr size_t kMostKeys = 20, kMostSettings = 60;

std::string Failed(const sweep::ChangedSide& side) {
  return fmt::format("{} of {}", side.failures, side.told);
}

std::string Gap(double gap_m) { return std::isnan(gap_m) ? "-" : fmt::format("{:.4f}", gap_m); }

std::string Line(const sweep::SettingChange& change, size_t width) {
  const std::string verdicts =
      change.before.verdict.empty()
          ? ""
          : "  " + change.before.verdict +
                (change.after.verdict == change.before.verdict ? ""
                                                               : " -> " + change.after.verdict);
  return fmt::format("{:<{}}  {:>11}  {:>11}  {:>8}  {:>8}  {:>30}{}\n", change.setting, width,
                     Failed(change.before), Failed(change.after), Gap(change.before.mean_gap_m),
                     Gap(change.after.mean_gap_m), GapChangeText(change), verdicts);
}

}  // namespace

std::string GapChangeText(const sweep::SettingChange& change) {
  if (std::isnan(change.gap_change_m)) return "-";
  const statistics::Interval& interval = change.gap_change_95_m;
  const std::string between =
      std::isnan(interval.low) ? ""
                               : fmt::format(" ({:+.4f} to {:+.4f})", interval.low, interval.high);
  return fmt::format("{:+.4f} m{}", change.gap_change_m, between);
}

std::string ChangeSentence(const sweep::SweepChange& change) {
  const statistics::Interval& better = change.better_share_95;
  const char* word = "it cannot be told which is better";
  if (change.now_hold + change.now_fail == 0) word = "no trial changed sides";
  if (better.low > 0.5) word = "better";
  if (better.high < 0.5) word = "worse";
  return fmt::format(
      "{} trials failed before and {} fail after: {} ({} now hold, {} now fail{})",
      Failed(change.all.before), Failed(change.all.after), word, change.now_hold, change.now_fail,
      change.copies > 0 ? fmt::format(", {} more are copies of these", change.copies) : "");
}

std::string ChangeText(const sweep::SweepChange& change) {
  std::string text =
      fmt::format("before: {}\nafter:  {}\n\n{}\nmean gap: {}, 95 % over {}\n\n", change.before,
                  change.after, ChangeSentence(change), GapChangeText(change.all),
                  change.is_over_settings ? "settings" : "trials");
  if (change.keys.empty()) text += "no key differs: the same experiment twice\n";
  for (size_t i = 0; i < std::min(kMostKeys, change.keys.size()); ++i) {
    const auto values = ShortenedApart({change.keys[i].before, change.keys[i].after}, 50);
    text += fmt::format("{}: {} -> {}\n", change.keys[i].key, values[0], values[1]);
  }
  if (change.keys.size() > kMostKeys) {
    text += fmt::format("and {} more keys that differ\n", change.keys.size() - kMostKeys);
  }
  size_t width = 7;
  const size_t shown = std::min(kMostSettings, change.settings.size());
  for (size_t i = 0; i < shown; ++i) width = std::max(width, change.settings[i].setting.size());
  text += fmt::format("\n{:<{}}  {:>11}  {:>11}  {:>8}  {:>8}  {:>30}  verdict\n", "setting", width,
                      "fail before", "fail after", "gap (m)", "after", "change");
  for (size_t i = 0; i < shown; ++i) text += Line(change.settings[i], width);
  if (shown < change.settings.size()) {
    text += fmt::format("and {} more settings\n", change.settings.size() - shown);
  }
  text += Line(change.all, width);
  if (change.only_before + change.only_after > 0) {
    text += fmt::format("not compared: {} settings of the first and {} of the second alone\n",
                        change.only_before, change.only_after);
  }
  return text;
}

}  // namespace rift::report
