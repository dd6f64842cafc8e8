#include "support/processes/child_end.hpp"

#include <poll.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

#include "support/until.hpp"

namespace rift::test {

bool EndsInTime(pid_t process) {
  const int descriptor = static_cast<int>(::syscall(SYS_pidfd_open, process, 0));
  if (descriptor < 0 && errno == ESRCH) return true;
  if (descriptor < 0) throw std::runtime_error("cannot wait for a process");
  pollfd wanted{descriptor, POLLIN, 0};
  const int ready = ::poll(&wanted, 1, static_cast<int>(1000 * kGiveUp.count()));
  ::close(descriptor);
  return ready > 0;
}

int EndOf(pid_t child, const std::string& what) {
  const bool is_over = EndsInTime(child);
  if (!is_over) ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!is_over) throw std::runtime_error("waited in vain for the end of " + what);
  return status;
}

}  // namespace rift::test
