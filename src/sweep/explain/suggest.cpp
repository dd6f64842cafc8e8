#include "rift/sweep/explain/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/statistics/inference.hpp"
#include "rift/sweep/falsify/result.hpp"

namespace rift::sweep {
namespace {

constexpr double kConfidence = 0.95, kPower = 0.8;
constexpr int kMostTrials = 1000;

/// What is known of the mean gap of a setting: normal around the mean of its trials.
struct Knowledge {
  double above_m = 0.0;    ///< mean so far less the threshold
  double scatter_m = 0.0;  ///< of a single trial
  int trials = 0;

  double Wrong() const {
    return statistics::NormalCdf(-std::abs(above_m) / (scatter_m / std::sqrt(trials)));
  }

  /// How far the mean will move with `more` trials (its predictive standard deviation).
  double Movement_m(int more) const {
    return scatter_m * std::sqrt(1.0 / trials - 1.0 / (trials + more));
  }

  /// Expected risk after them: the mean moves, then the rest of the risk is that of more trials.
  double WrongAfter(int more) const {
    constexpr int kHalf = 40;
    constexpr double kReach = 4.0;
    double sum = 0.0, weights = 0.0;
    for (int i = -kHalf; i <= kHalf; ++i) {
      const double z = kReach * i / kHalf;
      const double weight = std::exp(-0.5 * z * z);
      Knowledge later{above_m + z * Movement_m(more), scatter_m, trials + more};
      sum += weight * later.Wrong();
      weights += weight;
    }
    return sum / weights;
  }
};

double Width(int above, int trials) {
  const statistics::Interval share = statistics::AnytimeInterval(above, trials, kConfidence);
  return share.high - share.low;
}

/// Expected over how many of the further trials are above, given the scatter.
double WidthAfter(const gap::RepeatVerdict& now, const Knowledge& knowledge, int more) {
  const double share = statistics::NormalCdf(knowledge.above_m / knowledge.scatter_m);
  double width = 0.0;
  for (int k = 0; k <= more; ++k) {
    width += statistics::BinomialPdf(more, share, k) * Width(now.above + k, now.repeats + more);
  }
  return width;
}

int TrialsToDecide(const Knowledge& knowledge) {
  const double z =
      statistics::NormalQuantile(0.5 + 0.5 * kConfidence) + statistics::NormalQuantile(kPower);
  const double trials = std::pow(z * knowledge.scatter_m / knowledge.above_m, 2);
  return trials <= kMostTrials ? static_cast<int>(std::ceil(trials)) : -1;
}

Suggestion Describe(const SweepResult& result, int setting_index, int more, double scatter_m) {
  const SettingResult& setting = result.settings[setting_index];
  const Knowledge knowledge{setting.mean_loss_m - result.gap.threshold_m, scatter_m,
                            setting.verdict.repeats};
  Suggestion suggestion{.setting = setting_index, .repeats = more};
  suggestion.mean_gap_m = setting.mean_loss_m;
  suggestion.wrong_now = knowledge.Wrong();
  suggestion.above_now = knowledge.above_m > 0.0 ? 1.0 - knowledge.Wrong() : knowledge.Wrong();
  suggestion.wrong_after = knowledge.WrongAfter(more);
  suggestion.flip =
      statistics::NormalCdf(-std::abs(knowledge.above_m) / knowledge.Movement_m(more));
  suggestion.width_now = setting.verdict.share_high - setting.verdict.share_low;
  suggestion.width_after = WidthAfter(setting.verdict, knowledge, more);
  suggestion.trials_to_decide = TrialsToDecide(knowledge);
  suggestion.sentence = fmt::format(
      "{} of {}: is its mean gap above {:g} m? So far {:.4f} m from {}, above with {:.0f} % "
      "probability; the risk of calling it wrongly falls from {:.0f} to {:.0f} %, the call flips "
      "with {:.0f} %, and the interval for the share above narrows from {:.0f} to {:.0f} points",
      more == 1 ? "1 more trial" : fmt::format("{} more trials", more),
      SettingText(result.parameters, setting.theta), result.gap.threshold_m, setting.mean_gap_m,
      setting.verdict.repeats == 1 ? "1 trial" : fmt::format("{} trials", setting.verdict.repeats),
      100.0 * suggestion.above_now, 100.0 * suggestion.wrong_now, 100.0 * suggestion.wrong_after,
      100.0 * suggestion.flip, 100.0 * suggestion.width_now, 100.0 * suggestion.width_after);
  suggestion.sentence +=
      suggestion.trials_to_decide < 0
          ? fmt::format("; too near the threshold to be decided by {} trials", kMostTrials)
          : fmt::format("; about {} trials in all decide it", suggestion.trials_to_decide);
  return suggestion;
}

/// Without a scatter no risk can be told. The worst setting first, where the robot would have to
/// fail most surely; then those next to the threshold, where it may do either.
std::vector<Suggestion> FirstTrials(const SweepResult& result, const SuggestOptions& options) {
  const auto above_m = [&](int setting) {
    return result.settings[setting].mean_loss_m - result.gap.threshold_m;
  };
  std::vector<int> order;
  for (int i = 0; i < static_cast<int>(result.settings.size()); ++i) {
    if (result.settings[i].verdict.repeats > 0) order.push_back(i);
  }
  if (order.empty()) return {};
  std::iter_swap(order.begin(), std::max_element(order.begin(), order.end(), [&](int a, int b) {
                   return above_m(a) < above_m(b);
                 }));
  std::stable_sort(order.begin() + 1, order.end(),
                   [&](int a, int b) { return std::abs(above_m(a)) < std::abs(above_m(b)); });
  order.resize(std::min(order.size(), static_cast<size_t>(options.experiments)));
  std::vector<Suggestion> suggestions;
  for (const int i : order) {
    const double gap_m = result.settings[i].mean_loss_m;
    Suggestion suggestion{.setting = i, .repeats = options.repeats, .mean_gap_m = gap_m};
    suggestion.sentence = fmt::format(
        "{} of {}: does the robot go with the {:.4f} m that this sweep found there, {} {:g} m? "
        "Repeats on the robot also give its scatter, without which no risk can be told",
        options.repeats == 1 ? "1 trial" : fmt::format("{} trials", options.repeats),
        SettingText(result.parameters, result.settings[i].theta), gap_m,
        i == order.front() ? "the most of all settings, against" : "next to the threshold of",
        result.gap.threshold_m);
    suggestions.push_back(suggestion);
  }
  return suggestions;
}

}  // namespace

double RepeatScatter_m(const SweepResult& result) {
  double squares = 0.0;
  int df = 0;
  for (const SettingResult& setting : result.settings) {
    if (setting.verdict.repeats < 2) continue;
    for (const int row : DistinctRows(result.rows, setting.rows)) {
      const double loss_m = Loss_m(result.rows[row], result.gap.threshold_m);
      if (std::isfinite(loss_m)) squares += std::pow(loss_m - setting.mean_loss_m, 2);
    }
    df += setting.verdict.repeats - 1;
  }
  return df > 0 ? std::sqrt(squares / df) : gap::kNotComputed;
}

std::vector<Suggestion> SuggestExperiments(const SweepResult& result,
                                           const SuggestOptions& options) {
  const double scatter_m = RepeatScatter_m(result);
  if (!(scatter_m > 0.0)) return FirstTrials(result, options);
  std::vector<int> more(result.settings.size(), 0);
  std::vector<int> order;
  for (int experiment = 0; experiment < options.experiments; ++experiment) {
    int best = -1;
    double best_gain = 0.0;
    for (size_t i = 0; i < result.settings.size(); ++i) {
      const SettingResult& setting = result.settings[i];
      if (setting.verdict.repeats == 0) continue;
      const Knowledge knowledge{setting.mean_loss_m - result.gap.threshold_m, scatter_m,
                                setting.verdict.repeats};
      const double before = more[i] == 0 ? knowledge.Wrong() : knowledge.WrongAfter(more[i]);
      const double gain = before - knowledge.WrongAfter(more[i] + options.repeats);
      if (gain <= best_gain) continue;
      best_gain = gain;
      best = static_cast<int>(i);
    }
    if (best < 0) break;
    if (more[best] == 0) order.push_back(best);
    more[best] += options.repeats;
  }
  std::vector<Suggestion> suggestions;
  for (const int setting : order) {
    suggestions.push_back(Describe(result, setting, more[setting], scatter_m));
  }
  return suggestions;
}

}  // namespace rift::sweep
