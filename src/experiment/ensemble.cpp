#include "rift/experiment/ensemble.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <stdexcept>
#include <string_view>

#include "ensemble_keys.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/statistics/random.hpp"
#include "rift/yaml/bind.hpp"
#include "setting_check.hpp"

namespace rift::experiment {
namespace {

constexpr std::uint64_t kEnsembleStream = 90;

void LeaveOut(Ensemble& ensemble, size_t column) {
  const auto at = static_cast<std::ptrdiff_t>(column);
  ensemble.keys.erase(ensemble.keys.begin() + at);
  for (std::vector<double>& draw : ensemble.draws) draw.erase(draw.begin() + at);
}

std::set<std::string_view> KeysOf(const Space& space) {
  std::set<std::string_view> keys;
  for (const Parameter& parameter : space.parameters) keys.insert(parameter.key);
  return keys;
}

/// What a draw sets: a key of the space keeps the value of the space.
std::vector<yaml::KeyValue> ValuesOf(const Ensemble& ensemble, const std::vector<double>& draw,
                                     const std::set<std::string_view>& in_space,
                                     const yaml::Origin& origin) {
  std::vector<yaml::KeyValue> values;
  for (size_t i = 0; i < draw.size(); ++i) {
    const std::string& key = ensemble.keys[i];
    if (!in_space.contains(key)) values.push_back(ValueOfKey(key, NumberValue(draw[i]), origin));
  }
  return values;
}

}  // namespace

void Ensemble::Check() const {
  std::set<std::string_view> seen;
  for (const std::string& key : keys) {
    if (!seen.insert(key).second) {
      throw std::invalid_argument(fmt::format("keys: {} stands there twice", key));
    }
  }
  if (keys.empty() != draws.empty()) {
    throw std::invalid_argument("keys and draws go together: give both, or neither");
  }
  for (size_t i = 0; i < draws.size(); ++i) {
    if (draws[i].size() == keys.size()) continue;
    throw std::invalid_argument(fmt::format("draws[{}] has {} values, but there are {} keys", i,
                                            draws[i].size(), keys.size()));
  }
}

void ResolveEnsemble(Experiment& experiment, const yaml::Node& tree) {
  if (experiment.ensemble.IsEmpty()) return;
  const yaml::Node::Entry* block = tree.Find("ensemble");
  const yaml::Origin origin = block->value.Find("draws")->value.origin;
  const std::vector<yaml::FlatEntry> entries = yaml::Flatten(tree);
  std::map<std::string_view, const yaml::Node*> written;
  for (const yaml::FlatEntry& entry : entries) written[entry.key] = entry.value;
  for (size_t i = experiment.ensemble.keys.size(); i-- > 0;) {
    const std::string key = experiment.ensemble.keys[i];
    if (!key.starts_with("simulation.") && !key.starts_with("trial.")) {
      throw yaml::Error(fmt::format("{}: ensemble.keys: {} is no key of simulation or trial",
                                    origin.Text(), key));
    }
    const auto own = written.find(key);
    if (own != written.end() && own->second->origin.source != origin.source) {
      LeaveOut(experiment.ensemble, i);
    }
  }
  if (experiment.ensemble.IsEmpty()) experiment.ensemble = {};
  SettingCheck check(experiment);
  const std::set<std::string_view> in_space = KeysOf(experiment.space);
  for (const std::vector<double>& draw : experiment.ensemble.draws) {
    check.Try(ValuesOf(experiment.ensemble, draw, in_space, origin));
  }
}

Experiment DrawnAt(const Experiment& experiment, std::uint64_t seed) {
  if (experiment.ensemble.IsEmpty()) return experiment;
  const std::vector<std::vector<double>>& draws = experiment.ensemble.draws;
  const size_t taken = statistics::SeedOfStream(seed, kEnsembleStream) % draws.size();
  Experiment at = experiment;
  at.ensemble = {};
  yaml::SetValues(at, ValuesOf(experiment.ensemble, draws[taken], KeysOf(at.space), {}));
  return at;
}

}  // namespace rift::experiment
