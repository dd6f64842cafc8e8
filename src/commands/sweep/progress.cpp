#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>

#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"

namespace rift::commands {
namespace {

std::chrono::milliseconds PeriodOf(ProgressStyle style) {
  switch (style) {
    case ProgressStyle::kBar:
      return std::chrono::milliseconds(100);
    case ProgressStyle::kJson:
      return std::chrono::milliseconds(500);
    default:
      return std::chrono::milliseconds(5000);
  }
}

/// A line of progress in the words of each style; a bar's takes the place of the one before.
void Say(ProgressStyle style, const std::string& bar, const std::string& line,
         const std::string& json) {
  if (style == ProgressStyle::kBar) terminal::SayInPlace(bar);
  if (style == ProgressStyle::kLines) terminal::Say(line);
  if (style == ProgressStyle::kJson) terminal::Say(json);
}

}  // namespace

ProgressStyle StyleFor(bool quiet, bool json) {
  if (quiet) return ProgressStyle::kQuiet;
  if (json) return ProgressStyle::kJson;
  return ::isatty(2) == 1 ? ProgressStyle::kBar : ProgressStyle::kLines;
}

sessions::SweepObserver ObserverFor(ProgressStyle style) {
  return {
      .say = [](const std::string& line) { terminal::Say(line); },
      .begin =
          [style](const sessions::SweepSize& size) {
            return std::make_unique<SweepProgress>(style, size);
          },
      .shards =
          [style](const sweep::ShardCounts& shards) {
            const std::string text = report::ShardsText(shards);
            Say(style, text, text, report::ShardsJson(shards));
          },
      .watch_for_stop =
          [] {
            const auto stop = std::make_shared<terminal::StopSignal>();
            return [stop] { return !stop->IsAsked(); };
          },
  };
}

SweepProgress::SweepProgress(ProgressStyle style, const sessions::SweepSize& size)
    : style_(style), counts_{.most = size.most, .is_settings = size.is_settings} {}

SweepProgress::~SweepProgress() {
  const bool is_open = style_ == ProgressStyle::kBar && has_spoken_ && !is_over_;
  if (is_open) terminal::Say("");
}

void SweepProgress::Seen(const sweep::TrialRow& row, bool from_journal) {
  const int before = counts_.steps;
  ++counts_.done;
  if (counts_.is_settings) settings_.insert(row.theta);
  counts_.steps = counts_.is_settings ? static_cast<int>(settings_.size()) : counts_.done;
  counts_.from_journal += from_journal;
  if (from_journal) steps_from_journal_ += counts_.steps - before;
  counts_.falsified += row.falsified;
  counts_.failed += !row.IsOk();
  if (row.IsOk() && row.comparison.gap_m > counts_.largest_gap_m.value_or(-1.0)) {
    counts_.largest_gap_m = row.comparison.gap_m;
  }
}

report::ProgressCounts SweepProgress::Counts() const {
  report::ProgressCounts counts = counts_;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - begun_).count();
  if (elapsed_s > 0.0) counts.trials_per_s = (counts.done - counts.from_journal) / elapsed_s;
  const int steps = counts.steps - steps_from_journal_;
  if (steps > 0 && !is_over_) {
    counts.left_s = std::max(0, counts.most - counts.steps) * elapsed_s / steps;
  }
  return counts;
}

void SweepProgress::Warn(const std::string& line) {
  if (style_ == ProgressStyle::kBar && !is_over_) terminal::SayInPlace("");
  terminal::Say(line);
}

void SweepProgress::Print(const std::string& state) {
  const report::ProgressCounts counts = Counts();
  const std::string text = report::ProgressText(counts);
  Say(style_, fmt::format("{} {}", report::ProgressBar(counts), text),
      fmt::format("{}: {}", state, text), report::ProgressJson(state, counts));
}

bool SweepProgress::IsTime() {
  const Clock::time_point now = Clock::now();
  if (now - printed_ < PeriodOf(style_)) return false;
  printed_ = now;
  has_spoken_ = true;
  return true;
}

void SweepProgress::Tick() {
  if (IsTime()) Print("running");
}

void SweepProgress::Tick(const sweep::ReferenceProgress& references) {
  if (references.arrived == references.seeds) return;
  begun_ = Clock::now();  // of the trials
  if (!IsTime()) return;
  const std::string text = report::ReferencesText(references);
  Say(style_, text, text, report::ReferencesJson(references));
}

void SweepProgress::End(const std::string& state) {
  is_over_ = true;
  if (style_ == ProgressStyle::kLines && !has_spoken_) return;  // too short to be worth a line
  Print(state);
  if (style_ == ProgressStyle::kBar) terminal::Say("");
}

}  // namespace rift::commands
