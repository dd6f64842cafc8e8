#pragma once

#include <cstdint>

namespace rift::control {

/// Motor power of the two wheels as a share of full power, each in [-1, 1]; forward positive.
struct WheelPower {
  double left = 0.0;
  double right = 0.0;

  friend bool operator==(const WheelPower&, const WheelPower&) = default;
};

/// Counts of the quadrature encoders since the start; forward positive.
struct EncoderCounts {
  std::int64_t left = 0;
  std::int64_t right = 0;

  friend bool operator==(const EncoderCounts&, const EncoderCounts&) = default;
};

}  // namespace rift::control
