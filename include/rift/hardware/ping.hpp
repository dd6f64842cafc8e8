#pragma once

#include <string>
#include <vector>

#include "rift/hardware/options.hpp"
#include "rift/hardware/serial_port.hpp"

namespace rift::hardware {

/// How a link carries commands; made with the motors at zero. Times are -1 where nothing came back.
struct PingResult {
  Protocol protocol = Protocol::kAuto;
  size_t sent = 0;
  size_t answered = 0;
  double loss = 0.0;         ///< share without an answer
  size_t longest_burst = 0;  ///< without an answer, in a row
  double p50_s = -1.0;
  double p95_s = -1.0;
  double p99_s = -1.0;
  double max_s = -1.0;
  double jitter_s = -1.0;  ///< mean change from one round trip to the next (RFC 3550)
  double battery_v = -1.0;

  bool IsMeasured() const { return answered > 0; }
  /// From host to motor: half of the median round trip.
  double OneWay_s() const { return IsMeasured() ? 0.5 * p50_s : -1.0; }
};

/// The part of OneWay_s() that is the radio's, without the bytes of command and answer on the
/// serial line; 0 where the line alone would take as long, -1 where nothing was measured.
double RadioDelay_s(const PingResult& result, const LineOptions& options);

/// Sends zeros in frames for options.duration_s and counts. A robot that speaks plain cannot be
/// measured: nothing is sent to it. Throws LineGone.
PingResult Ping(ByteLine& line, Clock& clock, const LineOptions& line_options, Protocol protocol,
                const PingOptions& options);

/// One line for each part of the budget that is broken, saying what to change; empty: it is kept.
std::vector<std::string> BrokenBudget(const PingResult& result, const PingOptions& options);

}  // namespace rift::hardware
