#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/report/figures/setting_grid.hpp"
#include "rift/report/text/findings.hpp"

namespace rift::report {
namespace {

std::string Metres(double value_m) { return fmt::format("{:.4f} m", value_m); }

std::string Count(long n, std::string_view noun) {
  return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s");
}

struct Mean {
  double sum = 0.0;
  long n = 0;

  void Add(double value) {
    if (!std::isfinite(value)) return;
    sum += value;
    ++n;
  }
  double Value() const { return n == 0 ? NAN : sum / static_cast<double>(n); }
};

template <class Field>
double MeanOverTrials(const sweep::SweepResult& result, Field field) {
  Mean mean;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) mean.Add(row.comparison.*field);
  }
  return mean.Value();
}

}  // namespace

Finding BesideNoise(const sweep::SweepResult& result) {
  Finding finding{"How much is the robot's own scatter?", {}};
  Mean floor;
  for (const sweep::SettingResult& setting : result.settings) floor.Add(setting.noise_floor_m);
  if (floor.n == 0) {
    finding.sentences.push_back(
        Sentence("Not known: no setting has two references to compare with each other."));
    return finding;
  }
  finding.sentences.push_back(fmt::format(
      "Repeats of one setting are {} apart from each other (noise floor, mean of {}); the mean gap "
      "to the candidate is {}, {:.2f} times that.",
      Metres(floor.Value()), Count(floor.n, "setting"), Metres(result.all.mean_gap_m),
      result.all.mean_gap_m / floor.Value()));
  return finding;
}

Finding MadeOf(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  Finding finding{"What is the gap made of?", {}};
  const double gap_m = MeanOverTrials(result, &gap::Comparison::gap_m);
  const double aligned_m = MeanOverTrials(result, &gap::Comparison::start_aligned_gap_m);
  const double shape_m = MeanOverTrials(result, &gap::Comparison::shape_gap_m);
  if (!std::isfinite(aligned_m) || !std::isfinite(shape_m)) {
    finding.sentences.push_back(Sentence("Not known: no trial has a gap."));
    return finding;
  }
  const double change = (aligned_m - gap_m) / gap_m;
  finding.sentences.push_back(fmt::format(
      "Mean gap {}; with the first points laid together {} ({:+.0f} %); {} is shape, left after "
      "the best rigid motion.",
      Metres(gap_m), Metres(aligned_m), 100.0 * change, Metres(shape_m)));
  SayParts(explanation, &finding);
  return finding;
}

Finding NotMeasuredFinding(const sweep::SweepResult& result) {
  Finding finding{"What was not measured?", {}};
  if (result.all.not_ok == 0) {
    finding.sentences.push_back(fmt::format("Nothing: all {} have a gap.",
                                            Count(static_cast<long>(result.rows.size()), "trial")));
    return finding;
  }
  std::string kinds;
  const auto names = EnumNames(sweep::TrialStatus{});
  for (std::size_t kind = 1; kind < names.size(); ++kind) {
    const auto status = static_cast<sweep::TrialStatus>(kind);
    const long n = std::count_if(result.rows.begin(), result.rows.end(),
                                 [status](const auto& row) { return row.status == status; });
    if (n == 0) continue;
    kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", n, names[kind]);
  }
  finding.sentences.push_back(
      fmt::format("Without a gap: {} of {} ({}). They are in no mean on this page.",
                  result.all.not_ok, Count(static_cast<long>(result.rows.size()), "trial"), kinds));
  const long fewer =
      std::count_if(result.settings.begin(), result.settings.end(), [&](const auto& setting) {
        return setting.verdict.repeats > 0 && NotMeasured(result, setting) > 0;
      });
  if (fewer > 0) {
    finding.sentences.push_back(
        fmt::format("{} judged by fewer repeats than asked for.", Count(fewer, "setting")));
  }
  return finding;
}

std::vector<std::string> UnmeasuredTrials(const sweep::SweepResult& result) {
  std::vector<std::string> lines;
  for (const sweep::TrialRow& row : result.rows) {
    if (row.IsOk()) continue;
    lines.push_back(fmt::format("{}, trial {}: {} – {}", SettingLabel(result, row.theta), row.trial,
                                EnumNames(row.status)[static_cast<int>(row.status)], row.reason));
  }
  return lines;
}

}  // namespace rift::report
