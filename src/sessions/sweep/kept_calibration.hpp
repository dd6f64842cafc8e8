#pragma once

#include <optional>
#include <string>

#include "rift/sweep/calibrate/identification.hpp"
#include "rift/sweep/falsify/evaluator.hpp"
#include "rift/sweep/run/journal.hpp"

namespace rift::sessions {

/// Reads the pictures of heightfields that a fit drives on, so that InputsText names them.
void ReadPictures(sweep::Evaluator& evaluator);

/// What a fit found, as the journal keeps it.
class KeptCalibration {
 public:
  /// Reads the logs and what else the fit reads. The evaluator must outlive this.
  explicit KeptCalibration(sweep::Evaluator& evaluator);

  /// Of everything that the fit depends on beside the facts of the journal.
  const std::string& key() const { return key_; }
  /// Fits. What is said of progress alone is not kept.
  sweep::JournalEntry Fit(int jobs, const sweep::Say& say);
  /// What was kept, its notes told again; nothing where there is none.
  std::optional<sweep::CalibrationReport> Find(sweep::Journal& journal, const sweep::Say& say);

 private:
  sweep::Evaluator& evaluator_;
  std::string key_;
};

}  // namespace rift::sessions
