#include "rift/sessions/sweep/suggested.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rift/experiment/space_yaml.hpp"
#include "rift/files/files.hpp"
#include "rift/yaml/load.hpp"
#include "rift/yaml/write.hpp"

namespace rift::sessions {
namespace {

namespace fs = std::filesystem;
using yaml::Node;

constexpr const char* kHead =
    "# Experiments on the robot, the best first: rift drive --suggested DIR drives them, and the\n"
    "# command that made this file takes their logs in. May be edited before the first drive.\n";

Node NodeOf(const SuggestedExperiment& experiment) {
  Node node = Node::Map(), set = Node::Map();
  for (size_t i = 0; i < experiment.values.size(); ++i) {
    set.Add(experiment.parameters[i].key, experiment::ValueToNode(experiment.values[i]));
  }
  node.Add("set", std::move(set));
  node.Add("repeats", Node::Scalar(fmt::format("{}", experiment.repeats)));
  node.Add("predicted", Node::Text(experiment.is_predicted_to_fail ? "fails" : "holds"));
  if (!experiment.why.empty()) node.Add("why", Node::Text(experiment.why));
  return node;
}

const Node& Required(const Node& node, const std::string& key) {
  if (!node.IsMap()) yaml::Fail(node, "experiments", "must be a list of {set, repeats, predicted}");
  const Node::Entry* entry = node.Find(key);
  if (entry == nullptr)
    yaml::Fail(node, key, "is missing: each experiment has set, repeats and predicted");
  return entry->value;
}

/// In the order of the space, however the file has it: settings are compared value by value.
void ReadSet(const Node& node, const experiment::Experiment& experiment,
             SuggestedExperiment& suggested) {
  const std::vector<experiment::Parameter>& parameters = experiment.space.parameters;
  const std::vector<yaml::FlatEntry> set = yaml::Flatten(node);
  for (const yaml::FlatEntry& entry : set) {
    const bool is_varied = std::any_of(parameters.begin(), parameters.end(),
                                       [&](const auto& one) { return one.key == entry.key; });
    if (!is_varied) yaml::Fail(*entry.value, entry.key, "is no parameter of the sweep's space");
  }
  for (const experiment::Parameter& parameter : parameters) {
    const auto entry = std::find_if(set.begin(), set.end(), [&](const yaml::FlatEntry& one) {
      return one.key == parameter.key;
    });
    if (entry == set.end()) continue;
    suggested.parameters.push_back(parameter);
    const experiment::ParameterValue value = experiment::ValueFromNode(*entry->value, entry->key);
    suggested.values.push_back(experiment::ParseValue(parameter, value.text));
  }
}

SuggestedExperiment ExperimentFrom(const Node& node, const experiment::Experiment& experiment,
                                   int number) {
  SuggestedExperiment suggested{.number = number};
  ReadSet(Required(node, "set"), experiment, suggested);
  const std::optional<double> repeats = yaml::NumberOf(Required(node, "repeats"));
  const bool is_count =
      repeats && *repeats >= 1 && *repeats <= 1000 && *repeats == std::floor(*repeats);
  if (!is_count)
    yaml::Fail(Required(node, "repeats"), "repeats", "must be a whole number from 1 to 1000");
  suggested.repeats = static_cast<int>(*repeats);
  const Node& predicted = Required(node, "predicted");
  if (predicted.text != "fails" && predicted.text != "holds") {
    yaml::Fail(predicted, "predicted", "must be fails or holds");
  }
  suggested.is_predicted_to_fail = predicted.text == "fails";
  if (const Node::Entry* why = node.Find("why")) suggested.why = why->value.text;
  return suggested;
}

}  // namespace

fs::path SuggestedFile(const fs::path& sweep) { return sweep / "suggested.yaml"; }

fs::path SuggestedFolder(const fs::path& sweep) { return sweep / "suggested"; }

fs::path SuggestedDrive(const fs::path& sweep, int number, int trial) {
  return SuggestedFolder(sweep) / fmt::format("{}_{}", number, trial);
}

std::string WriteSuggested(const std::vector<SuggestedExperiment>& experiments) {
  Node list = Node::List();
  for (const SuggestedExperiment& experiment : experiments)
    list.items.push_back(NodeOf(experiment));
  Node file = Node::Map();
  file.Add("experiments", std::move(list));
  return kHead + yaml::Emit(file);
}

std::vector<SuggestedExperiment> ReadSuggested(const fs::path& sweep,
                                               const experiment::Experiment& experiment) {
  const fs::path file = SuggestedFile(sweep);
  const std::optional<std::string> text = files::ReadIfThere(file);
  if (!text) return {};
  const Node tree = yaml::Parse(*text, file.string());
  const Node::Entry* list = tree.IsMap() ? tree.Find("experiments") : nullptr;
  if (list == nullptr || !list->value.IsList()) {
    yaml::Fail(tree, "experiments", "must be a list of {set, repeats, predicted}");
  }
  std::vector<SuggestedExperiment> experiments;
  for (const Node& item : list->value.items) {
    experiments.push_back(
        ExperimentFrom(item, experiment, static_cast<int>(experiments.size()) + 1));
  }
  return experiments;
}

}  // namespace rift::sessions
