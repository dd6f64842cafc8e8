#include "further_trials.hpp"

#include <fmt/format.h>

#include <charconv>

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

FurtherTrials::FurtherTrials(SweepSources& sources, const experiment::Experiment& experiment,
                             const Style& style, const StopSignal& stop)
    : plan_(sources.Plan()),
      style_(style),
      runner_([&sources](const sweep::TrialRequest& trial) { return sources.Evaluate(trial); },
              [&sources](const sweep::TrialRequest& trial) { return sources.KeyOf(trial); },
              nullptr, style.jobs, experiment.run,
              {[this](const sweep::TrialRow& row, bool from_journal) {
                 if (progress_) progress_->Seen(row, from_journal);
               },
               [this, &stop] {
                 if (progress_) progress_->Tick();
                 return !stop.IsAsked();
               }}) {
  sources.LoadLogs();  // workers are copies of what is there when they start
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

experiment::Theta NominalTheta(const experiment::Experiment& experiment) {
  const std::map<std::string, std::string> values = experiment::FlatValues(experiment);
  experiment::Theta theta;
  for (const experiment::Parameter& parameter : experiment.space.parameters) {
    const std::string& text = values.at(parameter.key);
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_number =
        !parameter.IsCategorical() && error == std::errc{} && end == text.data() + text.size();
    theta.push_back({text, is_number ? std::optional(number) : std::nullopt});
  }
  return theta;
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
