#include "kept_calibration.hpp"

#include <limits>
#include <vector>

#include "rift/sessions/sweep/calibrate.hpp"
#include "rift/statistics/hash.hpp"
#include "rift/sweep/calibrate/report_bytes.hpp"
#include "rift/sweep/run/beside_table.hpp"
#include "rift/sweep/run/byte_codec.hpp"

namespace rift::sessions {

KeptCalibration::KeptCalibration(sweep::Evaluator& evaluator) : evaluator_(evaluator) {
  evaluator.LoadLogs();
  key_ =
      sweep::kBesideTable + ("calibration to " + statistics::Hash128Text(evaluator.InputsText()));
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
