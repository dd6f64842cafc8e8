#include "rift/config/experiment.hpp"

#include <filesystem>

#include "rift/config/bind.hpp"
#include "rift/config/sweep_hooks.hpp"
#include "rift/config/tree.hpp"
#include "rift/config/write.hpp"

namespace rift::config {
namespace {

/// A resolved experiment is written into a run folder, so its paths must not depend on where a
/// file or a shell stood.
void MakeAbsolute(sweep::PathTemplate& path) {
  if (path.text.empty()) return;
  path.text = std::filesystem::absolute(path.text).lexically_normal().string();
}

}  // namespace

Experiment LoadExperiment(const std::string& path, const std::vector<std::string>& overrides,
                          const FileReader& read) {
  Node tree = Load(path, read);
  for (const std::string& assignment : overrides) Merge(tree, ParseOverride(assignment));
  Experiment experiment;
  experiment.name = std::filesystem::path(path).stem().string();
  Bind(tree, experiment);
  MakeAbsolute(experiment.candidate.path);
  MakeAbsolute(experiment.reference.path);
  return experiment;
}

std::string WriteExperiment(const Experiment& experiment) { return Emit(ToNode(experiment)); }

}  // namespace rift::config
