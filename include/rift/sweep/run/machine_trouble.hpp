#pragma once

#include <stdexcept>

namespace rift::sweep {

/// What keeps this machine from running a trial: no process, no folder, a full disk. It is no
/// finding of the trial, so it ends the sweep and is not kept.
class MachineTrouble : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rift::sweep
