#pragma once

#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

namespace rift::test {

/// How long something that must happen may take. It is the last resort against a test that hangs,
/// so it holds on a machine many times slower or busier than any that runs the tests; shorter than
/// what ctest gives a test (cmake/Room.cmake), else nobody would learn what was waited for.
constexpr std::chrono::seconds kGiveUp{420};

/// Waits until `is_so()`, which is asked again and again. Throws std::runtime_error that says
/// `what` was waited for when it never was so.
template <class Predicate>
void WaitUntil(const std::string& what, const Predicate& is_so) {
  const auto end = std::chrono::steady_clock::now() + kGiveUp;
  while (!is_so()) {
    if (std::chrono::steady_clock::now() > end) {
      throw std::runtime_error("waited in vain for " + std::to_string(kGiveUp.count()) +
                               " s until " + what);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // not to take the processor away
  }
}

}  // namespace rift::test
