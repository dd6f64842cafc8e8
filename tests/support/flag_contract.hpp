#pragma once

#include <functional>
#include <string>
#include <vector>

#include "support/processes/process.hpp"

namespace rift::test {

/// What a flag does, on one command line. Words are split at spaces; @ is the folder of the run, %
/// the source tree, ~ a space within a word.
struct FlagRow {
  std::string flag;
  std::string words;  ///< that follow the flag
  /// The command line without the flag, which must not show the effect; "-": it is not run.
  std::string base;
  int exit_code = 0;  ///< with the flag
  /// What is seen with the flag and not without:
  ///   out TEXT, err TEXT     printed there
  ///   no-err TEXT            not printed there
  ///   file NAME TEXT         in a file of the run's folder (TEXT may be left out)
  ///   no-file NAME           a file that is not there
  ///   json POINTER VALUE     in the JSON on stdout
  ///   changes POINTER        a number there that is another without the flag
  ///   file-changes NAME POINTER    the same in a JSON file
  ///   differs NAME           a file that is another without the flag
  ///   exit                   the exit code alone
  ///   test NAME              nothing here: the test of this name holds the flag to its effect
  std::string effect;
};

/// Holds each flag of `rift COMMAND --help` to its row; a flag without a row is a failure, as is a
/// row of no flag. `prepare` fills the folder of each run.
void CheckFlags(const std::string& command,
                const std::function<void(const TemporaryFolder&)>& prepare,
                const std::vector<FlagRow>& rows);

/// One command line as in FlagRow.
std::vector<std::string> SplitWords(const std::string& words, const TemporaryFolder& folder);

}  // namespace rift::test
