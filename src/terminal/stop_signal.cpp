#include "rift/terminal/stop_signal.hpp"

#include <unistd.h>

#include "rift/terminal/exit_code.hpp"
#include "text.hpp"

namespace rift::terminal {
namespace {

volatile std::sig_atomic_t asked = 0;  // all that a handler may touch

void Ask(int) { asked = 1; }

std::string last_line;  // as it is written: nothing but write and _exit is allowed in a handler

void End(int) {
  const ssize_t written = ::write(2, last_line.data(), last_line.size());
  static_cast<void>(written);  // nobody is left to be told
  ::_exit(kStopped);
}

/// Of Ctrl-C and SIGTERM; keeps what was there.
void Handle(void (*handler)(int), struct sigaction& interrupt, struct sigaction& terminate) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, &interrupt);
  ::sigaction(SIGTERM, &action, &terminate);
}

void PutBack(const struct sigaction& interrupt, const struct sigaction& terminate) {
  ::sigaction(SIGINT, &interrupt, nullptr);
  ::sigaction(SIGTERM, &terminate, nullptr);
}

}  // namespace

StopSignal::StopSignal() {
  asked = 0;
  Handle(Ask, interrupt_, terminate_);
}

StopSignal::~StopSignal() { PutBack(interrupt_, terminate_); }

bool StopSignal::IsAsked() const { return asked != 0; }

EndSignal::EndSignal(const std::string& line) {
  last_line = TerminalText(line, LineBreaks::kEscaped) + '\n';
  Handle(End, interrupt_, terminate_);
}

EndSignal::~EndSignal() { PutBack(interrupt_, terminate_); }

}  // namespace rift::terminal
