#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "parts.hpp"
#include "rift/experiment/words.hpp"
#include "rift/report/figures/setting_grid.hpp"
#include "rift/report/text/trial_query.hpp"

namespace rift::report {
namespace {

constexpr std::size_t kMostRows = 20'000;  ///< of more the page filters nothing
constexpr std::size_t kMostLevels = 12;
constexpr std::size_t kMostSettings = 60;

/// The trials of some settings as a result of their own. The test of each setting stays the one
/// made together with all others.
void TakePart(const sweep::SweepResult& result, PageView* view) {
  auto part = std::make_shared<sweep::SweepResult>(
      sweep::SweepResult{.name = result.name,
                         .candidate_kind = result.candidate_kind,
                         .reference_kind = result.reference_kind,
                         .gap = result.gap,
                         .judged_by = result.judged_by,
                         .judged_settings = result.judged_settings,
                         .chance_repeats_runs = result.chance_repeats_runs,
                         .tag_offset_m = result.tag_offset_m,
                         .parameters = result.parameters});
  for (const int setting : view->settings) {
    const std::vector<int>& rows = result.settings[setting].rows;
    view->rows.insert(view->rows.end(), rows.begin(), rows.end());
  }
  std::sort(view->rows.begin(), view->rows.end());
  for (const int row : view->rows) part->rows.push_back(result.rows[row]);
  sweep::Summarise(*part);
  std::map<experiment::Theta, const sweep::SettingResult*> whole;
  for (const int setting : view->settings) {
    whole[result.settings[setting].theta] = &result.settings[setting];
  }
  for (sweep::SettingResult& setting : part->settings) {
    setting.noise_floor_m = whole.at(setting.theta)->noise_floor_m;
    setting.verdict = whole.at(setting.theta)->verdict;
  }
  view->part = std::move(part);
}

PageView AllTrials(const sweep::SweepResult& result) {
  PageView view{.label = "all trials", .part = {&result, [](const sweep::SweepResult*) {}}};
  for (int i = 0; i < static_cast<int>(result.rows.size()); ++i) view.rows.push_back(i);
  for (int i = 0; i < static_cast<int>(result.settings.size()); ++i) view.settings.push_back(i);
  return view;
}

void AddLevels(const sweep::SweepResult& result, int parameter, std::vector<PageView>* views) {
  const experiment::Parameter& axis = result.parameters[parameter];
  if (axis.levels.size() < 2 || axis.levels.size() > kMostLevels) return;
  for (const experiment::ParameterValue& level : axis.levels) {
    PageView view{.group = experiment::LabelOf(axis.Name()),
                  .label = level.text,
                  .query = TrialsWhere(axis.Name(), level.text)};
    for (std::size_t i = 0; i < result.settings.size(); ++i) {
      if (result.settings[i].theta[parameter] == level)
        view.settings.push_back(static_cast<int>(i));
    }
    if (view.settings.empty()) continue;
    TakePart(result, &view);
    views->push_back(std::move(view));
  }
}

}  // namespace

std::vector<PageView> PageViews(const sweep::SweepResult& result) {
  std::vector<PageView> views;
  views.push_back(AllTrials(result));
  if (result.rows.size() > kMostRows) return views;
  for (int i = 0; i < static_cast<int>(result.parameters.size()); ++i) AddLevels(result, i, &views);
  if (result.parameters.size() < 2 || result.settings.size() > kMostSettings) return views;
  for (int i = 0; i < static_cast<int>(result.settings.size()); ++i) {
    PageView view{.group = "setting",
                  .label = SettingLabel(result, result.settings[i].theta),
                  .query = TrialsOf(result, result.settings[i].theta),
                  .settings = {i}};
    TakePart(result, &view);
    views.push_back(std::move(view));
  }
  return views;
}

}  // namespace rift::report
