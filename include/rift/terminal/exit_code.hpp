#pragma once

#include <functional>
#include <string>

namespace rift::terminal {

/// What the process ends with.
enum ExitCode : int {
  kDone = 0,
  kFalsified = 1,       ///< only with --exit-code
  kNotReached = 1,      ///< a trial ended before the last waypoint
  kWorseThanStart = 1,  ///< a fit that is worse than its start is not written
  kBadInput = 2,        ///< usage, configuration or a log
  kRunTimeFailure = 3,
  kStopped = 130,  ///< by Ctrl-C, as shells have it
};

/// One line on stderr; returns `exit_code`.
int Fail(const std::string& what, int exit_code);

/// What `work` returns. What it throws is one line on stderr, and the exit code that goes with it.
int ReportErrors(const std::function<int()>& work);

}  // namespace rift::terminal
