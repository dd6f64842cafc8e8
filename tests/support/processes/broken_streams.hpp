#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/processes/process.hpp"

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

/// A pipe whose reader does not read, as that of a program that was stopped: what writes to it when
/// it is full waits until Drain().
class UnreadPipe {
 public:
  explicit UnreadPipe(const std::string& path) : path_(path) {
    if (::mkfifo(path.c_str(), 0600) != 0) throw std::runtime_error("cannot make a pipe");
    end_ = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (end_ < 0) throw std::runtime_error("cannot open a pipe");
  }
  ~UnreadPipe() { ::close(end_); }
  UnreadPipe(const UnreadPipe&) = delete;
  UnreadPipe& operator=(const UnreadPipe&) = delete;

  const std::string& Path() const { return path_; }
  void Fill() const {
    while (::write(end_, " ", 1) == 1) {
    }
  }
  /// All that it holds now, without what Fill() put there.
  std::string Drain() const {
    std::string text;
    std::array<char, 4096> block;
    for (ssize_t got = 0; (got = ::read(end_, block.data(), block.size())) > 0;) {
      text.append(block.data(), static_cast<std::size_t>(got));
    }
    text.erase(0, text.find_first_not_of(' '));
    return text;
  }

 private:
  std::string path_;
  int end_ = -1;
};

}  // namespace rift::test
