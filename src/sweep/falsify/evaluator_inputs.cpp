// Files that trials depend on: logs, programs and pictures of heightfields, and the journal's key
// of a trial that they are part of.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "program_side.hpp"
#include "rift/experiment/parameter.hpp"
#include "rift/experiment/path_template.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/falsify/result.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/trajectory/csv.hpp"
#include "rift/yaml/node.hpp"

namespace rift::sweep {

using experiment::CandidateKind;
using experiment::ReferenceKind;

namespace {

std::string Beside(const std::string& log, const char* name) {
  return std::filesystem::path(log).replace_filename(name).string();
}

}  // namespace

bool Evaluator::LoadLogs(const std::function<bool()>& go_on) {
  if (experiment_.reference.kind == ReferenceKind::kLogs) {
    if (!LoadLogsOf(experiment_.reference.path, "reference.path", go_on, reference_logs_)) {
      return false;
    }
    // Beside recorded candidates a copy's rows are one run, which counts once.
    if (experiment_.candidate.kind != CandidateKind::kLogs) reference_logs_.NoteCopies();
  }
  return experiment_.candidate.kind != CandidateKind::kLogs ||
         LoadLogsOf(experiment_.candidate.path, "candidate.path", go_on, candidate_logs_);
}

bool Evaluator::LoadLogsOf(const experiment::PathTemplate& path, const char* key,
                           const std::function<bool()>& go_on, RecordedLogs& logs) const {
  const std::vector<std::string> names = experiment::TemplateNames(path.text);
  // Of the other parameters one value will do: the path is the same for all.
  std::vector<experiment::Parameter> parameters = experiment_.space.parameters;
  for (experiment::Parameter& parameter : parameters) {
    const bool is_named = std::find(names.begin(), names.end(), parameter.Name()) != names.end();
    if (is_named && parameter.IsContinuous()) {
      throw std::invalid_argument(
          fmt::format("{}: space.{} is a range, and {} names a log for each value of it: write a "
                      "list of those there are",
                      parameter.origin, parameter.key, key));
    }
    if (!is_named) parameter.levels = {{"0", 0.0}};
  }
  for (const TrialRequest& request : GridTrials(parameters, experiment_.reference.trials.names)) {
    if (!go_on()) return false;
    logs.At(Filled(path, request));
  }
  return true;
}

std::optional<double> Evaluator::TrialBegan_s(const std::string& log) const {
  const std::string path = Beside(log, "commands.csv");
  const std::optional<std::string> text = inputs_.read(path);
  if (!text) return std::nullopt;
  trajectory::csv::RowReader rows(*text, path, true, ',');
  if (rows.Columns().empty()) return std::nullopt;  // of a drive that broke off
  if (rows.Columns().front() != "t_s") {
    throw std::invalid_argument(
        fmt::format("{}: its first column is '{}', and that of commands.csv is t_s", path,
                    rows.Columns().front()));
  }
  if (!rows.Next() || std::isnan(rows.Cells().front())) return std::nullopt;
  return rows.Cells().front();
}

std::vector<odometry::EncoderReading> Evaluator::EncodersBeside(const std::string& log) const {
  const std::string path = Beside(log, "encoders.csv");
  const std::optional<std::string> text = inputs_.read(path);
  if (!text) return {};
  const std::optional<std::string> note = trajectory::csv::NoteOfEnd(*text);
  if (note) inputs_.note(fmt::format("{}: {}", path, *note));
  return odometry::ReadEncoders(*text, path);
}

std::string Evaluator::KeyOf(const TrialRequest& request) {
  std::string key = TrialKey(experiment_.space.parameters, request);
  if (experiment_.reference.kind == ReferenceKind::kLogs) {
    key += fmt::format(" log={}", reference_logs_.HashOf(ReferencePath(request)));
  }
  if (experiment_.candidate.kind == CandidateKind::kLogs) {
    const std::string path = Filled(experiment_.candidate.path, request);
    key += fmt::format(" candidate={}", candidate_logs_.HashOf(path));
  }
  for (const auto& program : {candidate_program_, reference_program_}) {
    if (!program || program->HashesText().empty()) continue;
    key += fmt::format(" program={}", statistics::Hash128Text(program->HashesText()));
  }
  for (const std::string& picture : PicturesOf(request)) {
    key += fmt::format(" picture={}", PictureHash(picture));
  }
  return key;
}

std::set<std::string> Evaluator::PicturesOf(const TrialRequest& request) const {
  std::set<std::string> pictures;
  const auto add = [&pictures](const experiment::Experiment& at) {
    const simulation::TerrainOptions& terrain = at.simulation.terrain;
    const auto surface = terrain.surfaces.find(terrain.surface);
    const bool is_picture = surface != terrain.surfaces.end() &&
                            surface->second.shape == simulation::Shape::kHeightfield;
    if (is_picture) pictures.insert(surface->second.image);
  };
  const bool is_simulated = experiment_.candidate.kind == CandidateKind::kSimulation;
  if (!is_simulated || !may_have_pictures_) return pictures;  // spares a copy of the experiment
  if (experiment_.reference.kind == ReferenceKind::kNominal) add(experiment_);
  try {
    add(ExperimentFor(experiment_, request));
  } catch (const yaml::Error&) {
    // Its row says which rule the setting breaks.
  }
  return pictures;
}

const std::string& Evaluator::PictureHash(const std::string& path) {
  const auto [found, is_new] = picture_hashes_.try_emplace(path);
  if (!is_new) return found->second;
  const std::optional<std::string> bytes = inputs_.read(path);
  if (bytes) found->second = statistics::Hash128Text(*bytes);
  return found->second;
}

std::string Evaluator::InputsText() const {
  std::string text = candidate_logs_.HashesText() + reference_logs_.HashesText();
  for (const auto& program : {candidate_program_, reference_program_}) {
    if (program) text += program->HashesText();
  }
  for (const auto& [path, hash] : picture_hashes_) {
    if (!hash.empty()) text += fmt::format("{}  {}\n", hash, path);
  }
  return text;
}

}  // namespace rift::sweep
