#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift::test {

/// The same command until it ends with 0, or kGiveUp has passed; the last result, with the words of
/// all tries on stderr. A drive in real time that shares a busy machine may be stopped by the
/// guard, or by the robot itself; the same command goes on then, and says no word of what is done.
inline ProcessResult RunUntilDone(const std::vector<std::string>& command) {
  const auto end = std::chrono::steady_clock::now() + kGiveUp;
  ProcessResult result;
  std::string words;
  do {
    result = RunRift(command);
    words += result.err;
  } while (result.exit_code != 0 && std::chrono::steady_clock::now() < end);
  result.err = words;
  return result;
}

}  // namespace rift::test
