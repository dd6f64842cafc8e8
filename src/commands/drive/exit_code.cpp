#include "exit_code.hpp"

#include "rift/sessions/drive/session.hpp"
#include "rift/terminal/exit_code.hpp"

namespace rift::commands {

int ExitCodeOf(const hardware::DriveRun& run) {
  if (run.evidence.stop_acknowledged == false) return terminal::kNotReached;
  if (run.trial.outcome == trial::Outcome::kReached) return terminal::kDone;
  const bool is_over =
      run.trial.outcome == trial::Outcome::kTimedOut || sessions::WasEndedByPerson(run);
  return run.dry_run && run.has_begun && is_over ? terminal::kDone : terminal::kNotReached;
}

}  // namespace rift::commands
