// What the end of a drive means for what follows: its exit code, and whether a series may go on.
#include <catch2/catch.hpp>

#include "commands/drive/exit_code.hpp"
#include "rift/report/json/stop_text.hpp"
#include "rift/sessions/drive/session.hpp"

namespace rift {
namespace {

using hardware::StopReason;
using trial::Outcome;

hardware::DriveRun Ended(Outcome outcome, StopReason reason, bool dry_run = false) {
  hardware::DriveRun run;
  run.has_begun = true;
  run.dry_run = dry_run;
  run.trial.outcome = outcome;
  run.evidence.stop = {.reason = reason};
  return run;
}

TEST_CASE("A drive ends with 0 where it arrived, a dry run where its time or a person ended it") {
  using commands::ExitCodeOf;
  for (const bool dry_run : {false, true}) {
    INFO(dry_run);
    const int if_dry = dry_run ? 0 : 1;
    CHECK(ExitCodeOf(Ended(Outcome::kReached, StopReason::kFinished, dry_run)) == 0);
    CHECK(ExitCodeOf(Ended(Outcome::kTimedOut, StopReason::kFinished, dry_run)) == if_dry);
    CHECK(ExitCodeOf(Ended(Outcome::kFault, StopReason::kOperator, dry_run)) == if_dry);
    CHECK(ExitCodeOf(Ended(Outcome::kFault, StopReason::kSignal, dry_run)) == if_dry);
    CHECK(ExitCodeOf(Ended(Outcome::kFault, StopReason::kPoseStale, dry_run)) == 1);
    CHECK(ExitCodeOf(Ended(Outcome::kFault, StopReason::kException, dry_run)) == 1);
    hardware::DriveRun early = Ended(Outcome::kFault, StopReason::kOperator, dry_run);
    early.has_begun = false;
    CHECK(ExitCodeOf(early) == 1);
  }
  CHECK(ExitCodeOf({}) == 1);
}

TEST_CASE("A drive whose stop the robot did not acknowledge never ends with 0") {
  for (const bool dry_run : {false, true}) {
    for (const std::optional<bool> acknowledged : {std::optional<bool>{}, {true}, {false}}) {
      hardware::DriveRun run = Ended(Outcome::kReached, StopReason::kFinished, dry_run);
      run.evidence.stop_acknowledged = acknowledged;
      INFO(report::StopText(acknowledged));
      CHECK(commands::ExitCodeOf(run) == (acknowledged == false ? 1 : 0));
    }
  }
}

TEST_CASE("Whoever stops a robot is a person, and all else that does is a fault but its time") {
  using sessions::WasEndedByFault, sessions::WasEndedByPerson;
  const auto names = EnumNames(StopReason{});
  for (std::size_t i = 0; i < names.size(); ++i) {
    INFO(names[i]);
    const auto reason = static_cast<StopReason>(i);
    const bool is_person = reason == StopReason::kOperator || reason == StopReason::kSignal;
    const hardware::DriveRun stopped = Ended(Outcome::kFault, reason);
    CHECK(WasEndedByPerson(stopped) == is_person);
    CHECK(WasEndedByFault(stopped) != is_person);
    const hardware::DriveRun late = Ended(Outcome::kTimedOut, reason);
    CHECK(WasEndedByFault(late) == (!is_person && reason != StopReason::kFinished));
    CHECK_FALSE(WasEndedByFault(Ended(Outcome::kReached, reason)));
  }
}

}  // namespace
}  // namespace rift
