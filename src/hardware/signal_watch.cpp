#include "rift/hardware/signal_watch.hpp"

#include <atomic>
#include <cstring>

namespace rift::hardware {
namespace {

std::atomic<int> seen = 0;  // a handler has nothing else to write to
static_assert(std::atomic<int>::is_always_lock_free);

void Note(int signal) {
  int none = 0;
  seen.compare_exchange_strong(none, signal);
}

}  // namespace

SignalWatch::SignalWatch() {
  seen = 0;
  struct sigaction action {};
  action.sa_handler = Note;
  sigemptyset(&action.sa_mask);
  for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &action, &before_[i]);
}

SignalWatch::~SignalWatch() {
  for (size_t i = 0; i < kSignals.size(); ++i) ::sigaction(kSignals[i], &before_[i], nullptr);
}

std::optional<std::string> SignalWatch::Seen() const {
  const int signal = seen;
  if (signal == 0) return std::nullopt;
  return std::string("SIG") + sigabbrev_np(signal);
}

}  // namespace rift::hardware
