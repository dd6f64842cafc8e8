#include "rift/terminal/stop_signal.hpp"

namespace rift::terminal {
namespace {

volatile std::sig_atomic_t asked = 0;  // all that a handler may touch

void Ask(int) { asked = 1; }

}  // namespace

StopSignal::StopSignal() {
  asked = 0;
  struct sigaction action {};
  action.sa_handler = Ask;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  ::sigaction(SIGINT, &action, &interrupt_);
  ::sigaction(SIGTERM, &action, &terminate_);
}

StopSignal::~StopSignal() {
  ::sigaction(SIGINT, &interrupt_, nullptr);
  ::sigaction(SIGTERM, &terminate_, nullptr);
}

bool StopSignal::IsAsked() const { return asked != 0; }

}  // namespace rift::terminal
