#include "rift/sweep/falsify/labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace rift::sweep {

FactorSplit SplitFactors(const std::vector<experiment::Parameter>& parameters) {
  if (parameters.empty()) throw std::invalid_argument("the space has no parameters");
  const auto categorical = std::find_if(
      parameters.begin(), parameters.end(),
      [](const experiment::Parameter& parameter) { return parameter.IsCategorical(); });
  FactorSplit split;
  if (categorical != parameters.end()) {
    split.main_factor = static_cast<int>(categorical - parameters.begin());
  }
  for (int i = 0; i < static_cast<int>(parameters.size()); ++i) {
    if (i == split.main_factor) continue;
    split.others.push_back(i);
    split.others_name += (split.others_name.empty() ? "" : ", ") + parameters[i].Name();
  }
  if (split.others.size() > 1) split.others_name = "[" + split.others_name + "]";
  return split;
}

std::string ShortText(const experiment::Parameter& parameter,
                      const experiment::ParameterValue& value) {
  const bool is_drawn = parameter.IsContinuous() && value.number;
  return is_drawn ? fmt::format("{:.4g}", *value.number) : value.text;
}

std::string SettingText(const std::vector<experiment::Parameter>& parameters,
                        const experiment::Theta& theta) {
  std::string text;
  for (size_t i = 0; i < parameters.size(); ++i) {
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", parameters[i].Name(),
                        ShortText(parameters[i], theta[i]));
  }
  return text.empty() ? "the only setting" : text;
}

std::string CombinationLabel(const experiment::Theta& theta, const std::vector<int>& parameters) {
  if (parameters.size() == 1) return theta[parameters.front()].text;
  std::string label;
  for (const int i : parameters) label += (label.empty() ? "" : ", ") + theta[i].text;
  return "[" + label + "]";
}

std::string MainLevel(const std::vector<experiment::Parameter>& parameters,
                      const experiment::Theta& theta) {
  return parameters.empty() ? "" : theta[SplitFactors(parameters).main_factor].text;
}

std::string SettingKey(const experiment::Theta& theta) {
  std::string key;
  for (const experiment::ParameterValue& value : theta) key += value.text + '\n';
  return key;
}

}  // namespace rift::sweep
