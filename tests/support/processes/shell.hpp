#pragma once

#include <string>

namespace rift::test {

/// Exit code of a command of /bin/sh without input, 128 + signal when a signal ended it. When it
/// has not ended after kGiveUp (until.hpp), it is killed with all that it started, and
/// std::runtime_error names it.
int RunShell(const std::string& command);

}  // namespace rift::test
