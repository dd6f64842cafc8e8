#include "rebuilt_limits.hpp"

#include "rift/yaml/bind.hpp"

namespace rift::commands {
namespace {

/// Parameters of a sweep over logs name columns and parts of file names; some of them are also keys
/// of the controller, and these tell how the log was driven.
control::NavigatorOptions ControllerAt(const experiment::Experiment& experiment,
                                       const experiment::Theta& theta) {
  control::NavigatorOptions control = experiment.control;
  std::vector<yaml::KeyValue> values;
  for (const std::string& key : yaml::ListKeys(control)) {
    for (size_t i = 0; i < theta.size(); ++i) {
      const std::string& name = experiment.space.parameters[i].key;
      const bool is_meant = theta[i].number && (name == key || name == "control." + key);
      if (is_meant) values.push_back({key, yaml::Node::Scalar(theta[i].text)});
    }
  }
  yaml::SetValues(control, values);
  return control;
}

}  // namespace

sweep::Recording WithLimits(sweep::Recording log, const experiment::Experiment& experiment,
                            const experiment::Theta& theta, double tag_offset_m) {
  if (log.status != sweep::TrialStatus::kOk) return log;
  log.limits = sweep::RebuildLimits(log.trajectory, ControllerAt(experiment, theta), tag_offset_m);
  return log;
}

}  // namespace rift::commands
