#include "rift/sweep/falsify/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "rift/gap/doubts.hpp"

namespace rift::sweep {
namespace {

using experiment::ReferenceKind;

void ReplaceAll(std::string& text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

/// The flags of rift gap for each side are keys of an experiment.
std::string InKeys(std::string text) {
  for (const std::string kind : {"units", "columns"}) {
    ReplaceAll(text, "--sim-" + kind + " ", "--set candidate." + kind + "=");
    ReplaceAll(text, "--real-" + kind + " ", "--set reference." + kind + "=");
  }
  return text;
}

bool IsRecorded(const SweepResult& result, DoubtAbout about) {
  switch (about) {
    case DoubtAbout::kCandidate:
      return result.candidate_kind == "logs";
    case DoubtAbout::kReference:
      return result.reference_kind == "logs";
    case DoubtAbout::kPair:
      return result.candidate_kind == "logs" && result.reference_kind == "logs";
  }
  return false;
}

}  // namespace

std::vector<TrialDoubt> DoubtsOf(const experiment::Experiment& experiment,
                                 const Recording& candidate, const Recording& reference) {
  std::vector<TrialDoubt> doubts;
  for (const std::string& doubt : candidate.doubts) {
    doubts.push_back({DoubtAbout::kCandidate, doubt});
  }
  for (const std::string& doubt : reference.doubts) {
    doubts.push_back({DoubtAbout::kReference, doubt});
  }
  const bool is_of_others = experiment.reference.kind == ReferenceKind::kLogs ||
                            experiment.reference.kind == ReferenceKind::kProgram;
  if (!is_of_others) return doubts;
  for (const std::string& doubt :
       gap::Doubts(candidate.trajectory, reference.trajectory, experiment.gap)) {
    doubts.push_back({DoubtAbout::kPair, InKeys(doubt)});
  }
  return doubts;
}

std::string KindOf(const TrialDoubt& doubt) {
  std::string kind(EnumNames(doubt.about)[static_cast<size_t>(doubt.about)]);
  for (const char c : doubt.text) {
    const bool is_of_number = (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '+';
    if (!is_of_number) kind += c;
  }
  return kind;
}

bool CountsAsDoubt(const SweepResult& result, const TrialDoubt& doubt, int trials, int told) {
  return IsRecorded(result, doubt.about) ? trials > 0 : 2 * trials >= told;
}

std::vector<SweepDoubt> DoubtsOf(const SweepResult& result) {
  std::vector<SweepDoubt> doubts;
  std::map<std::string, size_t> places;
  int told = 0;
  for (size_t i = 0; i < result.rows.size(); ++i) {
    told += result.rows[i].IsOk();
    for (const TrialDoubt& doubt : result.rows[i].doubts) {
      const auto [place, is_new] = places.try_emplace(KindOf(doubt), doubts.size());
      if (is_new) doubts.push_back({doubt, 0, static_cast<int>(i)});
      ++doubts[place->second].trials;
    }
  }
  std::erase_if(doubts, [&](const SweepDoubt& doubt) {
    return !CountsAsDoubt(result, doubt.first, doubt.trials, told);
  });
  return doubts;
}

std::string SidesText(const TrialRow& row, DoubtAbout about) {
  switch (about) {
    case DoubtAbout::kCandidate:
      return row.candidate;
    case DoubtAbout::kReference:
      return row.reference;
    case DoubtAbout::kPair:
      break;
  }
  return fmt::format("SIM {} and REAL {}", row.candidate, row.reference);
}

std::string DoubtText(const SweepResult& result, const SweepDoubt& doubt) {
  const TrialRow& row = result.rows[static_cast<size_t>(doubt.row)];
  const std::string more =
      doubt.trials > 1 ? fmt::format(" (and {} more trials)", doubt.trials - 1) : "";
  return fmt::format("{}{}: {}", SidesText(row, doubt.first.about), more, doubt.first.text);
}

}  // namespace rift::sweep
