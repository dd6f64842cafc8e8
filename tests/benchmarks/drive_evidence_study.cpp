// How far a robot goes after faults at random, and how often a healthy drive is stopped:
//   drive_evidence_study [FAULTS] [HOURS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "hardware/random_drive.hpp"

int main(int count, char** words) {
  using namespace rift::hardware;
  const int faults = count > 1 ? std::atoi(words[1]) : 10'000;
  const double hours = count > 2 ? std::atof(words[2]) : 10.0;
  int too_far = 0, false_alarms = 0;
  double worst = 0.0;
  for (int seed = 1; seed <= faults; ++seed) {
    const Struck struck = StrikeAtRandom(static_cast<std::uint64_t>(seed));
    if (struck.faults == "none") {
      ++false_alarms;
      std::printf("seed %d stopped before: %s\n", seed, struck.reason.c_str());
      continue;
    }
    worst = std::max(worst, struck.travelled_m / struck.allowed_m);
    if (struck.travelled_m <= struck.allowed_m) continue;
    ++too_far;
    std::printf("seed %d: %s at %.3f m/s: %.3f m of %.3f: %s\n", seed, struck.faults.c_str(),
                struck.speed_mps, struck.travelled_m, struck.allowed_m, struck.reason.c_str());
  }
  std::printf("%d faults: %d went too far, the farthest %.0f %% of its limit; %d stopped before\n",
              faults, too_far, 100.0 * worst, false_alarms);
  const HealthyHours healthy = DriveHealthily(hours, 1'000'000);
  for (const std::string& stop : healthy.stops) std::printf("false stop: %s\n", stop.c_str());
  std::printf("%.2f healthy hours: %zu false stops, %.2f an hour\n", healthy.hours,
              healthy.stops.size(), static_cast<double>(healthy.stops.size()) / healthy.hours);
  return too_far > 0 ? 1 : 0;
}
