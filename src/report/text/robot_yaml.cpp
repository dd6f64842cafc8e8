#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "rift/report/text/text.hpp"
#include "rift/sweep/calibrate/ensemble.hpp"
#include "rift/yaml/node.hpp"
#include "rift/yaml/write.hpp"

namespace rift::report {
namespace {

using sweep::CalibratedParameter;
using yaml::Node;

std::string CommentOf(const CalibratedParameter& p, double confidence) {
  const std::string flag = FlagOf(p);
  if (!p.has_effect && !p.is_from_prior) {
    // A fit may have come here by a step that the logs answered, to where they answer none.
    return p.value == p.parameter.start
               ? "kept: the logs do not depend on it"
               : fmt::format("from {:.4g}; not told: here the logs do not depend on it",
                             p.parameter.start);
  }
  return fmt::format("fitted, {:.0f} % interval {:.4g} to {:.4g}, from {:.4g}{}{}",
                     100.0 * confidence, p.low, p.high, p.parameter.start, flag.empty() ? "" : "; ",
                     flag);
}

/// The entries of `node` that differ from those of `standard`, or were fitted.
Node Different(const Node& node, const Node& standard, const std::string& path,
               const std::map<std::string, std::string>& fitted) {
  Node kept = Node::Map();
  for (const Node::Entry& entry : node.entries) {
    const std::string key = yaml::Join(path, entry.key);
    if (key == "simulation.terrain.surface") continue;  // of the trial, not of the robot
    const Node::Entry* other = standard.Find(entry.key);
    const auto comment = fitted.find(key);
    if (entry.value.IsMap() && other != nullptr) {
      const Node inner = Different(entry.value, other->value, key, fitted);
      if (!inner.entries.empty()) kept.Add(entry.key, inner);
    } else if (comment != fitted.end() || other == nullptr ||
               yaml::Emit(entry.value) != yaml::Emit(other->value)) {
      kept.Add(entry.key, entry.value);
      if (comment != fitted.end()) kept.entries.back().comment = comment->second;
    }
  }
  return kept;
}

std::string Indented(const std::string& lines) {
  std::istringstream in(lines);
  std::string text, line;
  while (std::getline(in, line)) text += "#   " + line + '\n';
  return text;
}

/// What made estimate and intervals in the end.
std::string LastPartText(const sweep::CalibrationOptions& method) {
  if (method.features.rounds == 0) return "intervals: bootstrap over the logs";
  return fmt::format(
      "then features of whole drives,\n# {} rounds of {} draws; intervals: posterior",
      method.features.rounds, method.features.draws);
}

std::string Head(const experiment::Experiment& experiment, const sweep::CalibrationReport& report,
                 const std::string& inputs, const std::string& experiment_file, bool has_ensemble) {
  const sweep::Calibration& fit = report.calibration;
  size_t held = 0;
  for (const sweep::CalibrationTrial& trial : report.trials) held += trial.is_held_out;
  std::string text = fmt::format(
      "# Written by rift sweep {} --write-robot (rift {}), goal: calibrate.\n"
      "# How: short-horizon prediction (1 to {} frames) and weave, spread, speed, loop "
      "delay and\n"
      "# steering gain of whole runs (Levenberg-Marquardt, {} steps{}); {}.\n"
      "# {} logs fitted, {} held out; loss {:.4f} before, {:.4f} after.\n",
      std::filesystem::path(experiment_file).filename().string(), RIFT_VERSION,
      experiment.calibrate.method.horizon.most_frames, fit.steps,
      fit.has_converged ? "" : ", not converged", LastPartText(experiment.calibrate.method),
      report.trials.size() - held, held, fit.loss_before, fit.loss_after);
  for (const sweep::JudgedGroup& group : report.judged) {
    if (group.level != "all") continue;
    text += fmt::format(
        "# {}: mean simulated path {:.1f} mm from the real ones before, {:.1f} mm after.\n",
        group.side, 1e3 * group.before.path.mean_path_gap_m,
        1e3 * group.after.path.mean_path_gap_m);
  }
  text +=
      "# Keys of trial and simulation alone: include it after the robot's own file, whose control\n"
      "# and hardware stay in force.\n";
  if (has_ensemble) {
    text +=
        "# Each run takes a draw of the ensemble in place of the values of its keys: a value "
        "that is\n"
        "# changed in this file counts once its key is no longer in ensemble.\n";
  }
  text += "# Logs (hash, file; those held out are among them):\n";
  std::string names;
  std::istringstream lines(inputs);
  for (std::string line; std::getline(lines, line);) {
    const size_t blank = line.find("  ");
    if (blank == std::string::npos) continue;
    const std::filesystem::path path = line.substr(blank + 2);
    names += fmt::format("{}  {}/{}\n", line.substr(0, blank),
                         path.parent_path().filename().string(), path.filename().string());
  }
  return text + Indented(names);
}

}  // namespace

std::string RobotYaml(const experiment::Experiment& experiment,
                      const sweep::CalibrationReport& report, const std::string& inputs,
                      const std::string& experiment_file) {
  std::map<std::string, std::string> fitted;
  for (const CalibratedParameter& p : report.calibration.parameters) {
    fitted[p.parameter.key] = CommentOf(p, experiment.calibrate.method.confidence);
  }
  experiment::Experiment at = experiment::CalibratedAt(experiment, report.values);
  at.ensemble = sweep::EnsembleOf(report.calibration, experiment.calibrate.method.confidence,
                                  experiment.calibrate.draws, experiment.seed,
                                  [&](const std::vector<double>& values) {
                                    return experiment::KeepsRules(experiment, values);
                                  });
  const Node tree = yaml::ToNode(at), standard = yaml::ToNode(experiment::Experiment{});
  Node robot = Node::Map();
  for (const char* block : {"trial", "simulation"}) {
    const Node kept =
        Different(tree.Find(block)->value, standard.Find(block)->value, block, fitted);
    if (!kept.entries.empty()) robot.Add(block, kept);
  }
  if (!at.ensemble.IsEmpty()) robot.Add("ensemble", tree.Find("ensemble")->value);
  return Head(experiment, report, inputs, experiment_file, !at.ensemble.IsEmpty()) +
         yaml::Emit(robot);
}

}  // namespace rift::report
