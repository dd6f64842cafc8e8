#pragma once

#include <string>

#include "rift/sweep/calibrate/drive_likeness.hpp"

namespace rift::sweep {

/// Likeness of the trials that share a value of the main factor.
struct GroupLikeness {
  std::string level;  ///< "all" for every trial
  DriveLikeness likeness;
};

}  // namespace rift::sweep
