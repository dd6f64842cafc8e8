#include "rift/report/figures/setting_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "rift/experiment/words.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::report {
namespace {

std::map<std::string, std::size_t> PlaceOf(const std::vector<sweep::LevelSummary>& levels) {
  std::map<std::string, std::size_t> place;
  for (std::size_t i = 0; i < levels.size(); ++i) place[levels[i].level] = i;
  return place;
}

/// Two values or more, each with its name: "v_min 0.15, v_max 0.30".
std::string NamedValues(const sweep::SweepResult& result, const experiment::Theta& theta,
                        const std::vector<int>& parameters) {
  std::string text;
  for (const int i : parameters) {
    text += (text.empty() ? "" : ", ") +
            experiment::NamedValue(result.parameters[i],
                                   sweep::ShortText(result.parameters[i], theta[i]));
  }
  return text;
}

}  // namespace

SettingGrid LayOut(const sweep::SweepResult& result) {
  const sweep::FactorSplit split = sweep::SplitFactors(result.parameters);
  SettingGrid grid;
  grid.main_name = result.parameters[split.main_factor].Name();
  grid.mains = sweep::SummariseBy(result, {split.main_factor});
  grid.others = {result.all};
  if (!split.others.empty()) {
    for (const int i : split.others) {
      grid.others_name += (grid.others_name.empty() ? "" : ", ") + result.parameters[i].Name();
    }
    grid.others = sweep::SummariseBy(result, split.others);
  }
  if (!std::all_of(result.parameters.begin(), result.parameters.end(), sweep::HasLevels)) {
    return grid;
  }
  grid.cells.assign(grid.mains.size(), {});
  for (auto& row : grid.cells) row.assign(grid.others.size(), nullptr);
  const auto main_place = PlaceOf(grid.mains), other_place = PlaceOf(grid.others);
  for (const sweep::SettingResult& setting : result.settings) {
    const std::size_t main =
        main_place.at(sweep::CombinationLabel(setting.theta, {split.main_factor}));
    const std::size_t other =
        split.others.empty() ? 0
                             : other_place.at(sweep::CombinationLabel(setting.theta, split.others));
    grid.cells[main][other] = &setting;
    if (split.others.size() > 1) {
      grid.others[other].level = NamedValues(result, setting.theta, split.others);
    }
  }
  return grid;
}

std::string SettingLabel(const sweep::SweepResult& result, const experiment::Theta& theta) {
  if (result.parameters.empty()) return "the only setting";
  const int main = sweep::SplitFactors(result.parameters).main_factor;
  std::vector<int> order = {main};
  for (int i = 0; i < static_cast<int>(theta.size()); ++i) {
    if (i != main) order.push_back(i);
  }
  return NamedValues(result, theta, order);
}

std::vector<double> GapsOf(const sweep::SweepResult& result, const sweep::SettingResult& setting) {
  std::vector<double> gaps_m;
  for (const int row : setting.rows) {
    if (result.rows[row].IsOk()) gaps_m.push_back(result.rows[row].comparison.gap_m);
  }
  return gaps_m;
}

int NotMeasured(const sweep::SweepResult& result, const sweep::SettingResult& setting) {
  return static_cast<int>(setting.rows.size() - GapsOf(result, setting).size());
}

}  // namespace rift::report
