#include "setting_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "rift/experiment/space_yaml.hpp"
#include "rift/yaml/describe.hpp"
#include "rift/yaml/node.hpp"

namespace rift::experiment {
namespace {

/// Values to try a parameter with: its levels, or the ends of its range.
std::vector<ParameterValue> ValuesToTry(const Parameter& parameter) {
  if (!parameter.IsContinuous()) return parameter.levels;
  return {NumberValue(parameter.min), NumberValue(parameter.max)};
}

/// A rule between keys, such as v_min <= v_max, is broken for good only when no other values of
/// the other parameters keep it: those of the experiment, their first and their last are tried.
class ValueCheck {
 public:
  /// `parameters` must outlive the check.
  ValueCheck(const Experiment& experiment, const std::vector<Parameter>& parameters)
      : parameters_(parameters), check_(experiment) {
    for (const Parameter& parameter : parameters_) {
      const std::vector<ParameterValue> values = ValuesToTry(parameter);
      first_.push_back(values.front());
      last_.push_back(values.back());
    }
  }

  /// Throws Error for a value that breaks a rule whatever the others are.
  void Try(size_t parameter, const ParameterValue& value) {
    const Parameter& own = parameters_[parameter];
    try {
      check_.Try({ValueOfKey(own.key, value, {own.origin})});
    } catch (const yaml::Error&) {
      if (!IsRightAmong(first_, parameter, value) && !IsRightAmong(last_, parameter, value)) throw;
    }
  }

 private:
  bool IsRightAmong(Theta others, size_t parameter, const ParameterValue& value) {
    others[parameter] = value;
    try {
      check_.Try(ValuesAt(parameters_, others));
    } catch (const yaml::Error&) {  // what is wrong with the value alone is told
      return false;
    }
    return true;
  }

  const std::vector<Parameter>& parameters_;
  SettingCheck check_;
  Theta first_, last_;
};

}  // namespace

SettingCheck::SettingCheck(const Experiment& experiment)
    : tried_(experiment), keys_(yaml::ListKeys(experiment)), binder_(keys_) {}

void SettingCheck::Try(const std::vector<yaml::KeyValue>& values) {
  SetBack();
  for (const yaml::KeyValue& value : values) KeepOwn(value.key);
  for (const bool check_rules : {false, true}) {
    for (const yaml::KeyValue& value : values) Set(value, check_rules);
  }
}

void SettingCheck::TryAlone(const yaml::KeyValue& value) {
  SetBack();
  KeepOwn(value.key);
  Set(value, false);
}

void SettingCheck::SetBack() {
  for (const std::string& key : std::exchange(changed_, {})) Set(own_.at(key), false);
}

/// A key that is unknown is left to Set, which says so.
void SettingCheck::KeepOwn(const std::string& key) {
  if (!own_.contains(key)) {
    if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) return;
    own_[key] = {key, yaml::GetValue(tried_, key)};
  }
  changed_.push_back(key);
}

void SettingCheck::Set(const yaml::KeyValue& value, bool check_rules) {
  const bool is_set =
      yaml::Setter(binder_, value.key, value.value, check_rules).IntoBlock(tried_, "");
  if (is_set) return;
  yaml::Fail(value.value, value.key, "no such key; " + yaml::KeyHint(value.key, keys_));
}

std::vector<yaml::KeyValue> ValuesAt(const std::vector<Parameter>& parameters, const Theta& theta) {
  std::vector<yaml::KeyValue> values;
  for (size_t i = 0; i < theta.size(); ++i) {
    values.push_back(ValueOfKey(parameters[i].key, theta[i], {parameters[i].origin}));
  }
  return values;
}

void TrySpace(const Experiment& experiment) {
  constexpr double kMostTried = 2000;
  const std::vector<Parameter>& parameters = experiment.space.parameters;
  double settings = 1.0;
  for (const Parameter& parameter : parameters) {
    settings *= parameter.IsContinuous() ? HUGE_VAL : static_cast<double>(parameter.levels.size());
  }
  if (experiment.goal != Goal::kFalsify && settings <= kMostTried) {
    SettingCheck check(experiment);
    for (const Theta& theta : GridPoints(parameters)) check.Try(ValuesAt(parameters, theta));
    return;
  }
  ValueCheck check(experiment, parameters);
  for (size_t i = 0; i < parameters.size(); ++i) {
    for (const ParameterValue& value : ValuesToTry(parameters[i])) check.Try(i, value);
  }
}

void TryFit(const Experiment& experiment) {
  constexpr double kInside = 0.38196601125;  // of a range; no whole number of a range of those
  std::vector<Parameter> parameters;
  for (const FreeParameter& free : experiment.calibrate.fit.list) {
    parameters.push_back(
        {.key = free.key, .min = free.min, .max = free.max, .origin = free.origin});
  }
  ValueCheck ends(experiment, parameters);
  SettingCheck inside(experiment);
  for (size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& one = parameters[i];
    for (const ParameterValue& value : ValuesToTry(one)) ends.Try(i, value);
    const double fraction = one.min + kInside * (one.max - one.min);
    try {
      inside.TryAlone(ValueOfKey(one.key, NumberValue(fraction), {one.origin}));
    } catch (const yaml::Error&) {
      throw yaml::Error(fmt::format(
          "{}: calibrate.fit: {} is a whole number, and only a key that may have a fraction can be "
          "fitted: leave it out, or compare its values in a sweep (goal: grid)",
          one.origin, one.key));
    }
  }
}

}  // namespace rift::experiment
