#include "gnuplot_process.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace rift::report {
namespace {

// Anonymous files instead of pipes: a large script cannot block on a child that is itself blocked
// on its output, and a child that dies early raises no SIGPIPE.
class ScratchFile {
 public:
  ScratchFile() : file_(std::tmpfile(), &std::fclose) {
    if (!file_) throw Failure("cannot make a temporary file for gnuplot");
  }

  int Descriptor() const { return fileno(file_.get()); }

  void Write(const std::string& text) {
    if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() ||
        std::fflush(file_.get()) != 0) {
      throw Failure("cannot write the script for gnuplot");
    }
    std::rewind(file_.get());
  }

  std::string ReadAll() {
    std::rewind(file_.get());
    std::string text;
    std::array<char, 1 << 16> block;
    while (const std::size_t n = std::fread(block.data(), 1, block.size(), file_.get())) {
      text.append(block.data(), n);
    }
    return text;
  }

 private:
  static std::runtime_error Failure(const char* what) {
    return std::runtime_error(fmt::format("{}: {}", what, std::strerror(errno)));
  }

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

class SpawnActions {
 public:
  SpawnActions() { posix_spawn_file_actions_init(&actions_); }
  ~SpawnActions() { posix_spawn_file_actions_destroy(&actions_); }
  SpawnActions(const SpawnActions&) = delete;
  SpawnActions& operator=(const SpawnActions&) = delete;

  void Connect(const ScratchFile& file, int to_descriptor) {
    posix_spawn_file_actions_adddup2(&actions_, file.Descriptor(), to_descriptor);
  }
  const posix_spawn_file_actions_t* Get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

int SpawnAndWait(const SpawnActions& actions) {
  // --default-settings: a user's ~/.gnuplot must not change the figures.
  std::string program = "gnuplot", defaults = "--default-settings";
  std::array<char*, 3> arguments = {program.data(), defaults.data(), nullptr};
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, program.c_str(), actions.Get(), nullptr, arguments.data(), environ);
  if (error == ENOENT) {
    throw std::runtime_error(
        "figures need gnuplot, which is not installed: apt-get install gnuplot-nox");
  }
  if (error != 0) {
    throw std::runtime_error(fmt::format("cannot start gnuplot: {}", std::strerror(error)));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) {
      throw std::runtime_error(fmt::format("lost gnuplot: {}", std::strerror(errno)));
    }
  }
  return status;
}

// gnuplot echoes the command and a caret line before the message; one line is enough for us.
std::string OnOneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  while (!line.empty() && line.back() == ' ') line.pop_back();
  return line;
}

}  // namespace

std::string RunGnuplot(const std::string& script) {
  ScratchFile input, output, complaints;
  input.Write(script);
  SpawnActions actions;
  actions.Connect(input, STDIN_FILENO);
  actions.Connect(output, STDOUT_FILENO);
  actions.Connect(complaints, STDERR_FILENO);
  const int status = SpawnAndWait(actions);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(fmt::format("gnuplot failed: {}", OnOneLine(complaints.ReadAll())));
  }
  return output.ReadAll();
}

}  // namespace rift::report
