#include "sweep_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace rift::commands {
namespace {

constexpr int kBarWidth = 24;

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

std::string DurationText(double duration_s) {
  const int whole_s = static_cast<int>(duration_s + 0.5);
  if (whole_s < 3600) return fmt::format("{}:{:02}", whole_s / 60, whole_s % 60);
  return fmt::format("{}:{:02}:{:02}", whole_s / 3600, whole_s / 60 % 60, whole_s % 60);
}

std::string BarText(int done, int most) {
  const int full = most > 0 ? static_cast<int>(static_cast<long>(kBarWidth) * done / most) : 0;
  return fmt::format("[{}{}]", std::string(static_cast<size_t>(full), '#'),
                     std::string(static_cast<size_t>(kBarWidth - full), '.'));
}

}  // namespace

ProgressStyle StyleFor(bool quiet, bool json) {
  if (quiet) return ProgressStyle::kQuiet;
  if (json) return ProgressStyle::kJson;
  return ::isatty(2) == 1 ? ProgressStyle::kBar : ProgressStyle::kLines;
}

SweepProgress::SweepProgress(ProgressStyle style, int most, bool is_limit)
    : style_(style), most_(most), is_limit_(is_limit) {}

SweepProgress::~SweepProgress() {
  const bool is_open = style_ == ProgressStyle::kBar && printed_ != begun_ && !is_over_;
  if (is_open) fmt::print(stderr, "\n");
}

void SweepProgress::Seen(const sweep::TrialRow& row, bool from_journal) {
  ++done_;
  most_ = std::max(most_, done_);  // repeats near the threshold come on top
  from_journal_ += from_journal;
  falsified_ += row.falsified;
  failed_ += !row.IsOk();
  if (row.IsOk() && row.comparison.gap_m > largest_gap_m_.value_or(-1.0)) {
    largest_gap_m_ = row.comparison.gap_m;
  }
}

double SweepProgress::Rate() const {
  const std::chrono::duration<double> since = Clock::now() - begun_;
  return since.count() > 0.0 ? (done_ - from_journal_) / since.count() : 0.0;
}

std::optional<double> SweepProgress::Left_s() const {
  const double rate = Rate();
  if (rate <= 0.0) return std::nullopt;
  return (most_ - done_) / rate;
}

std::string SweepProgress::Text() const {
  std::string text = fmt::format("{}/{} trials, {:.1f}/s", done_, most_, Rate());
  const std::optional<double> left_s = Left_s();
  if (left_s && !is_over_) {
    text += fmt::format(", {}{} left", is_limit_ ? "at most " : "", DurationText(*left_s));
  }
  if (largest_gap_m_) text += fmt::format(", largest gap {:.4f} m", *largest_gap_m_);
  return text + fmt::format(", {} falsified, {} failed", falsified_, failed_);
}

void SweepProgress::Print(const std::string& state) {
  switch (style_) {
    case ProgressStyle::kQuiet:
      return;
    case ProgressStyle::kBar:
      fmt::print(stderr, "\r\x1b[K{} {}", BarText(done_, most_), Text());
      break;
    case ProgressStyle::kLines:
      fmt::print(stderr, "{}: {}\n", state, Text());
      break;
    case ProgressStyle::kJson: {
      nlohmann::ordered_json json{{"state", state},           {"done", done_},
                                  {"total", most_},           {"from_journal", from_journal_},
                                  {"trials_per_s", Rate()},   {"left_s", nullptr},
                                  {"largest_gap_m", nullptr}, {"falsified", falsified_},
                                  {"failed", failed_}};
      if (Left_s() && !is_over_) json["left_s"] = *Left_s();
      if (largest_gap_m_) json["largest_gap_m"] = *largest_gap_m_;
      fmt::print(stderr, "{}\n", json.dump());
      break;
    }
  }
  std::fflush(stderr);
}

void SweepProgress::Tick() {
  const Clock::time_point now = Clock::now();
  if (now - printed_ < PeriodOf(style_)) return;
  printed_ = now;
  Print("running");
}

void SweepProgress::End(const std::string& state) {
  const bool has_spoken = printed_ != begun_;
  is_over_ = true;
  if (style_ == ProgressStyle::kLines && !has_spoken) return;  // too short to be worth a line
  Print(state);
  if (style_ == ProgressStyle::kBar) fmt::print(stderr, "\n");
}

}  // namespace rift::commands
