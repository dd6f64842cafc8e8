#pragma once

#include <functional>
#include <string>
#include <vector>

namespace rift::test {

/// What a process showed on the terminal that its three streams were.
struct TerminalRun {
  int exit_code = -1;  ///< 128 + signal when a signal ended it
  std::string shown;   ///< with \r\n at each line's end
  /// Characters of the longest text that replaced what stood on the terminal's line, of those that
  /// begin like this.
  std::size_t LongestInPlace(const std::string& beginning) const;
};

/// Runs rift in a terminal of so many columns (0: it does not tell), which it controls. `type` is
/// asked after everything that is shown, with all that was, and returns the keys to be pressed.
/// Gives up after kGiveUp (until.hpp): kills the process and throws std::runtime_error.
TerminalRun RunInTerminal(
    const std::vector<std::string>& arguments, int columns,
    const std::function<std::string(const std::string& shown)>& type = nullptr);

}  // namespace rift::test
