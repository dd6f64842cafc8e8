#pragma once

namespace rift::sweep {

/// What a trial in a worker process may cost before it is given up. Not part of what a trial
/// computes, so a sweep may go on with other values.
struct RunOptions {
  double timeout_s = 60.0;
  int memory_mb = 1024;
  int retries = 1;

  /// Calls field(key, member, [min, max,] help) for every member; min and max are inclusive.
  template <class Self, class Visitor>
  static void Fields(Self& self, Visitor&& field) {
    field("timeout_s", self.timeout_s, 0.01, 86400.0,
          "a trial is hung when it has not ended after this long on the wall clock");
    field("memory_mb", self.memory_mb, 16, 1'000'000,
          "what a worker may take on top of what the sweep itself holds, in 2^20 bytes");
    field("retries", self.retries, 0, 10, "how often a trial that hung or crashed is tried again");
  }
};

}  // namespace rift::sweep
