#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <span>
#include <vector>

#include "rift/simulation/link.hpp"

namespace rift::twin {

/// One way of a serial radio: delay, baud rate and losses of the simulated link, for any bytes.
/// What was put in at once is lost as a whole by line_loss. Times in s, never running backwards.
class ByteChannel {
 public:
  ByteChannel(const simulation::LinkOptions& options, std::uint64_t seed)
      : options_(options), random_(seed) {}

  void Put(double at_s, std::span<const std::uint8_t> bytes);
  /// What has arrived by then and was not taken before.
  std::vector<std::uint8_t> Take(double now_s);

 private:
  struct Byte {
    double arrives_s;
    std::uint8_t value;
  };

  bool Happens(double share) { return std::uniform_real_distribution<>(0.0, 1.0)(random_) < share; }

  simulation::LinkOptions options_;
  std::mt19937_64 random_;
  std::deque<Byte> on_the_way_;
  double free_s_ = 0.0;
};

}  // namespace rift::twin
