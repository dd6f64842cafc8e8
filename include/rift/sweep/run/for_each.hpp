#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <vector>

namespace rift::sweep {

/// Calls work(i) once for each i below `count`, `threads` at once, this one among them: at once on
/// this one for a `threads` of 1 or less. Throws what work throws, after all calls have ended; a
/// thread whose call threw makes no further one.
template <class Work>
void ForEach(std::size_t count, int threads, const Work& work) {
  std::atomic<std::size_t> next = 0;
  const auto share = [&] {
    for (std::size_t i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::future<void>> others;
  for (int i = 1; i < threads; ++i) others.push_back(std::async(std::launch::async, share));
  share();
  for (std::future<void>& other : others) other.get();
}

}  // namespace rift::sweep
