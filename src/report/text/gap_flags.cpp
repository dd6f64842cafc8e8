#include "rift/report/text/gap_flags.hpp"

#include <fmt/format.h>

#include <vector>

#include "rift/files/shell_word.hpp"
#include "rift/yaml/enum_name.hpp"
#include "rift/yaml/flag_name.hpp"

namespace rift::report {
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
    flags_ += " " + yaml::FlagName(key).flag;
    if constexpr (!std::is_same_v<T, bool>) flags_ += " " + text;
  }

  const std::string& Text() const { return flags_; }

 private:
  std::vector<std::string> defaults_;
  size_t at_ = 0;
  std::string flags_;
};

/// Those of the gap's options that are not the defaults, as flags of `rift gap`.
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

}  // namespace

std::string GapFlags(const experiment::Experiment& experiment) {
  if (experiment.candidate.kind != experiment::CandidateKind::kLogs) return "";
  if (experiment.reference.kind != experiment::ReferenceKind::kLogs) return "";
  std::string flags;
  const auto add = [&flags](const std::string& flag, const std::string& value) {
    flags += fmt::format(" {} {}", flag, value);
  };
  add("--sim-format", std::string(yaml::NameOf(experiment.candidate.format)));
  add("--real-format", std::string(yaml::NameOf(experiment.reference.format)));
  const auto add_text = [&](const std::string& flag, const std::string& value) {
    if (!value.empty()) add(flag, files::ShellQuoted(value));
  };
  add_text("--sim-columns", experiment.candidate.columns);
  add_text("--sim-units", experiment.candidate.units);
  add_text("--real-columns", experiment.reference.columns);
  add_text("--real-units", experiment.reference.units);
  if (experiment.reference.tag_offset_m != 0.0) {
    add("--tag-offset", fmt::format("{}", experiment.reference.tag_offset_m));
  }
  return flags + ChangedGapFlags(experiment.gap);
}

}  // namespace rift::report
