#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

constexpr std::size_t kMostTerms = 12;

json Bar(const std::string& label, double value, double low, double high, std::string_view colour,
         json tip) {
  return {{"label", label},
          {"value", Value(value)},
          {"low", Value(low)},
          {"high", Value(high)},
          {"missing", std::isfinite(value) ? 0 : 1},
          {"colour", colour},
          {"tip", std::move(tip)}};
}

PageChart Bars(std::string title, std::string sentence, const std::string& x_title, json values) {
  PageChart chart{std::move(title), std::move(sentence), Template("bars.json")};
  chart.spec["height"] = 28 * std::max<std::size_t>(values.size(), 1);
  std::vector<std::string> labels;
  for (const json& value : values) labels.push_back(value["label"]);
  labels = ShortenedApart(labels, kMostLabelLetters);
  for (std::size_t i = 0; i < labels.size(); ++i) values[i]["label"] = labels[i];
  SetSignal(chart.spec, "x_title", x_title);
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

json Percent(const std::string& label, double share, double low, double high) {
  const std::string interval = sweep::PercentDigits(low) + " to " + sweep::PercentText(high);
  return Bar(label, 100.0 * share, 100.0 * low, 100.0 * high, kPassColour,
             {{"what", label},
              {"share", fmt::format("{:.1f} %", 100.0 * share)},
              {"95 % interval", interval}});
}

void AddEffects(const sweep::Explanation& explanation, std::vector<PageChart>* charts) {
  json values = json::array();
  for (const sweep::ParameterEffect& effect : explanation.effects.parameters) {
    if (!std::isfinite(effect.share) || values.size() == kMostTerms) continue;
    values.push_back(Percent(effect.name, effect.share, effect.share_low, effect.share_high));
  }
  if (values.empty()) return;
  charts->push_back(
      Bars("What the loss depends on",
           "Share of the loss's variance that goes with each parameter, by itself or together with "
           "others, " +
               explanation.effects.note + "; whiskers are 95 % intervals.",
           "share of the variance (%)", std::move(values)));
}

void AddAnatomy(const sweep::Explanation& explanation, std::vector<PageChart>* charts) {
  const sweep::Anatomy& anatomy = explanation.anatomy;
  if (!std::isfinite(anatomy.start_m.mean)) return;
  json values = json::array();
  const auto add = [&](const std::string& name, const sweep::Estimate& estimate,
                       std::string_view colour, const std::string& meaning) {
    if (!std::isfinite(estimate.mean)) return;
    values.push_back(Bar(name, estimate.mean, estimate.low, estimate.high, colour,
                         {{"what", name},
                          {"mean", fmt::format("{:.4f} m", estimate.mean)},
                          {"over", fmt::format("{} settings or trials", estimate.n)},
                          {"meaning", meaning}}));
  };
  add("whole gap", anatomy.gap_m, kFailColour, "mean over the table");
  for (const sweep::GapPart& part : anatomy.parts) {
    add(part.name, part.size_m, kPassColour, part.remedy);
  }
  add("repeats apart", anatomy.noise_m, "#888888", "nobody removes the robot's own scatter");
  add("removable", anatomy.removable_m, kPassColour, "gap less the distance of repeats");
  charts->push_back(
      Bars("What the gap is made of",
           "Means in metres with 95 % intervals: start, frame and shape add up to the "
           "gap; what repeats are apart (grey) no simulator removes.",
           "distance (m)", std::move(values)));
}

}  // namespace

std::vector<PageChart> WhyCharts(const sweep::Explanation& explanation) {
  std::vector<PageChart> charts;
  AddEffects(explanation, &charts);
  AddAnatomy(explanation, &charts);
  return charts;
}

}  // namespace rift::report
