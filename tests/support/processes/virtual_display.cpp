#include "support/processes/virtual_display.hpp"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "support/processes/child_end.hpp"
#include "support/until.hpp"

namespace rift::test {

VirtualDisplay::VirtualDisplay() {
  int ends[2];
  if (pipe(ends) != 0) return;
  pid_ = fork();
  if (pid_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // not left behind by a test that crashes
    close(ends[0]);
    const std::string descriptor = std::to_string(ends[1]);
    // Without -noreset the server starts over when its last client goes, and refuses the next.
    execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", "1400x900x24",
           "-nolisten", "tcp", "-noreset", static_cast<char*>(nullptr));
    _exit(127);
  }
  close(ends[1]);
  pollfd wanted{ends[0], POLLIN, 0};
  const int longest_ms = static_cast<int>(1000 * kGiveUp.count());
  for (char letter = 0; poll(&wanted, 1, longest_ms) == 1 && read(ends[0], &letter, 1) == 1;) {
    if (letter == '\n') break;
    number_ += letter;
  }
  close(ends[0]);
}

VirtualDisplay::~VirtualDisplay() {
  if (pid_ <= 0) return;
  kill(pid_, SIGTERM);
  if (!EndsInTime(pid_)) kill(pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

}  // namespace rift::test
