#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace rift::files {

/// An open file, closed at the end of its scope.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& path, int flags)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  /// Closes it. False, with errno, when the system could not keep what was written: over a network
  /// a quota or a full disk is told as late as this.
  bool Close() { return ::close(std::exchange(number_, -1)) == 0; }

  bool IsOpen() const { return number_ >= 0; }
  int Number() const { return number_; }

 private:
  int number_;
};

[[noreturn]] inline void CannotWrite(const std::filesystem::path& path, int reason = errno) {
  throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), strerror(reason)));
}

}  // namespace rift::files
