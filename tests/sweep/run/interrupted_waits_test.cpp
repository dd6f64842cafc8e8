// Signals that come while a sweep waits for its workers or for a program: each wait goes on.
#include <signal.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <map>
#include <string>

#include "rift/sweep/run/external_program.hpp"
#include "rift/sweep/run/worker_pool.hpp"

namespace rift::sweep {
namespace {

volatile std::sig_atomic_t ticks = 0;

/// A signal every two milliseconds, which calls of the system do not go on after by themselves.
class Ticking {
 public:
  Ticking() {
    Action count{};
    count.sa_handler = [](int) { ticks = ticks + 1; };
    ticks = 0;
    ::sigaction(SIGALRM, &count, &before_);
    const itimerval often{{0, 2000}, {0, 2000}};
    ::setitimer(ITIMER_REAL, &often, nullptr);
  }
  ~Ticking() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::sigaction(SIGALRM, &before_, nullptr);
  }
  Ticking(const Ticking&) = delete;
  Ticking& operator=(const Ticking&) = delete;

 private:
  using Action = struct sigaction;
  Action before_{};
};

TEST_CASE("A pool that is interrupted while it waits for its workers has all of their answers") {
  WorkerPool pool(
      [](const std::string& job) {
        ::usleep(20'000);
        return job;
      },
      2, {});
  std::map<int, std::string> answers;
  const Ticking ticking;
  CHECK(pool.Run({4, [](int i) { return std::to_string(i); },
                  [&](int i, const JobResult& result) { answers[i] = result.bytes; },
                  [] { return true; }}));
  CHECK(answers == std::map<int, std::string>{{0, "0"}, {1, "1"}, {2, "2"}, {3, "3"}});
  CHECK(ticks > 3);
}

TEST_CASE("A program is told, heard and waited for to its end, whatever interrupts") {
  const Ticking ticking;
  {
    ExternalProgram program({.arguments = {"sh", "-c",
                                           "sleep 0.05; head -n 1 | wc -c; sleep 0.05; "
                                           "sleep 1000 & exit 3"},
                             .talks = true},
                            ExternalProgram::MakeFolder());
    CHECK(program.SendLine(std::string(1'000'000, 'a')));
    CHECK(program.ReceiveLine() == "1000001");
    const ExternalProgram::Exit exit = program.Wait();
    CHECK(exit.code == 3);
    CHECK(exit.signal == 0);
    CHECK(ticks > 5);
  }
  CHECK(::waitpid(-1, nullptr, WNOHANG) < 0);  // nobody is left, not even as a dead process
  CHECK(errno == ECHILD);
}

}  // namespace
}  // namespace rift::sweep
