#include "rift/terminal/stop_signal.hpp"

#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>

#include "rift/terminal/exit_code.hpp"
#include "text.hpp"

namespace rift::terminal {
namespace {

/// When the first signal came, on the monotonic clock; 0: none has. Two threads may be in handlers.
std::atomic<std::int64_t> asked_ns{0};
static_assert(std::atomic<std::int64_t>::is_always_lock_free);  // else no handler may touch it

enum class Arrival { kFirst, kSame, kLater };

/// `timeout` signals a process and then its group: what comes within a second is the same signal.
Arrival NoteSignal() {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  struct timespec now {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  const std::int64_t now_ns = now.tv_sec * kSecond_ns + now.tv_nsec;
  std::int64_t first_ns = 0;
  if (asked_ns.compare_exchange_strong(first_ns, now_ns)) return Arrival::kFirst;
  return now_ns - first_ns < kSecond_ns ? Arrival::kSame : Arrival::kLater;
}

void Ask(int signal) {
  if (NoteSignal() != Arrival::kLater) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // delivered when this handler returns
}

std::string last_line;  // as it is written: nothing but write and _exit is allowed in a handler

void End(int) {
  const Arrival arrival = NoteSignal();
  if (arrival == Arrival::kSame) return;  // the first one is writing
  if (arrival == Arrival::kLater) ::_exit(kStopped);
  const ssize_t written = ::write(2, last_line.data(), last_line.size());
  static_cast<void>(written);  // nobody is left to be told
  ::_exit(kStopped);
}

/// Of Ctrl-C and SIGTERM; keeps what was there.
void Handle(void (*handler)(int), struct sigaction& interrupt, struct sigaction& terminate) {
  struct sigaction action {};
  action.sa_handler = handler;
  asked_ns = 0;
  ::sigaction(SIGINT, &action, &interrupt);
  ::sigaction(SIGTERM, &action, &terminate);
}

void PutBack(const struct sigaction& interrupt, const struct sigaction& terminate) {
  ::sigaction(SIGINT, &interrupt, nullptr);
  ::sigaction(SIGTERM, &terminate, nullptr);
}

}  // namespace

StopSignal::StopSignal() { Handle(Ask, interrupt_, terminate_); }

StopSignal::~StopSignal() { PutBack(interrupt_, terminate_); }

bool StopSignal::IsAsked() const { return asked_ns != 0; }

EndSignal::EndSignal(const std::string& line) {
  last_line = TerminalText(line, LineBreaks::kEscaped) + '\n';
  Handle(End, interrupt_, terminate_);
}

EndSignal::~EndSignal() { PutBack(interrupt_, terminate_); }

}  // namespace rift::terminal
