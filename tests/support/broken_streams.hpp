#pragma once

#include <sys/stat.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "support/process.hpp"

namespace rift::test {

/// How a daemon, a full disk or a reader that went away leaves stdin, stdout and stderr.
struct Streams {
  std::string redirection;  ///< for RunRift()
  bool take_results = true;
  std::string says;  ///< of stdout, on stderr
};

/// `folder` is for a pipe that nobody reads.
inline std::vector<Streams> BrokenStreams(const TemporaryFolder& folder) {
  const std::string pipe = folder / "pipe";
  if (::mkfifo(pipe.c_str(), 0600) != 0) throw std::runtime_error("cannot make a pipe");
  const std::string begin = "5<>" + pipe + " ", end = pipe + " 5<&-";
  return {{"<&-"},
          {"2>&-"},
          {"2>/dev/full"},
          {begin + "2>" + end},
          {">&-", false, "rift: cannot write to stdout: it is closed\n"},
          {">/dev/full", false, "rift: cannot write to stdout: No space left on device\n"},
          {begin + ">" + end, false},
          {">/dev/full 2>/dev/full", false},
          {"<&- >&- 2>&-", false}};
}

}  // namespace rift::test
