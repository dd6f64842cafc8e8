#include "rift/sweep/explain/shrink.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "rift/sweep/explain/worst_trial.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/verdict.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::sweep {
namespace {

/// Six, since a person reads them, and those that two different numbers share.
int DigitsFor(double a, double b) {
  const double way = std::abs(b - a), larger = std::max({std::abs(a), std::abs(b), way});
  return std::min(17, 6 + static_cast<int>(std::log10(larger / way)));
}

/// The middle in so many digits, whole for a parameter that counts: what is tried is what is
/// written. Nothing where no such number lies between the two.
std::optional<experiment::ParameterValue> MiddleOf(double a, double b, int digits,
                                                   bool is_integer) {
  const double middle = 0.5 * (a + b);
  const double rounded =
      is_integer ? std::round(middle) : std::stod(fmt::format("{:.{}g}", middle, digits));
  if (!(std::min(a, b) < rounded && rounded < std::max(a, b))) return std::nullopt;
  return experiment::NumberValue(rounded);
}

/// How many sets of fewer than `size` things can be taken from `n`.
double SetsBelow(size_t n, size_t size) {
  double sets = 0.0, of_size = 1.0;
  for (size_t k = 0; k < size; ++k) {
    sets += of_size;
    of_size *= static_cast<double>(n - k) / static_cast<double>(k + 1);
  }
  return sets;
}

class Shrinker {
 public:
  Shrinker(const std::vector<experiment::Parameter>& parameters, const experiment::Theta& nominal,
           const experiment::Theta& failing, const Robustness& robustness,
           const ShrinkOptions& options)
      : parameters_(parameters),
        nominal_(nominal),
        robustness_(robustness),
        options_(options),
        theta_(failing) {}

  ShrunkFailure Run() {
    if (!Fails(theta_)) {
      throw std::invalid_argument(
          fmt::format("there is nothing to shrink: the setting does not fail (robustness {:.4g} m)",
                      Of(theta_)));
    }
    const experiment::Theta failing = theta_;
    const size_t changes = Changed(failing).size();
    const bool may_try_all = SetsBelow(changes, changes) < options_.max_evaluations;
    // Taken back one by one, changes leave few enough sets to be tried. Half of what is left is for
    // their values.
    if (!may_try_all) DropOneByOne();
    const double most =
        may_try_all ? options_.max_evaluations : 0.5 * (options_.max_evaluations - evaluations_);
    is_fewest_ = TakeFewest(failing, most);
    if (!is_fewest_) TakeFewest(experiment::Theta(theta_), most);
    bool is_smaller = true;
    while (is_smaller) {  // a smaller change may make another one needless
      DropOneByOne();
      is_smaller = ShrinkEach();
    }
    return Finish();
  }

 private:
  bool HasBudget() const { return evaluations_ < options_.max_evaluations; }

  double Of(const experiment::Theta& theta) {
    const auto [found, is_new] = known_.emplace(theta, 0.0);
    if (is_new) {
      found->second = robustness_(theta);
      ++evaluations_;
    }
    return found->second;
  }
  bool Fails(const experiment::Theta& theta) { return Of(theta) < 0.0; }

  std::vector<int> Changed(const experiment::Theta& theta) const {
    std::vector<int> changed;
    for (size_t i = 0; i < theta.size(); ++i) {
      if (!SameValue(theta[i], nominal_[i])) changed.push_back(static_cast<int>(i));
    }
    return changed;
  }

  /// Sets of the changes of a setting by rising size, while they are smaller than that which is
  /// left; the first that fails is taken. Not all tried, and false, where they are more than
  /// `most`.
  bool TakeFewest(const experiment::Theta& failing, double most) {
    const std::vector<int> changed = Changed(failing);
    const size_t n = changed.size(), left = Changed(theta_).size();
    if (SetsBelow(n, left) > most) return false;
    for (size_t size = 0; size < left; ++size) {
      std::vector<bool> is_kept(n, false);
      std::fill(is_kept.begin(), is_kept.begin() + static_cast<long>(size), true);
      do {
        if (!HasBudget()) return false;
        experiment::Theta theta = nominal_;
        for (size_t i = 0; i < n; ++i) {
          if (is_kept[i]) theta[changed[i]] = failing[changed[i]];
        }
        if (!Fails(theta)) continue;
        theta_ = theta;
        return true;
      } while (std::prev_permutation(is_kept.begin(), is_kept.end()));
    }
    return true;
  }

  void DropOneByOne() {
    bool is_dropped = true;
    while (is_dropped && HasBudget()) {
      is_dropped = false;
      for (const int i : Changed(theta_)) {
        experiment::Theta without = theta_;
        without[i] = nominal_[i];
        if (!HasBudget() || !Fails(without)) continue;
        theta_ = without;
        is_dropped = true;
      }
    }
  }

  bool ShrinkEach() {
    bool is_smaller = false;
    for (const int i : Changed(theta_)) {
      const experiment::ParameterValue before = theta_[i];
      if (!before.number || !nominal_[i].number) continue;
      if (parameters_[i].IsContinuous()) {
        Halve(i);
      } else {
        TryLevels(i);
      }
      is_smaller = is_smaller || !SameValue(before, theta_[i]);
    }
    return is_smaller && HasBudget();
  }

