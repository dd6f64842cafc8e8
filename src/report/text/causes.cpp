#include "causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::report {
namespace {

constexpr double kSmallShare = 0.05;

/// "0.0040 to 0.0110"
std::string Between(double low, double high, double unit, int digits) {
  return fmt::format("{:.{}f} to {:.{}f}", unit * low, digits, unit * high, digits);
}

/// All parameters by the one measure, the largest share first, then how far it can be trusted.
void SayEffects(const sweep::Explanation& explanation, Finding* finding) {
  std::string small;
  for (const sweep::ParameterEffect& effect : explanation.effects.parameters) {
    if (!effect.IsSeen() && effect.share_high < kSmallShare) {
      small += (small.empty() ? "" : ", ") + effect.name;
      continue;
    }
    finding->sentences.push_back(effect.sentence + ".");
  }
  if (!small.empty()) {
    finding->sentences.push_back(
        fmt::format("No effect seen, and less than {:.0f} % of the loss's variance each: {}.",
                    100.0 * kSmallShare, small));
  }
  const std::string& note = explanation.effects.note;
  if (!note.empty()) finding->sentences.push_back(Capital(note) + ".");
}

std::string InertText(const sweep::Inertness& inert) {
  return fmt::format("{} is inert: {}", inert.parameter, fmt::join(inert.sentences, "; "));
}

void SayInert(const sweep::Explanation& explanation, bool is_inert, Finding* finding) {
  for (const sweep::Inertness& inert : explanation.inert) {
    if (inert.is_detected || inert.sentences.empty() || inert.IsInert() != is_inert) continue;
    std::string text = is_inert ? InertText(inert) : "";
    for (std::size_t i = 0; !is_inert && i < inert.sentences.size(); ++i) {
      text += i == 0 ? Capital(inert.sentences[i]) : "; " + inert.sentences[i];
    }
    finding->sentences.push_back(text + ".");
  }
}

std::string OverWhat(const sweep::Anatomy& anatomy) {
  return anatomy.is_over_settings ? "over the settings" : "over the trials";
}

void SayStart(const sweep::Explanation& explanation, Finding* finding) {
  const sweep::Estimate& start = explanation.anatomy.start_m;
  if (!sweep::IsClear(start) || start.mean <= 0.0) return;
  finding->sentences.push_back(fmt::format(
      "Start placement matters: {:.4f} m of the mean gap {} ({}) go when the first points are laid "
      "together.",
      start.mean, OverWhat(explanation.anatomy), Between(start.low, start.high, 1.0, 4)));
}

std::string IntervalText(const sweep::Estimate& estimate) {
  if (std::isnan(estimate.low)) return "";
  return fmt::format(" ({})", Between(estimate.low, estimate.high, 1.0, 4));
}

std::string PartText(const sweep::GapPart& part) {
  return fmt::format("{}: {:+.4f} m{}; {}.", Capital(part.name), part.size_m.mean,
                     IntervalText(part.size_m), part.remedy);
}

/// How short of the goal a run stops is a tolerance of the task, so it is told apart.
void SayGoal(const sweep::Anatomy& anatomy, Finding* finding) {
  if (!std::isfinite(anatomy.goal_m.mean)) return;
  std::string text = fmt::format(
      "Stopping short of the goal: {:+.4f} m{} of it go when runs that stopped within "
      "control.reach_radius_m go straight on until they are level with the last waypoint",
      anatomy.goal_m.mean, IntervalText(anatomy.goal_m));
  if (anatomy.only_at_goal > 0) {
    text +=
        fmt::format("; {} above the threshold by that alone, and no failure{}",
                    anatomy.only_at_goal == 1 ? "1 trial is"
                                              : fmt::format("{} trials are", anatomy.only_at_goal),
                    anatomy.only_at_goal == 1 ? "" : "s");
  }
  finding->sentences.push_back(text + ".");
}

void SayParts(const sweep::Explanation& explanation, Finding* finding) {
  const sweep::Anatomy& anatomy = explanation.anatomy;
  SayGoal(anatomy, finding);
  for (const sweep::GapPart& part : anatomy.parts) {
    if (std::isfinite(part.size_m.mean)) finding->sentences.push_back(PartText(part));
  }
  if (std::isfinite(anatomy.removable_m.mean)) {
    finding->sentences.push_back(
        fmt::format("A perfect simulator would still be {:.4f} m away, as repeats are from each "
                    "other: {:.4f} m{} "
                    "of the gap are a simulator's to remove at most.",
                    anatomy.noise_m.mean, std::max(0.0, anatomy.removable_m.mean),
                    IntervalText(anatomy.removable_m)));
  }
  if (std::isfinite(anatomy.timing_m.mean)) {
    finding->sentences.push_back(
        fmt::format("Timing is no part of the gap; at equal times instead of equal shares of the "
                    "path it would differ by {:+.4f} m.",
                    anatomy.timing_m.mean));
  }
}

}  // namespace

std::string Capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

Finding Because(const sweep::Explanation& explanation) {
  Finding finding{"Because of what?", {}};
  SayEffects(explanation, &finding);
  SayStart(explanation, &finding);
  SayInert(explanation, true, &finding);
  SayInert(explanation, false, &finding);
  if (finding.sentences.empty()) {
    finding.sentences.push_back(
        Sentence("Not known: no parameter was varied over comparable values."));
  }
  return finding;
}

Finding MadeOf(const sweep::Explanation& explanation) {
  Finding finding{"What is the gap made of?", {}};
  const sweep::Anatomy& anatomy = explanation.anatomy;
  const double gap_m = anatomy.gap_m.mean;
  const double aligned_m = gap_m - anatomy.start_m.mean;
  const double shape_m = anatomy.shape_m.mean;
  if (!std::isfinite(aligned_m) || !std::isfinite(shape_m)) {
    finding.sentences.push_back(Sentence("Not known: no trial has a gap."));
    return finding;
  }
  const std::string change =
      gap_m > 0.0 ? fmt::format(" ({:+.0f} %)", 100.0 * (aligned_m - gap_m) / gap_m) : "";
  finding.sentences.push_back(
      fmt::format("Mean gap {} {:.4f} m; with the first points laid together {:.4f} m{}; "
                  "{:.4f} m is shape, left after "
                  "the best rigid motion.",
                  OverWhat(anatomy), gap_m, aligned_m, change, shape_m));
  SayParts(explanation, &finding);
  return finding;
}

}  // namespace rift::report
