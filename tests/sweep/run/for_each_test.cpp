#include "rift/sweep/run/for_each.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

namespace rift::sweep {
namespace {

TEST_CASE("Each element is worked on once, whatever the threads") {
  for (const int threads : {0, 1, 2, 7}) {
    for (const std::size_t count : {0, 1, 3, 500}) {
      std::vector<int> calls(count, 0);
      ForEach(count, threads, [&](std::size_t i) { ++calls[i]; });
      CAPTURE(threads, count);
      CHECK(calls == std::vector<int>(count, 1));
    }
  }
}

TEST_CASE("Two threads work at once, and one is the caller's own") {
  std::atomic<int> started = 0;
  // Neither goes on before both are there.
  ForEach(2, 2, [&](std::size_t) {
    ++started;
    while (started < 2) std::this_thread::yield();
  });
  CHECK(started == 2);
  std::set<std::thread::id> alone;
  ForEach(20, 1, [&](std::size_t) { alone.insert(std::this_thread::get_id()); });
  CHECK(alone == std::set{std::this_thread::get_id()});
}

TEST_CASE("What work throws arrives when nothing works any more") {
  for (const int threads : {1, 2}) {
    std::atomic<int> working = 0;
    const auto work = [&](std::size_t i) {
      ++working;
      if (i == 10) {
        --working;
        throw std::runtime_error("ten");
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --working;
    };
    CHECK_THROWS_WITH(ForEach(40, threads, work), "ten");
    CHECK(working == 0);
  }
}

}  // namespace
}  // namespace rift::sweep
