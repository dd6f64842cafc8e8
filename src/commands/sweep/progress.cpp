#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"

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
  const int full =
      most > 0 ? static_cast<int>(static_cast<long>(kBarWidth) * std::min(done, most) / most) : 0;
  return fmt::format("[{}{}]", std::string(static_cast<size_t>(full), '#'),
                     std::string(static_cast<size_t>(kBarWidth - full), '.'));
}

std::string ReferenceText(const sweep::ReferenceProgress& references) {
  std::string text =
      fmt::format("references: {} of {} nominal runs", references.arrived, references.seeds);
  if (references.others_tried > 0) {
    text += fmt::format(", {} other seeds tried for those that did not arrive",
                        references.others_tried);
  }
  if (references.last_failure.empty()) return text;
  return text + fmt::format(" (last: {})", references.last_failure);
}

}  // namespace

ProgressStyle StyleFor(bool quiet, bool json) {
  if (quiet) return ProgressStyle::kQuiet;
  if (json) return ProgressStyle::kJson;
  return ::isatty(2) == 1 ? ProgressStyle::kBar : ProgressStyle::kLines;
}

SweepProgress::SweepProgress(ProgressStyle style, const sessions::SweepSize& size)
    : style_(style), size_(size) {}

SweepProgress::~SweepProgress() {
  const bool is_open = style_ == ProgressStyle::kBar && has_spoken_ && !is_over_;
  if (is_open) terminal::Say("");
}

void SweepProgress::Seen(const sweep::TrialRow& row, bool from_journal) {
  const int before = Steps();
  ++done_;
  if (size_.is_settings) settings_.insert(row.theta);
  from_journal_ += from_journal;
  if (from_journal) steps_from_journal_ += Steps() - before;
  falsified_ += row.falsified;
  failed_ += !row.IsOk();
  if (row.IsOk() && row.comparison.gap_m > largest_gap_m_.value_or(-1.0)) {
    largest_gap_m_ = row.comparison.gap_m;
  }
}

int SweepProgress::Steps() const {
  return size_.is_settings ? static_cast<int>(settings_.size()) : done_;
}

double SweepProgress::Elapsed_s() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

double SweepProgress::Rate() const {
  const double elapsed_s = Elapsed_s();
  return elapsed_s > 0.0 ? (done_ - from_journal_) / elapsed_s : 0.0;
}

std::optional<double> SweepProgress::Left_s() const {
  const int steps = Steps() - steps_from_journal_;
  if (steps <= 0 || is_over_) return std::nullopt;
  return std::max(0, size_.most - Steps()) * Elapsed_s() / steps;
}

std::string SweepProgress::Text() const {
  std::string text =
      size_.is_settings
          ? fmt::format("{}/{} settings, {} trials, {:.1f}/s", Steps(), size_.most, done_, Rate())
          : fmt::format("{}/{} trials, {:.1f}/s", done_, size_.most, Rate());
  if (const std::optional<double> left_s = Left_s()) {
    text += fmt::format(", {}{} left", size_.is_settings ? "at most " : "", DurationText(*left_s));
  }
  if (largest_gap_m_) text += fmt::format(", largest gap {:.4f} m", *largest_gap_m_);
  return text + fmt::format(", {} failing, {} without gap", falsified_, failed_);
}

void SweepProgress::Warn(const std::string& line) {
  if (style_ == ProgressStyle::kBar && !is_over_) terminal::SayInPlace("");
  terminal::Say(line);
}

void SweepProgress::Print(const std::string& state) {
  switch (style_) {
    case ProgressStyle::kQuiet:
      return;
    case ProgressStyle::kBar:
      terminal::SayInPlace(fmt::format("{} {}", BarText(Steps(), size_.most), Text()));
      break;
    case ProgressStyle::kLines:
      terminal::Say(fmt::format("{}: {}", state, Text()));
      break;
    case ProgressStyle::kJson: {
      nlohmann::ordered_json json{
          {"state", state},          {"done", done_},     {"from_journal", from_journal_},
          {"trials_per_s", Rate()},  {"left_s", nullptr}, {"largest_gap_m", nullptr},
          {"falsified", falsified_}, {"failed", failed_}};
      json[size_.is_settings ? "most_settings" : "total"] = size_.most;
      if (size_.is_settings) json["settings"] = Steps();
      if (const std::optional<double> left_s = Left_s()) json["left_s"] = *left_s;
      if (largest_gap_m_) json["largest_gap_m"] = *largest_gap_m_;
      terminal::Say(json.dump());
      break;
    }
  }
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
  if (style_ == ProgressStyle::kJson) {
    return terminal::Say(nlohmann::ordered_json{
        {"state", "references"},
        {"references", references.seeds},
        {"references_done",
         references.arrived}}.dump());
  }
  const std::string text = ReferenceText(references);
  if (style_ == ProgressStyle::kBar) terminal::SayInPlace(text);
  if (style_ == ProgressStyle::kLines) terminal::Say(text);
}

void SweepProgress::End(const std::string& state) {
  is_over_ = true;
  if (style_ == ProgressStyle::kLines && !has_spoken_) return;  // too short to be worth a line
  Print(state);
  if (style_ == ProgressStyle::kBar) terminal::Say("");
}

namespace {

void SayShards(ProgressStyle style, const sweep::ShardCounts& counts) {
  std::string text = fmt::format("slurm: {}/{} shards done, {} running, {} pending", counts.done,
                                 counts.total, counts.running, counts.pending);
  if (!counts.reason.empty()) text += fmt::format(" ({})", counts.reason);
  switch (style) {
    case ProgressStyle::kQuiet:
      return;
    case ProgressStyle::kBar:
      return terminal::SayInPlace(text);
    case ProgressStyle::kLines:
      return terminal::Say(text);
    case ProgressStyle::kJson:
      return terminal::Say(nlohmann::ordered_json{
          {"state", "running"},
          {"shards", counts.total},
          {"shards_done", counts.done},
          {"shards_running", counts.running},
          {"shards_pending",
           counts.pending}}.dump());
  }
}

}  // namespace

sessions::SweepObserver ObserverFor(ProgressStyle style) {
  return {
      .say = [](const std::string& line) { terminal::Say(line); },
      .begin =
          [style](const sessions::SweepSize& size) {
            return std::make_unique<SweepProgress>(style, size);
          },
      .shards = [style](const sweep::ShardCounts& counts) { SayShards(style, counts); },
      .watch_for_stop =
          [] {
            const auto stop = std::make_shared<terminal::StopSignal>();
            return [stop] { return !stop->IsAsked(); };
          },
  };
}

}  // namespace rift::commands
