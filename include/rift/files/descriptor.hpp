#pragma once

#include <fcntl.h>
#include <sys/types.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

namespace rift::files {

/// A descriptor of the system (a file, a socket, a terminal), closed at the end of its scope.
class Descriptor {
 public:
  Descriptor() = default;
  /// Takes over what a call of the system gave; negative: none.
  explicit Descriptor(int number) : number_(number) {}
  /// Opens a file; one that O_CREAT makes is for those of `mode`, less the umask.
  Descriptor(const std::filesystem::path& path, int flags, mode_t mode = 0666)
      : number_(::open(path.c_str(), flags | O_CLOEXEC, mode)) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  /// `other` closes what was held here.
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  /// Closes it. False, with errno, when the system could not keep what was written: over a network
  /// a quota or a full disk is told as late as this.
  bool Close() { return ::close(std::exchange(number_, -1)) == 0; }

  bool IsOpen() const { return number_ >= 0; }
  int Number() const { return number_; }

 private:
  int number_ = -1;
};

}  // namespace rift::files
