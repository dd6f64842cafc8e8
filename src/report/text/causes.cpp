#include "causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rift::report {
namespace {

constexpr double kSmallShare = 0.05;

std::string P(double p) { return p < 0.001 ? "p < 0.001" : fmt::format("p = {:.3f}", p); }

std::string Capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

/// "0.0040 to 0.0110"
std::string Between(double low, double high, double unit, int digits) {
  return fmt::format("{:.{}f} to {:.{}f}", unit * low, digits, unit * high, digits);
}

/// The terms of the linear model that are seen, the largest first.
void SayFactors(const sweep::Explanation& explanation, Finding* finding) {
  std::vector<const sweep::FactorialTerm*> seen;
  for (const sweep::FactorialTerm& term : explanation.factors.terms) {
    if (!(term.p < 0.05)) continue;
    seen.push_back(&term);
  }
  std::stable_sort(seen.begin(), seen.end(),
                   [](const auto* a, const auto* b) { return a->share > b->share; });
  for (const sweep::FactorialTerm* term : seen) {
    finding->sentences.push_back(
        fmt::format("{} matters: {:.0f} % of the gap's variance beside the others, {} % with 95 % "
                    "confidence ({}).",
                    term->name, 100.0 * term->share,
                    Between(term->share_low, term->share_high, 100.0, 0), P(term->p)));
  }
}

void SayInteractions(const sweep::Explanation& explanation, Finding* finding) {
  bool is_any_seen = false;
  for (const sweep::FactorialTerm& term : explanation.factors.terms) {
    if (term.p < 0.05 && term.IsInteraction()) return;
    is_any_seen = is_any_seen || term.p < 0.05;
  }
  if (explanation.factors.has_interactions && is_any_seen) {
    finding->sentences.push_back(Sentence("No two parameters are seen to act together."));
  }
}

void SayIndices(const sweep::Explanation& explanation, Finding* finding) {
  const sweep::Sensitivity& sensitivity = explanation.sensitivity;
  std::string small;
  for (const sweep::SobolIndex& index : sensitivity.indices) {
    if (index.total_high < kSmallShare) {
      small += (small.empty() ? "" : ", ") + index.parameter;
      continue;
    }
    finding->sentences.push_back(
        fmt::format("{}: {:.0f} % of the gap's variance ({}), of it {:.0f} % alone.",
                    index.parameter, 100.0 * index.total,
                    Between(index.total_low, index.total_high, 100.0, 0), 100.0 * index.first));
  }
  if (!small.empty()) {
    finding->sentences.push_back(
        fmt::format("Less than {:.0f} % each: {}.", 100.0 * kSmallShare, small));
  }
  if (!sensitivity.note.empty()) finding->sentences.push_back(Capital(sensitivity.note) + ".");
}

/// Of an inert parameter first why it is, which is what the controller or the paths tell.
std::string InertText(const sweep::Inertness& inert) {
  std::string text = inert.parameter + " is inert: ";
  for (std::size_t i = 1; i < inert.sentences.size(); ++i) text += inert.sentences[i] + "; ";
  return text + inert.sentences.front();
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

void SayStart(const sweep::Explanation& explanation, Finding* finding) {
  const sweep::Estimate& start = explanation.anatomy.start_m;
  if (!sweep::IsClear(start) || start.mean <= 0.0) return;
  finding->sentences.push_back(fmt::format(
      "Start placement matters: {:.4f} m of the mean gap ({}) go when the first points are laid "
      "together.",
      start.mean, Between(start.low, start.high, 1.0, 4)));
}

std::string IntervalText(const sweep::Estimate& estimate) {
  if (std::isnan(estimate.low)) return "";
  return fmt::format(" ({})", Between(estimate.low, estimate.high, 1.0, 4));
}

std::string PartText(const sweep::GapPart& part) {
  return fmt::format("{}: {:+.4f} m{}; {}.", Capital(part.name), part.size_m.mean,
                     IntervalText(part.size_m), part.remedy);
}

void SayParts(const sweep::Explanation& explanation, Finding* finding) {
  const sweep::Anatomy& anatomy = explanation.anatomy;
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

template <class Field>
double MeanOverTrials(const sweep::SweepResult& result, Field field) {
  double sum = 0.0;
  long n = 0;
  for (const sweep::TrialRow& row : result.rows) {
    const double value = row.comparison.*field;
    if (!row.IsOk() || !std::isfinite(value)) continue;
    sum += value;
    ++n;
  }
  return n == 0 ? NAN : sum / static_cast<double>(n);
}

}  // namespace

Finding Because(const sweep::SweepResult& result, const sweep::Explanation& explanation) {
  Finding finding{"Because of what?", {}};
  SayFactors(explanation, &finding);
  SayIndices(explanation, &finding);
  SayStart(explanation, &finding);
  SayInert(explanation, true, &finding);
  SayInert(explanation, false, &finding);
  SayInteractions(explanation, &finding);
  if (finding.sentences.empty()) {
    finding.sentences.push_back(Sentence(
        result.effects.empty() ? "Not known: no parameter was varied over comparable values."
                               : "Not known: too few trials with a gap to test any parameter."));
  }
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
  finding.sentences.push_back(
      fmt::format("Mean gap {:.4f} m; with the first points laid together {:.4f} m ({:+.0f} %); "
                  "{:.4f} m is shape, left after "
                  "the best rigid motion.",
                  gap_m, aligned_m, 100.0 * change, shape_m));
  SayParts(explanation, &finding);
  return finding;
}

}  // namespace rift::report
