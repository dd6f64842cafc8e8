#include "rift/report/page/sweep_change.hpp"

#include <fmt/format.h>

#include <cmath>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "embedded.hpp"
#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/text/sweep_change.hpp"

namespace rift::report {
namespace {

using kainjow::mustache::data;

/// The share of failing trials as a bar of that width, and in words.
data Bar(const sweep::ChangedSide& side) {
  data bar;
  const double share = side.told == 0 ? 0.0 : static_cast<double>(side.failures) / side.told;
  bar.set("percent", fmt::format("{:.1f}", 100.0 * share));
  bar.set("failed", fmt::format("{} of {}", side.failures, side.told));
  bar.set("gap", std::isnan(side.mean_gap_m) ? "–" : fmt::format("{:.4f}", side.mean_gap_m));
  bar.set("verdict", side.verdict.empty() ? "–" : side.verdict);
  return bar;
}

data Row(const sweep::SettingChange& change) {
  data row;
  row.set("setting", PlainText(change.setting));
  row.set("before", Bar(change.before));
  row.set("after", Bar(change.after));
  row.set("change", GapChangeText(change));
  row.set("is_better", change.gap_change_95_m.high < 0.0);
  row.set("is_worse", change.gap_change_95_m.low > 0.0);
  return row;
}

}  // namespace

std::string RenderChange(const sweep::SweepChange& change) {
  data page, rows{data::type::list}, keys{data::type::list};
  for (const sweep::SettingChange& setting : change.settings) rows << Row(setting);
  rows << Row(change.all);
  for (const sweep::ChangedKey& key : change.keys) {
    data entry;
    entry.set("key", PlainText(key.key));
    entry.set("before", PlainText(key.before));
    entry.set("after", PlainText(key.after));
    keys << entry;
  }
  const bool is_better = change.better_share_95.low > 0.5;
  const bool is_worse = change.better_share_95.high < 0.5;
  page.set("css", std::string(Embedded("page.css")));
  page.set("before", PlainText(change.before));
  page.set("after", PlainText(change.after));
  page.set("headline", ChangeSentence(change));
  page.set("class", is_better ? "pass" : is_worse ? "fail" : "unknown");
  page.set("gap", GapChangeText(change.all));
  page.set("over", change.is_over_settings ? "settings" : "trials");
  page.set("rows", rows);
  page.set("keys", keys);
  page.set("has_keys", !change.keys.empty());
  page.set("left_out", change.only_before + change.only_after > 0);
  page.set("only_before", std::to_string(change.only_before));
  page.set("only_after", std::to_string(change.only_after));
  kainjow::mustache::mustache html{std::string(Embedded("change.html"))};
  std::string text = html.render(page);
  if (!html.is_valid()) throw std::logic_error("change.html: " + html.error_message());
  return text;
}

}  // namespace rift::report
