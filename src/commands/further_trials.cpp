#include "further_trials.hpp"

#include <fmt/format.h>

#include "flags.hpp"
#include "rift/yaml/enum_name.hpp"

namespace rift::commands {
namespace {

/// A value as the table of flags writes it; nothing for one that is the default.
class ChangedFlags {
 public:
  explicit ChangedFlags(std::vector<std::string> defaults) : defaults_(std::move(defaults)) {}

  template <class T>
  static std::string TextOf(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return std::string(yaml::NameOf(value));
    } else {
      return fmt::format("{}", value);
    }
  }

  template <class T>
  void Add(const char* key, const T& value) {
    const std::string text = TextOf(value);
    if (text == defaults_.at(at_++)) return;
    flags_ += " " + FlagName(key).flag;
    if constexpr (!std::is_same_v<T, bool>) flags_ += " " + text;
  }

  const std::string& Text() const { return flags_; }

 private:
  std::vector<std::string> defaults_;
  size_t at_ = 0;
  std::string flags_;
};

}  // namespace

FurtherTrials::FurtherTrials(sweep::Evaluator& evaluator, const Style& style,
                             const StopSignal& stop)
    : style_(style),
      runner_([&evaluator](const sweep::TrialRequest& trial) { return evaluator.Evaluate(trial); },
              [&evaluator](const sweep::TrialRequest& trial) { return evaluator.KeyOf(trial); },
              nullptr, style.jobs, evaluator.experiment().run,
              {[this](const sweep::TrialRow& row, bool from_journal) {
                 if (progress_) progress_->Seen(row, from_journal);
               },
               [this, &stop] {
                 if (progress_) progress_->Tick();
                 return !stop.IsAsked();
               }}) {
  evaluator.LoadLogs();  // workers are copies of what is there when they start
}

std::vector<sweep::TrialRow> FurtherTrials::Run(std::vector<sweep::TrialRequest> requests) {
  std::optional<std::vector<sweep::TrialRow>> rows = runner_.Run(std::move(requests));
  if (!rows) throw Stopped{};
  return *std::move(rows);
}

void FurtherTrials::Begin(int most) { progress_.emplace(style_.progress, SweepSize{.most = most}); }

void FurtherTrials::End() {
  progress_->End("done");
  progress_.reset();
}

std::string ChangedGapFlags(const gap::GapOptions& options) {
  const gap::GapOptions standard;
  std::vector<std::string> defaults;
  gap::GapOptions::Fields(standard, [&](const char*, const auto& value, const auto&...) {
    defaults.push_back(ChangedFlags::TextOf(value));
  });
  ChangedFlags flags(std::move(defaults));
  gap::GapOptions::Fields(
      options, [&](const char* key, const auto& value, const auto&...) { flags.Add(key, value); });
  return flags.Text();
}

}  // namespace rift::commands
