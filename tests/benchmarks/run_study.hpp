#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "support/inputs/trials.hpp"

namespace rift::test {

/// What main() returns: `study()`, 0 where the authors' trials are missing, 1 after an exception.
template <class Study>
int RunStudy(const Study& study) {
  try {
    if (TrialsFolder().empty()) {
      fmt::print("SKIPPED: the authors' trials are not beside this clone (../shared/trials)\n");
      return 0;
    }
    return study();
  } catch (const std::exception& fault) {
    fmt::print(stderr, "{}\n", fault.what());
    return 1;
  }
}

}  // namespace rift::test