  /// The value between nominal and the failing one, as near to nominal as still fails; what fails
  /// further out is not asked for.
  void Halve(int i) {
    double holds = *nominal_[i].number, fails = *theta_[i].number;
    const double enough = options_.tolerance * std::abs(fails - holds);
    const int digits = DigitsFor(holds, fails);
    while (std::abs(fails - holds) > enough && HasBudget()) {
      const auto middle = MiddleOf(holds, fails, digits, parameters_[i].is_integer);
      if (!middle) return;
      experiment::Theta nearer = theta_;
      nearer[i] = *middle;
      if (Fails(nearer)) {
        theta_ = nearer;
        fails = *nearer[i].number;
      } else {
        holds = *nearer[i].number;
      }
    }
  }

  void TryLevels(int i) {
    const double nominal = *nominal_[i].number, far = *theta_[i].number;
    experiment::Theta between;
    for (const experiment::ParameterValue& level : parameters_[i].levels) {
      if (level.number && (*level.number - nominal) * (far - nominal) > 0.0 &&
          std::abs(*level.number - nominal) < std::abs(far - nominal)) {
        between.push_back(level);
      }
    }
    std::sort(between.begin(), between.end(), [&](const auto& a, const auto& b) {
      return std::abs(*a.number - nominal) < std::abs(*b.number - nominal);
    });
    for (const experiment::ParameterValue& level : between) {
      experiment::Theta nearer = theta_;
      nearer[i] = level;
      if (!HasBudget() || !Fails(nearer)) continue;
      theta_ = nearer;
      return;
    }
  }

  ShrunkFailure Finish() {
    ShrunkFailure shrunk{.theta = theta_, .changed = Changed(theta_)};
    shrunk.robustness = Of(theta_);
    shrunk.is_minimal = HasBudget();
    for (const int i : shrunk.changed) {
      experiment::Theta without = theta_;
      without[i] = nominal_[i];
      shrunk.is_minimal = shrunk.is_minimal && !Fails(without);
    }
    shrunk.is_fewest = is_fewest_ && shrunk.is_minimal;
    shrunk.evaluations = evaluations_;
    return shrunk;
  }

  const std::vector<experiment::Parameter>& parameters_;
  const experiment::Theta& nominal_;
  const Robustness& robustness_;
  ShrinkOptions options_;
  experiment::Theta theta_;  ///< fails, always
  std::map<experiment::Theta, double> known_;
  int evaluations_ = 0;
  bool is_fewest_ = false;
};

}  // namespace

ShrunkFailure Shrink(const std::vector<experiment::Parameter>& parameters,
                     const experiment::Theta& nominal, const experiment::Theta& failing,
                     const Robustness& robustness, const ShrinkOptions& options) {
  return Shrinker(parameters, nominal, failing, robustness, options).Run();
}

namespace {

int WorstIndex(const SweepResult& result) {
  const std::optional<size_t> worst = WorstTrialOf(result);
  if (!worst) throw std::invalid_argument("--shrink worst: no trial has a gap");
  return static_cast<int>(*worst);
}

/// Index of the row with that id, or of the worst.
int IndexOf(const SweepResult& result, const std::string& id) {
  if (id == "worst") return WorstIndex(result);
  size_t number = 0;
  const auto [end, error] = std::from_chars(id.data(), id.data() + id.size(), number);
  const bool is_there = error == std::errc{} && end == id.data() + id.size() && number >= 1 &&
                        number <= result.rows.size();
  if (!is_there) {
    throw std::invalid_argument(
        fmt::format("--shrink {}: table.csv has the rows 1 to {}", id, result.rows.size()));
  }
  return static_cast<int>(number) - 1;
}

/// The row's trial at another setting: the same repeat and random numbers.
TrialRequest At(const TrialRow& row, const experiment::Theta& theta) {
  return {.theta = theta, .trial = row.trial, .seed = row.seed};
}

void RequireFailure(const SweepResult& result, int index, const std::string& id) {
  const TrialRow& row = result.rows[index];
  if (row.falsified) return;
  const std::string what = row.IsOk() ? fmt::format("its gap is {:.4f} m", row.comparison.gap_m)
                                      : fmt::format("it ended as '{}'", yaml::NameOf(row.status));
  throw std::invalid_argument(
      fmt::format("--shrink {}: row {} does not fail ({}, and above {:g} m falsifies){}", id,
                  index + 1, what, result.gap.threshold_m,
                  id == "worst" ? ": nothing of this sweep can be shrunk"
                                : "; --shrink worst takes the worst"));
}

}  // namespace

int FailingRow(const SweepResult& result, const std::string& id) {
  const int index = IndexOf(result, id);
  RequireFailure(result, index, id);
  return index;
}

ShrunkRow ShrinkRow(const experiment::Experiment& experiment, const SweepResult& result, int index,
                    const ShrinkOptions& options, const RunAllTrials& run) {
  const TrialRow& row = result.rows[index];
  const auto robustness_m = [&](const experiment::Theta& theta) {
    const std::vector<TrialRow> rows = run({At(row, theta)});
    return Robustness_m(rows, result.gap.threshold_m);
  };
  ShrunkRow found{.id = index + 1, .nominal = experiment::NominalTheta(experiment)};
  found.shrunk = Shrink(result.parameters, found.nominal, row.theta, robustness_m, options);
  std::vector<TrialRequest> requests{At(row, row.theta), At(row, found.shrunk.theta)};
  for (const int i : found.shrunk.changed) {
    experiment::Theta without = found.shrunk.theta;
    without[i] = found.nominal[i];
    requests.push_back(At(row, without));
  }
  found.rows = run(std::move(requests));
  return found;
}

}  // namespace rift::sweep
