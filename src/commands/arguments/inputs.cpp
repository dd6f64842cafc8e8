#include "rift/commands/arguments/inputs.hpp"

#include "rift/files/files.hpp"
#include "rift/terminal/print.hpp"

namespace rift::commands {

experiment::Experiment ReadExperiment(const std::filesystem::path& file,
                                      const std::vector<std::string>& overrides) {
  return experiment::LoadExperiment(file.string(), overrides,
                                    [](const std::string& path) { return files::ReadFile(path); });
}

vision::TagOptions TagOn(const experiment::Experiment& experiment) {
  vision::TagOptions tag = experiment.track.tag;
  const auto& terrain = experiment.simulation.terrain;
  const auto surface = terrain.surfaces.find(terrain.surface);
  if (tag.ground != vision::Ground::kFlat || surface == terrain.surfaces.end()) return tag;
  const simulation::Shape shape = surface->second.shape;
  if (shape == simulation::Shape::kBumps) tag.ground = vision::Ground::kBumps;
  const bool is_sloped = shape != simulation::Shape::kFlat && shape != simulation::Shape::kBumps;
  if (is_sloped) tag.ground = vision::Ground::kFree;
  return tag;
}

sweep::Inputs FileInputs() {
  return {[](const std::string& path) { return files::ReadIfThere(path); },
          [](const std::string& line) { terminal::Say("note: " + line); }};
}

}  // namespace rift::commands
