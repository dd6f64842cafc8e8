#include "before_each.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

namespace rift::sessions {
namespace {

constexpr int kNotFound = 127;  // as shells have it
constexpr std::chrono::seconds kPatience{10};

/// In the child: nothing but system calls, since other threads may hold any lock.
[[noreturn]] void Become(const std::vector<char*>& words, int output, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(kNotFound);  // it ended before the line above
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::execvp(words.front(), words.data());
  ::_exit(kNotFound);
}

/// The next line; none at the end of the output. Throws std::runtime_error for one without an end.
std::optional<std::string> ReadLine(int descriptor) {
  constexpr std::size_t kMostBytes = 65536;
  std::string line;
  char c = 0;
  while (true) {
    const ssize_t got = ::read(descriptor, &c, 1);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return line.empty() ? std::nullopt : std::optional(line);
    if (c == '\n') return line;
    line += c;
    if (line.size() > kMostBytes) {
      throw std::runtime_error(
          fmt::format("--before-each: a line of more than {} bytes was printed", kMostBytes));
    }
  }
}

/// Until the output ends, or at most so long after it is asked to stop.
void ThrowAway(const std::stop_token& is_over, int descriptor) {
  constexpr int kLook_ms = 50;
  std::array<char, 65536> bytes;
  while (!is_over.stop_requested()) {
    pollfd output{descriptor, POLLIN, 0};
    if (::poll(&output, 1, kLook_ms) <= 0) continue;
    const ssize_t got = ::read(descriptor, bytes.data(), bytes.size());
    if (got == 0 || (got < 0 && errno != EINTR)) return;
  }
}

int WaitFor(pid_t pid) {
  int status = 0;
  while (::waitpid(pid, &status, 0) < 0 && errno == EINTR) continue;
  return status;
}

bool EndsWithin(pid_t pid, std::chrono::seconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::waitpid(pid, nullptr, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}

std::string HowItEnded(int status) {
  if (WIFSIGNALED(status)) return fmt::format("was ended by signal {}", WTERMSIG(status));
  const int code = WEXITSTATUS(status);
  return code == kNotFound ? "could not be run" : fmt::format("ended with {}", code);
}

}  // namespace

DriveAddress AddressOf(const std::string& json) {
  DriveAddress address;
  try {
    const nlohmann::json said = nlohmann::json::parse(json);
    for (auto [key, value] : {std::pair{"port", &address.port},
                              {"camera", &address.camera},
                              {"calibration", &address.calibration}}) {
      if (said.contains(key)) *value = said.at(key).get<std::string>();
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::invalid_argument(
        fmt::format("--before-each said '{}', which is no object of port, camera and calibration: "
                    "{}",
                    json, error.what()));
  }
  return address;
}

SceneCommand::SceneCommand(const std::vector<std::string>& words) : name_(words.front()) {
  std::vector<std::string> copies = words;
  std::vector<char*> arguments;
  for (std::string& word : copies) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    throw std::runtime_error(fmt::format("no pipe to be had: {}", strerror(errno)));
  }
  output_ = files::Descriptor(ends[0]);
  files::Descriptor theirs(ends[1]);
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) Become(arguments, theirs.Number(), parent);
  if (pid_ < 0) throw std::runtime_error(fmt::format("cannot run {}: {}", name_, strerror(errno)));
  ::setpgid(pid_, pid_);  // whichever of the two comes first
  theirs = {};
  try {
    while (const auto line = ReadLine(output_.Number())) {
      if (!line->starts_with('{')) continue;
      address_ = AddressOf(*line);
      rest_ = std::jthread(ThrowAway, output_.Number());
      return;
    }
  } catch (...) {
    End();
    throw;
  }
  output_ = {};
  const int status = WaitFor(std::exchange(pid_, -1));
  if (status != 0) {
    throw std::runtime_error(fmt::format("--before-each: {} {}", name_, HowItEnded(status)));
  }
}

void SceneCommand::End() {
  if (pid_ < 0) return;
  ::kill(-pid_, SIGTERM);
  if (!EndsWithin(pid_, kPatience)) {
    ::kill(-pid_, SIGKILL);
    WaitFor(pid_);
  }
  rest_ = {};  // before its output is closed
  output_ = {};
  pid_ = -1;
}

SceneCommand::~SceneCommand() { End(); }

}  // namespace rift::sessions
