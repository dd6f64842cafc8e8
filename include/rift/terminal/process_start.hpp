#pragma once

namespace rift::terminal {

/// Makes a process that somebody else started safe to work in; to be called before anything is
/// opened. Everything holds across exec and fork.
///
/// Descriptors 0 to 2 that are closed (a daemon, a launcher) are opened, or the next file to be
/// opened, such as the robot's serial port, would be stdout or stderr and get our text. Reading
/// stdin is then its end, and every write to stdout and stderr fails, so that lost results are
/// noticed. SIGPIPE and SIGXFSZ are ignored: a reader that goes away, or a limit on the size of
/// files (ulimit -f), is a failed write with its reason and ends no drive.
///
/// Throws std::runtime_error when a descriptor cannot be opened.
void GuardProcessStart();

}  // namespace rift::terminal
