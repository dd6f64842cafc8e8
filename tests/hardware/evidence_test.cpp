#include <catch2/catch.hpp>

#include "random_drive.hpp"

namespace rift::hardware {
namespace {

// tests/benchmarks/drive_evidence_study.cpp draws 10,000.
TEST_CASE("Whatever strikes a drive it ends within a known distance") {
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    const Struck struck = StrikeAtRandom(seed);
    INFO(seed << ": " << struck.faults << " at " << struck.speed_mps << " m/s: " << struck.reason);
    CHECK(struck.travelled_m <= struck.allowed_m);
  }
}

// The study drives for ten hours.
TEST_CASE("A healthy drive is not stopped") {
  const HealthyHours healthy = DriveHealthily(0.15, 1000);
  for (const std::string& stop : healthy.stops) UNSCOPED_INFO(stop);
  CHECK(healthy.stops.empty());
}

}  // namespace
}  // namespace rift::hardware
