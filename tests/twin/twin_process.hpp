#pragma once

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/process.hpp"
#include "support/tree.hpp"

namespace rift::test {

/// `rift simulate --twin` at work.
class TwinProcess {
 public:
  explicit TwinProcess(const std::vector<std::string>& more = {}) {
    int out[2];
    if (::pipe(out) != 0) throw std::runtime_error("no pipe to be had");
    std::vector<std::string> words{RiftBinary(), "simulate", SourceDir() + "/configs/twin.yaml",
                                   "--twin",     "--out",    Folder()};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(out[1], STDOUT_FILENO);
      ::execv(RiftBinary().c_str(), argv.data());
      ::_exit(127);
    }
    ::close(out[1]);
    said_ = out[0];
    address_ = nlohmann::json::parse(FirstLine());
  }
  ~TwinProcess() {
    if (!is_over_) {
      ::kill(pid_, SIGKILL);
      ExitCode();
    }
    ::close(said_);
  }
  TwinProcess(const TwinProcess&) = delete;
  TwinProcess& operator=(const TwinProcess&) = delete;

  std::string Folder() const { return folder_ / "run"; }
  std::string Get(const char* key) const { return address_.at(key).get<std::string>(); }
  void Signal(int signal) const { ::kill(pid_, signal); }
  /// Waits for its end.
  int ExitCode() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    is_over_ = true;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }

 private:
  std::string FirstLine() const {
    std::string line;
    for (char c = 0;; line += c) {
      pollfd wanted{said_, POLLIN, 0};
      if (::poll(&wanted, 1, 60'000) <= 0 || ::read(said_, &c, 1) != 1) {
        throw std::runtime_error("the twin did not say where it is");
      }
      if (c == '\n') return line;
    }
  }

  TemporaryFolder folder_;
  pid_t pid_ = -1;
  int said_ = -1;
  bool is_over_ = false;
  nlohmann::json address_;
};

}  // namespace rift::test
