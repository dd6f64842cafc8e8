#include "rift/hardware/signal_watch.hpp"

#include <catch2/catch.hpp>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

namespace rift::hardware {
namespace {

const std::vector<std::pair<int, std::string>> kNames{
    {SIGINT, "SIGINT"},   {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"},  {SIGQUIT, "SIGQUIT"},
    {SIGTSTP, "SIGTSTP"}, {SIGTTIN, "SIGTTIN"}, {SIGTTOU, "SIGTTOU"}};

using Handler = void (*)(int);

Handler HandlerOf(int signal) {
  struct sigaction action {};
  ::sigaction(signal, nullptr, &action);
  return action.sa_handler;
}

TEST_CASE("Each signal that would end or suspend a drive is seen by its name, and none before") {
  for (const auto& [number, name] : kNames) {
    const SignalWatch watch;
    CHECK_FALSE(watch.Seen());
    std::raise(number);
    CHECK(watch.Seen() == name);
    CHECK(watch.Seen() == name);  // it stays seen
  }
}

TEST_CASE("Of two signals the first is told, and a new watch has seen neither") {
  for (const auto& [first, second] : {std::pair{SIGTERM, SIGINT}, {SIGINT, SIGTERM}}) {
    const SignalWatch watch;
    std::raise(first);
    std::raise(second);
    CHECK(watch.Seen() == (first == SIGTERM ? "SIGTERM" : "SIGINT"));
  }
  CHECK_FALSE(SignalWatch().Seen());
}

TEST_CASE("After a watch each signal does again what it did before it") {
  const Handler nothing = [](int) {};
  std::vector<Handler> before;
  for (const auto& [number, name] : kNames) before.push_back(::signal(number, nothing));
  {
    const SignalWatch watch;
    for (const auto& [number, name] : kNames) {
      INFO(name);
      CHECK((HandlerOf(number) != nothing));
    }
  }
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    INFO(kNames[i].second);
    CHECK((HandlerOf(kNames[i].first) == nothing));
    ::signal(kNames[i].first, before[i]);
  }
}

}  // namespace
}  // namespace rift::hardware
