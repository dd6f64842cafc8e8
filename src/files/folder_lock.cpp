#include "rift/files/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

namespace rift::files {

namespace {

Descriptor Open(const std::filesystem::path& folder) { return {folder, O_RDONLY | O_DIRECTORY}; }

/// Workers of a sweep that was killed a moment ago may still be dying.
bool LockWithin(const Descriptor& folder, std::chrono::milliseconds patience) {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (::flock(folder.Number(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK && errno != EINTR) return true;  // a file system without locks
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder)
    : FolderLock(
          folder,
          fmt::format("another sweep is at work in {}: wait for it (rift sweep --status {}), "
                      "or choose another folder with --out",
                      folder.string(), folder.string())) {}

FolderLock::FolderLock(const std::filesystem::path& folder, const std::string& at_work)
    : folder_(folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw std::runtime_error(
        fmt::format("cannot make folder {}: {}", folder.string(), error.message()));
  }
  lock_ = Open(folder);
  if (!lock_.IsOpen()) {
    throw std::runtime_error(
        fmt::format("cannot open folder {}: {}", folder.string(), strerror(errno)));
  }
  if (LockWithin(lock_, std::chrono::seconds(1))) return;
  throw std::runtime_error(at_work);
}

void FolderLock::RequireInPlace() const {
  struct stat held {};
  struct stat named {};
  const bool is_there = ::fstat(lock_.Number(), &held) == 0 && ::stat(folder_.c_str(), &named) == 0;
  if (is_there && held.st_dev == named.st_dev && held.st_ino == named.st_ino) return;
  throw std::runtime_error(fmt::format(
      "folder {} was removed, moved or replaced while it was being worked in: what was written "
      "may be lost; run the same command again",
      folder_.string()));
}

bool FolderLock::IsHeld(const std::filesystem::path& folder) {
  const Descriptor lock = Open(folder);
  return lock.IsOpen() && ::flock(lock.Number(), LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
}

}  // namespace rift::files
