#include "calibrate.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <vector>

#include "rift/commands/arguments/inputs.hpp"
#include "rift/commands/arguments/outputs.hpp"
#include "rift/files/files.hpp"
#include "rift/files/folder_lock.hpp"
#include "rift/report/figures/figures.hpp"
#include "rift/report/json/json.hpp"
#include "rift/report/text/text.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/calibrate/report_bytes.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/beside_table.hpp"
#include "rift/sweep/run/byte_codec.hpp"
#include "rift/sweep/run/shard.hpp"
#include "rift/sweep/run/slurm_shards.hpp"
#include "rift/terminal/exit_code.hpp"
#include "rift/terminal/print.hpp"
#include "rift/terminal/stop_signal.hpp"

namespace rift::commands {
namespace {

namespace fs = std::filesystem;

void WriteFigures(const std::filesystem::path& folder, const std::string& name,
                  const sweep::CalibrationReport& found) {
  const std::optional<report::Figure> figure = report::CalibrationFigure(name, found);
  if (!figure) {
    terminal::Say(
        "note: no figure: no log has a simulated run that reached the end, both before and after "
        "the fit");
    return;
  }
  WriteFigureFiles(folder, *figure);
}

/// The fit by a job of the cluster, or by one of an earlier run. Nothing when it was told to stop.
std::optional<sweep::CalibrationReport> FitOnCluster(const SweepRequest& request,
                                                     const fs::path& out,
                                                     const sweep::SlurmOptions& options,
                                                     sweep::Evaluator& evaluator,
                                                     const sweep::Say& say) {
  const terminal::StopSignal stop;
  const fs::path file = out / kJournalName;
  if (request.fresh) {
    sweep::SlurmShards::Forget(out);
    sweep::Journal::Remove(file);
  }
  const sweep::Facts facts = FactsOf(evaluator.experiment());
  sweep::Journal journal(file, facts);
  journal.SetNote("name", evaluator.experiment().name);
  Cluster cluster(evaluator, facts, options, StyleFor(request.quiet, request.json_progress),
                  [&stop] { return !stop.IsAsked(); });
  if (!cluster.Resume(out, journal)) return std::nullopt;
  KeptCalibration kept(evaluator);
  std::optional<sweep::CalibrationReport> found = kept.Find(journal, say);
  if (!found) {
    sweep::KeysHash keys;
    keys.Add(kept.key());
    if (!cluster.RunAsOne({.kind = sweep::ShardKind::kCalibration, .keys = keys.Text()})) {
      return std::nullopt;
    }
    found = kept.Find(journal, say);
  }
  if (!found) {
    throw std::runtime_error(fmt::format(
        "{}: what the job brought back is damaged; run the same command again", file.string()));
  }
  journal.SetNote("state", "done");
  journal.Close();
  return found;
}

}  // namespace

KeptCalibration::KeptCalibration(sweep::Evaluator& evaluator) : evaluator_(evaluator) {
  evaluator.LoadLogs();
  key_ =
      sweep::kBesideTable + ("calibration to " + statistics::Hash128Text(evaluator.InputsText()));
}

sweep::JournalEntry KeptCalibration::Fit(int jobs, const sweep::Say& say) {
  std::vector<std::string> notes;
  const sweep::CalibrationReport found =
      sweep::Identify(evaluator_, jobs, [&](const std::string& line) {
        if (line.starts_with("note: ") || line.starts_with("warning: ")) notes.push_back(line);
        say(line);
      });
  sweep::ByteWriter write;
  write(notes);
  write(sweep::EncodeReport(found));
  return {.status = "ok", .gap_m = std::numeric_limits<double>::quiet_NaN(), .bytes = write.Take()};
}

std::optional<sweep::CalibrationReport> KeptCalibration::Find(sweep::Journal& journal,
                                                              const sweep::Say& say) {
  const std::optional<std::string> bytes = journal.Find(key_);
  if (!bytes) return std::nullopt;
  sweep::ByteReader read(*bytes);
  std::vector<std::string> notes;
  read(notes);
  for (const std::string& note : notes) say(note);
  std::string report;
  read(report);
  return sweep::DecodeReport(report);
}

int Calibrate(const SweepRequest& request, const experiment::Experiment& experiment,
              const sweep::SlurmOptions* cluster) {
  const fs::path out = OutputOf(request.out, experiment.name);
  if (!request.write_robot.empty()) {
    CheckOutputs({request.experiment},
                 {.files = {request.write_robot}, .folder = out, .force = request.fresh});
  }
  const files::FolderLock lock(out);
  const auto say = [&request](const std::string& line) {
    if (!request.quiet) terminal::Say(line);
  };
  sweep::Evaluator evaluator(experiment, request.experiment, FileInputs());
  const std::optional<sweep::CalibrationReport> fitted =
      cluster != nullptr ? FitOnCluster(request, out, *cluster, evaluator, say)
                         : sweep::Identify(evaluator, request.jobs, say);
  if (!fitted) {
    terminal::Say("stopped; the same command goes on");
    return terminal::kStopped;
  }
  const sweep::CalibrationReport& found = *fitted;
  lock.RequireInPlace();
  files::WriteFile(out / "experiment.yaml", experiment::WriteExperiment(experiment));
  files::WriteFile(out / "inputs.txt", evaluator.InputsText());
  const std::string json = report::CalibrationJson(experiment, found);
  files::WriteFile(out / "calibration.json", json);
  const std::string refusal = report::WhyNotWritten(found.calibration, request.write_robot);
  const bool is_written = !request.write_robot.empty() && refusal.empty();
  if (is_written) {
    files::WriteFile(
        request.write_robot,
        report::RobotYaml(experiment, found, evaluator.InputsText(), request.experiment));
  }
  request.json ? terminal::PrintData(json) : terminal::PrintText(report::CalibrationText(found));
  WriteFigures(out / "figures", experiment.name, found);
  lock.RequireInPlace();
  say(fmt::format("written: {}", (out / "calibration.json").string()));
  if (request.write_robot.empty() || is_written) return terminal::kDone;
  return terminal::Fail(refusal, terminal::kWorseThanStart);
}

}  // namespace rift::commands
