#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/gnuplot_text.hpp"
#include "rift/report/figures/setting_grid.hpp"

namespace rift::report {
namespace {

using nlohmann::json;

constexpr std::size_t kMostTerms = 12;
constexpr std::size_t kMostDots = 1500;

json Bar(const std::string& label, double value, double low, double high, std::string_view colour,
         json tip) {
  return {{"label", Shortened(label, 32)},
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
  SetSignal(chart.spec, "x_title", x_title);
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

json Percent(const std::string& label, double share, double low, double high) {
  const std::string interval = fmt::format("{:.0f} to {:.0f} %", 100.0 * low, 100.0 * high);
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

PageChart RegionHeat(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  const std::string x_name = result.parameters[region.x_parameter].Name();
  const std::string y_name = result.parameters[region.y_parameter].Name();
  json values = json::array();
  for (const sweep::RegionCell& cell : region.cells) {
    values.push_back(
        {{"line", Shortened(cell.y, 32)},
         {"column", Shortened(cell.x, 32)},
         {"value", Value(100.0 * cell.share)},
         {"tip",
          {{x_name, cell.x},
           {y_name, cell.y},
           {"failing", fmt::format("{:.0f} % of {} trials", 100.0 * cell.share, cell.trials)}}}});
  }
  PageChart chart{"", "", Template("heat.json")};
  chart.spec["height"] =
      34 * std::max<std::size_t>(1, result.parameters[region.y_parameter].levels.size());
  if (result.parameters[region.y_parameter].IsContinuous()) chart.spec["height"] = 320;
  SetSignal(chart.spec, "middle", 60.0);
  SetSignal(chart.spec, "digits", ".0f");
  SetSignal(chart.spec, "legend_title", "trials above the threshold (%)");
  SetSignal(chart.spec, "x_title", x_name);
  SetSignal(chart.spec, "y_title", y_name);
  chart.spec["data"][0]["values"] = std::move(values);
  return chart;
}

json TrialDots(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  json dots = json::array();
  const std::size_t step = 1 + result.rows.size() / (kMostDots + 1);
  for (std::size_t i = 0; i < result.rows.size(); i += step) {
    const sweep::TrialRow& row = result.rows[i];
    if (!row.IsOk()) continue;
    dots.push_back({{"x", *row.theta[region.x_parameter].number},
                    {"y", *row.theta[region.y_parameter].number},
                    {"falsified", row.falsified},
                    {"tip",
                     {{"row", std::to_string(i + 1)},
                      {"gap", fmt::format("{:.4f} m", row.comparison.gap_m)}}}});
  }
  return dots;
}

PageChart RegionPlane(const sweep::SweepResult& result, const sweep::FailingRegion& region) {
  json patches = json::array();
  for (const sweep::RegionCell& cell : region.cells) {
    patches.push_back({{"x", cell.x_low},
                       {"x2", cell.x_high},
                       {"y", cell.y_low},
                       {"y2", cell.y_high},
                       {"value", Value(100.0 * cell.share)}});
  }
  PageChart chart{"", "", Template("region.json")};
  SetSignal(chart.spec, "x_title", result.parameters[region.x_parameter].Name());
  SetSignal(chart.spec, "y_title", result.parameters[region.y_parameter].Name());
  chart.spec["data"][0]["values"] = std::move(patches);
  chart.spec["data"][1]["values"] = TrialDots(result, region);
  return chart;
}

void AddRegion(const sweep::SweepResult& result, const sweep::FailingRegion& region,
               std::vector<PageChart>* charts) {
  constexpr std::size_t kMostCells = 1600;
  if (region.cells.empty() || region.cells.size() > kMostCells) return;
  const experiment::Parameter& x = result.parameters[region.x_parameter];
  const experiment::Parameter& y = result.parameters[region.y_parameter];
  const bool is_plane = x.IsContinuous() && y.IsContinuous();
  PageChart chart = is_plane ? RegionPlane(result, region) : RegionHeat(result, region);
  chart.title = fmt::format("Where it fails, by {} and {}", x.Name(), y.Name());
  chart.sentence =
      region.is_smoothed
          ? "Share of failing trials in per cent among the 12 nearest to each patch, the other "
            "parameters being what those trials had; the region fails where it is bright."
          : "Share of trials above the threshold in per cent, over all values of the other "
            "parameters; crosses were not tried.";
  charts->push_back(std::move(chart));
}

json PathPoints(const std::string& name, std::string_view colour,
                const std::vector<Eigen::Vector2d>& points_m) {
  constexpr std::size_t kMostPoints = 200;
  json points = json::array();
  const std::size_t step = 1 + points_m.size() / (kMostPoints + 1);
  for (std::size_t i = 0; i < points_m.size(); i += step) {
    points.push_back({{"path", name},
                      {"colour", colour},
                      {"x", std::round(1e5 * points_m[i].x()) / 1e5},
                      {"y", std::round(1e5 * points_m[i].y()) / 1e5}});
  }
  return points;
}

/// Room around the paths, and at least a third as high as wide, or a straight path has no height.
void SetDomains(const json& points, json& spec) {
  constexpr double kMargin = 0.08, kLeastHeight = 0.35;
  Eigen::Array2d low = Eigen::Array2d::Constant(HUGE_VAL), high = -low;
  for (const json& point : points) {
    const Eigen::Array2d at{point["x"].get<double>(), point["y"].get<double>()};
    low = low.min(at);
    high = high.max(at);
  }
  const Eigen::Array2d middle = 0.5 * (low + high);
  Eigen::Array2d half = (0.5 + kMargin) * (high - low);
  half.x() = std::max(half.x(), half.y());
  half.y() = std::max(half.y(), kLeastHeight * half.x());
  SetSignal(spec, "x_domain", {middle.x() - half.x(), middle.x() + half.x()});
  SetSignal(spec, "y_domain", {middle.y() - half.y(), middle.y() + half.y()});
}

PageChart FailureChart(const sweep::SweepResult& result, const sweep::Explanation& explanation,
                       const TypicalFailure& failure) {
  const ComparedPair& pair = failure.paths;
  const sweep::TrialRow& row = result.rows[failure.row];
  json points = PathPoints(pair.sim, kFailColour, pair.profile.sim_m);
  for (json& point : PathPoints(pair.real, kPassColour, pair.profile.real_m)) {
    points.push_back(std::move(point));
  }
  PageChart chart{
      fmt::format("A typical failure: {}, trial {}", SettingLabel(result, row.theta), row.trial),
      fmt::format("Paths in metres seen from above ({} orange, {} blue), row {} of "
                  "table.csv, for kind {}: {}.",
                  pair.sim, pair.real, failure.row + 1, failure.kind + 1,
                  explanation.clusters[failure.kind].sentence),
      Template("paths.json")};
  SetDomains(points, chart.spec);
  chart.spec["data"][0]["values"] = std::move(points);
  const auto at = [&](const std::vector<Eigen::Vector2d>& path_m) {
    const double last = static_cast<double>(path_m.size() - 1);
    return path_m[static_cast<std::size_t>(std::lround(pair.comparison.gap_u * last))];
  };
  const Eigen::Vector2d a = at(pair.profile.sim_m), b = at(pair.profile.real_m);
  chart.spec["data"][1]["values"] = {
      {{"x", a.x()},
       {"y", a.y()},
       {"x2", b.x()},
       {"y2", b.y()},
       {"tip", {{"gap", fmt::format("{:.4f} m", pair.comparison.gap_m)}}}}};
  return chart;
}

}  // namespace

std::vector<PageChart> WhyCharts(const sweep::SweepResult& result,
                                 const sweep::Explanation& explanation,
                                 const std::vector<TypicalFailure>& failures) {
  std::vector<PageChart> charts;
  if (result.all.n == 0) return charts;
  AddEffects(explanation, &charts);
  AddAnatomy(explanation, &charts);
  AddRegion(result, explanation.region, &charts);
  for (const TypicalFailure& failure : failures) {
    charts.push_back(FailureChart(result, explanation, failure));
  }
  return charts;
}

}  // namespace rift::report
