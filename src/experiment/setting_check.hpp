#pragma once

#include <map>
#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::experiment {

/// Tries settings of an experiment against its rules. They are set in place, one after the other:
/// a copy for each of 100 000 values, with all of them in it, would take hours.
class SettingCheck {
 public:
  explicit SettingCheck(const Experiment& experiment);

  /// Throws Error where yaml::SetValues of the experiment would. Values of an earlier try are gone.
  void Try(const std::vector<yaml::KeyValue>& values);
  /// The same of a value alone, against the range of its key and none of the rules between keys.
  void TryAlone(const yaml::KeyValue& value);

 private:
  void SetBack();
  void KeepOwn(const std::string& key);
  void Set(const yaml::KeyValue& value, bool check_rules);

  Experiment tried_;
  std::vector<std::string> keys_;
  yaml::Binder binder_;
  std::map<std::string, yaml::KeyValue> own_;  ///< the experiment's values of keys that were tried
  std::vector<std::string> changed_;           ///< keys that the last try set
};

/// A setting as values of the keys of its parameters.
std::vector<yaml::KeyValue> ValuesAt(const std::vector<Parameter>& parameters, const Theta& theta);

/// Throws Error for a setting of a small grid that breaks a rule. Of a large one, and of ranges,
/// every value is tried once; a setting that still breaks a rule becomes a row that says so.
void TrySpace(const Experiment& experiment);

/// Throws Error for a fitted parameter that has no fractions, and for an end of its range that
/// breaks a rule whatever the others are.
void TryFit(const Experiment& experiment);

}  // namespace rift::experiment
