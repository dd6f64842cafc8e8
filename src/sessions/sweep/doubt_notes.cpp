#include "doubt_notes.hpp"

#include <fmt/format.h>

#include "rift/sweep/falsify/doubts.hpp"

namespace rift::sessions {

void DoubtNotes::Seen(const sweep::TrialRow& row) {
  constexpr int kSureEnough = 3;  // trials with a gap; fewer wait for the end
  told_ += row.IsOk();
  for (const sweep::TrialDoubt& doubt : row.doubts) {
    const std::string kind = sweep::KindOf(doubt);
    const int trials = ++trials_[kind];
    const bool is_sure = told_ >= kSureEnough && sweep::CountsAsDoubt(kinds_, doubt, trials, told_);
    if (!is_sure || !said_.insert(kind).second) continue;
    const std::string more =
        trials > 1 ? fmt::format(" (and {} more trials so far)", trials - 1) : "";
    warn_(fmt::format("warning: {}{}: {}", sweep::SidesText(row, doubt.about), more, doubt.text));
  }
}

void DoubtNotes::End(const sweep::SweepResult& result) {
  for (const sweep::SweepDoubt& doubt : result.doubts) {
    if (!said_.insert(sweep::KindOf(doubt.first)).second) continue;
    warn_("warning: " + sweep::DoubtText(result, doubt));
  }
}

}  // namespace rift::sessions
