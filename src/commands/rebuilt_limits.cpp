#include "rebuilt_limits.hpp"

#include "rift/config/set_value.hpp"

namespace rift::commands {
namespace {

/// Parameters of a sweep over logs name columns and parts of file names; some of them are also keys
/// of the controller, and these tell how the log was driven.
control::NavigatorOptions ControllerAt(const config::Experiment& experiment,
                                       const sweep::Theta& theta) {
  control::NavigatorOptions control = experiment.control;
  std::vector<config::KeyValue> values;
  for (const std::string& key : config::ListKeys(control)) {
    for (size_t i = 0; i < theta.size(); ++i) {
      const std::string& name = experiment.space.parameters[i].key;
      const bool is_meant = theta[i].number && (name == key || name == "control." + key);
      if (is_meant) values.push_back({key, config::Node::Scalar(theta[i].text)});
    }
  }
  config::SetValues(control, values);
  return control;
}

}  // namespace

sweep::Recording WithLimits(sweep::Recording log, const config::Experiment& experiment,
                            const sweep::Theta& theta, double tag_offset_m) {
  if (log.status != sweep::TrialStatus::kOk) return log;
  log.limits = sweep::RebuildLimits(log.trajectory, ControllerAt(experiment, theta), tag_offset_m);
  return log;
}

}  // namespace rift::commands
