#include "kept_calibration.hpp"

#include <fmt/format.h>

#include <limits>
#include <vector>

#include "rift/sessions/sweep/calibrate.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/calibrate/report_bytes.hpp"
#include "rift/sweep/falsify/settings.hpp"
#include "rift/sweep/run/beside_table.hpp"
#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sessions {

namespace {

std::vector<sweep::TrialRequest> TrialsOf(const experiment::Experiment& experiment) {
  return sweep::GridTrials(experiment.space.parameters, experiment.reference.trials.names);
}

/// When the trials of the logs began, where the fit asks for it: of drives of powers.
std::string BeginningsOf(sweep::Evaluator& evaluator) {
  std::string text;
  if (evaluator.experiment().program.segments.empty()) return text;
  for (const sweep::TrialRequest& trial : TrialsOf(evaluator.experiment())) {
    const std::string log = evaluator.Reference(trial).source;
    if (const auto began_s = evaluator.TrialBegan_s(log)) {
      text += fmt::format("{} began at {}\n", log, *began_s);
    }
  }
  return text;
}

}  // namespace

void ReadPictures(sweep::Evaluator& evaluator) {
  for (const sweep::TrialRequest& trial : TrialsOf(evaluator.experiment())) evaluator.KeyOf(trial);
}

KeptCalibration::KeptCalibration(sweep::Evaluator& evaluator) : evaluator_(evaluator) {
  evaluator.LoadLogs();
  ReadPictures(evaluator);
  const std::string inputs = evaluator.InputsText() + BeginningsOf(evaluator);
  key_ = sweep::kBesideTable + ("calibration to " + statistics::Hash128Text(inputs));
}

sweep::JournalEntry KeptCalibration::Fit(int jobs, const sweep::Say& say) {
  std::vector<std::string> notes;
  const sweep::CalibrationReport found =
      sweep::Identify(evaluator_, jobs, [&](const std::string& line) {
        if (IsNote(line)) notes.push_back(line);
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

}  // namespace rift::sessions
