#include "rift/experiment/ensemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "ensemble_keys.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/statistics/random.hpp"
#include "rift/yaml/bind.hpp"

namespace rift::experiment {
namespace {

constexpr std::uint64_t kEnsembleStream = 90;

void LeaveOut(Ensemble& ensemble, size_t column) {
  const auto at = static_cast<std::ptrdiff_t>(column);
  ensemble.keys.erase(ensemble.keys.begin() + at);
  for (std::vector<double>& draw : ensemble.draws) draw.erase(draw.begin() + at);
}

bool IsInSpace(const Experiment& experiment, const std::string& key) {
  const std::vector<Parameter>& parameters = experiment.space.parameters;
  return std::any_of(parameters.begin(), parameters.end(),
                     [&](const Parameter& parameter) { return parameter.key == key; });
}

Experiment At(const Experiment& experiment, const std::vector<double>& draw,
              const yaml::Origin& origin) {
  std::vector<yaml::KeyValue> values;
  for (size_t i = 0; i < draw.size(); ++i) {
    const std::string& key = experiment.ensemble.keys[i];
    if (IsInSpace(experiment, key)) continue;
    values.push_back(ValueOfKey(key, NumberValue(draw[i]), origin));
  }
  Experiment at = experiment;
  yaml::SetValues(at, values);
  at.ensemble = {};
  return at;
}

}  // namespace

void Ensemble::Check() const {
  for (const std::string& key : keys) {
    if (std::count(keys.begin(), keys.end(), key) > 1) {
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
  const std::vector<yaml::FlatEntry> written = yaml::Flatten(tree);
  for (size_t i = experiment.ensemble.keys.size(); i-- > 0;) {
    const std::string key = experiment.ensemble.keys[i];
    if (!key.starts_with("simulation.") && !key.starts_with("trial.")) {
      throw yaml::Error(fmt::format("{}: ensemble.keys: {} is no key of simulation or trial",
                                    origin.Text(), key));
    }
    const auto own = std::find_if(written.begin(), written.end(),
                                  [&](const yaml::FlatEntry& entry) { return entry.key == key; });
    if (own != written.end() && own->value->origin.source != origin.source) {
      LeaveOut(experiment.ensemble, i);
    }
  }
  if (experiment.ensemble.IsEmpty()) experiment.ensemble = {};
  for (const std::vector<double>& draw : experiment.ensemble.draws) At(experiment, draw, origin);
}

Experiment DrawnAt(const Experiment& experiment, std::uint64_t seed) {
  if (experiment.ensemble.IsEmpty()) return experiment;
  const std::vector<std::vector<double>>& draws = experiment.ensemble.draws;
  return At(experiment, draws[statistics::SeedOfStream(seed, kEnsembleStream) % draws.size()], {});
}

}  // namespace rift::experiment
