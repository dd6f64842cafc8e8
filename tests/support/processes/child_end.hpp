#pragma once

#include <sys/types.h>

#include <string>

namespace rift::test {

/// False when the process, a child of this one or not, has not ended after kGiveUp (until.hpp).
bool EndsInTime(pid_t process);

/// The status (waitpid) with which a child of this process ended. When it has not ended after
/// kGiveUp it is killed, and std::runtime_error says that `what` was waited for.
int EndOf(pid_t child, const std::string& what);

}  // namespace rift::test
