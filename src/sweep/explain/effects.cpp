#include "rift/sweep/explain/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "expansion.hpp"
#include "rift/statistics/inference.hpp"

namespace rift::sweep {
namespace {

constexpr double kTrustedPrediction = 0.5;

/// The noncentrality at which `holds(lambda)`, falling in lambda, becomes false; 0 when at once.
double LargestNoncentrality(const std::function<bool(double)>& holds) {
  constexpr double kLargest = 1e7;
  if (!holds(0.0)) return 0.0;
  double low = 0.0, high = 1.0;
  while (holds(high) && high < kLargest) low = std::exchange(high, 2.0 * high);
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (holds(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// A model and what it leaves.
struct Model {
  const Regression& regression;
  Regression::Fit all;
  double residual_df = 0.0;
  double mse = 0.0;  ///< m^2
};

struct Share {
  double value = gap::kNotComputed, low = gap::kNotComputed, high = gap::kNotComputed;
  double df = 0.0, p = gap::kNotComputed;
};

/// Of the columns that are in `larger` and not in `smaller`.
Share ShareOf(const Model& model, const Regression::Fit& larger, const Regression::Fit& smaller) {
  const double total = model.regression.Total();
  Share share{.df = larger.rank - smaller.rank};
  if (share.df < 1.0 || !(total > 0.0)) return share;
  const double gain = std::max(0.0, smaller.sse - larger.sse);
  if (!(model.mse > 0.0)) {  // the model is exact: nothing is left to chance
    share.value = share.low = share.high = gain / total;
    share.p = gain > 0.0 ? 0.0 : 1.0;
    return share;
  }
  const double f = gain / share.df / model.mse;
  share.p = statistics::FUpperTail(share.df, model.residual_df, f);
  share.value = std::clamp((gain - share.df * model.mse) / (total + model.mse), 0.0, 1.0);
  // Of a larger effect the total is larger too: what the columns do not explain stays as it is. Of
  // one factor alone the share is lambda / (lambda + trials - 1).
  const double rest = total - gain + share.df * model.mse;
  const auto share_at = [&](double tail, double f_there) {
    const double lambda = LargestNoncentrality([&](double l) {
      return statistics::NoncentralFCdf(share.df, model.residual_df, l, f_there) > tail;
    });
    return lambda * model.mse / (lambda * model.mse + rest);
  };
  share.low = std::min(share.value, share_at(0.975, f));
  // Means that lie closer together than chance lays them are luck, and bound nothing: without the 1
  // a handful of trials would now and then say that a parameter has next to no effect.
  share.high = std::max(share.value, share_at(0.025, std::max(f, 1.0)));
  return share;
}

Share Total(const Model& model, int axis) {
  return ShareOf(model, model.all,
                 model.regression.With([&](const Orders& orders) { return orders[axis] == 0; }));
}

/// By the columns of the axis itself, beside those that do not involve it.
Share Alone(const Model& model, int axis) {
  const auto is_other = [&](const Orders& orders) { return orders[axis] == 0; };
  const auto is_own = [&](const Orders& orders) {
    Orders rest = orders;
    rest[axis] = 0;
    return orders[axis] > 0 && std::all_of(rest.begin(), rest.end(), [](int o) { return o == 0; });
  };
  return ShareOf(model, model.regression.With([&](const Orders& orders) {
    return is_other(orders) || is_own(orders);
  }),
                 model.regression.With(is_other));
}

Share Together(const Model& model, int a, int b) {
  return ShareOf(model, model.all, model.regression.With([&](const Orders& orders) {
    return orders[a] == 0 || orders[b] == 0;
  }));
}

std::string SentenceOf(const ParameterEffect& effect) {
  if (std::isnan(effect.share)) {
    return fmt::format("{}: its effect cannot be told from that of the others", effect.name);
  }
  const std::string interval =
      fmt::format("{} to {} %", PercentDigits(effect.share_low), PercentDigits(effect.share_high));
  if (!effect.IsSeen()) {
    return fmt::format("{}: no effect seen; at most {} of the loss's variance goes with it",
                       effect.name, PercentText(effect.share_high));
  }
  std::string text =
      fmt::format("{}: {} of the loss's variance goes with it ({} with 95 % confidence)",
                  effect.name, PercentText(effect.share), interval);
  if (effect.together.empty()) return text;
  return text + fmt::format(", {} with it alone and the rest together with {}",
                            PercentText(std::min(effect.alone, effect.share)),
                            fmt::join(effect.together, ", "));
}

ParameterEffect EffectOf(const SweepResult& result, const Observations& data, const Model& model,
                         int axis) {
  const int parameter = data.parameters[axis];
  ParameterEffect effect{.parameter = parameter, .name = result.parameters[parameter].Name()};
  const Share total = Total(model, axis);
  effect.share = total.value;
  effect.share_low = total.low;
  effect.share_high = total.high;
  effect.df = total.df;
  effect.p = total.p;
  effect.alone = Alone(model, axis).value;
  for (int other = 0; other < static_cast<int>(data.parameters.size()); ++other) {
    if (other == axis || !effect.IsSeen() || !(Together(model, axis, other).low > 0.0)) continue;
    effect.together.push_back(result.parameters[data.parameters[other]].Name());
  }
  effect.sentence = SentenceOf(effect);
  return effect;
}

/// What the model explains, less what chance alone would, and no parameter alone accounts for: a
/// search goes where several change together.
std::string SharedText(const Effects& effects, double beyond_chance) {
  constexpr double kWorthSaying = 0.1;
  double shared = beyond_chance;
  for (const ParameterEffect& effect : effects.parameters) {
    if (std::isfinite(effect.share)) shared -= effect.share;
  }
  if (shared < kWorthSaying) return "";
  return fmt::format(
      "; {} goes with parameters that were changed together and cannot be told apart between them",
      PercentText(shared));
}

std::string NoteOn(const Effects& effects, int most_of_setting, double beyond_chance) {
  const std::string first = most_of_setting == 0 ? ""
                            : most_of_setting == 1
                                ? " (the first of each setting)"
                                : fmt::format(" (of each setting the first {})", most_of_setting);
  return fmt::format(
      "from a model of degree {} through {} trials{}, which explains {} of the variance and "
      "predicts {} of that of a trial left out{}{}",
      effects.degree, effects.trials, first, PercentText(std::max(0.0, effects.explained)),
      PercentText(std::max(0.0, effects.predicted)),
      effects.predicted < kTrustedPrediction
          ? "; with so little, the shares say what it saw and not what is"
          : "",
      SharedText(effects, beyond_chance));
}

/// Of a list FindInert tells it; no two settings of a search share the value of a range.
std::string SameRunsText(const SweepResult& result, const Observations& data) {
  const bool has_range =
      std::any_of(result.parameters.begin(), result.parameters.end(),
                  [](const auto& parameter) { return parameter.IsContinuous(); });
  if (!data.are_same_runs || !has_range) return "";
  return "no parameter that was varied did anything: trials with the same random numbers are the "
         "same to the last bit at every setting that was tried";
}

}  // namespace

const ParameterEffect* Effects::Of(int parameter) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& effect) {
    return effect.parameter == parameter;
  });
  return found == parameters.end() ? nullptr : &*found;
}

Effects MeasureEffects(const SweepResult& result, const EffectOptions& options) {
  Effects effects;
  const Observations data = Observe(result, options.most_trials);
  effects.trials = static_cast<int>(data.rows.size());
  if (data.parameters.empty()) {
    effects.note = SameRunsText(result, data);
    return effects;
  }
  const Expansion expansion =
      BestExpansion(result, data, {options.most_terms, options.most_degree});
  if (expansion.degree == 0) {
    effects.note = "too few trials that tell to say what matters";
    return effects;
  }
  const Regression regression(expansion, data.losses_m);
  if (!(regression.Total() > 0.0)) {
    effects.note = "the loss does not vary: nothing is seen to matter";
    return effects;
  }
  Model model{regression, regression.With([](const Orders&) { return true; })};
  model.residual_df = effects.trials - model.all.rank;
  model.mse = model.residual_df >= 1.0 ? model.all.sse / model.residual_df : 0.0;
  effects.degree = expansion.degree;
  effects.predicted = expansion.predicted;
  effects.residual_df = model.residual_df;
  effects.residual_sd_m = std::sqrt(model.mse);
  effects.explained = 1.0 - model.all.sse / regression.Total();
  for (int axis = 0; axis < static_cast<int>(data.parameters.size()); ++axis) {
    effects.parameters.push_back(EffectOf(result, data, model, axis));
  }
  const auto constant = regression.With([](const Orders&) { return false; });
  effects.note = NoteOn(effects, data.most_of_setting, ShareOf(model, model.all, constant).value);
  std::stable_sort(effects.parameters.begin(), effects.parameters.end(),
                   [](const auto& a, const auto& b) {
                     const auto rank = [](double s) { return std::isnan(s) ? -1.0 : s; };
                     return rank(a.share) > rank(b.share);
                   });
  return effects;
}

double SmallestDetectable(const std::vector<int>& counts, double sd, double residual_df,
                          double power) {
  const double levels = static_cast<double>(counts.size());
  double inverse = 0.0;
  for (const int n : counts) inverse += 1.0 / n;
  if (levels < 2.0 || residual_df < 1.0 || !(sd > 0.0) || !std::isfinite(inverse)) {
    return gap::kNotComputed;
  }
  const double df = levels - 1.0;
  const double critical = statistics::FCriticalValue(df, residual_df, kSignificance);
  const double lambda = LargestNoncentrality([&](double l) {
    return statistics::NoncentralFCdf(df, residual_df, l, critical) > 1.0 - power;
  });
  // Two means at -d/2 and d/2 with n trials each: lambda = n d^2 / (2 sd^2).
  return sd * std::sqrt(2.0 * lambda * inverse / levels);
}

}  // namespace rift::sweep
