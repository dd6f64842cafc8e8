#pragma once

#include <sched.h>
#include <sys/mount.h>

#include <filesystem>
#include <stdexcept>
#include <string>

namespace rift::test {

/// A disk of a few pages (tmpfs) in a folder, for this process and those that it starts. Root alone
/// may have one.
class SmallDisk {
 public:
  explicit SmallDisk(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_);
    // Of its own name space, so that nothing stays behind when the process is killed.
    is_there_ = ::unshare(CLONE_NEWNS) == 0 &&
                ::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) == 0 &&
                ::mount("tmpfs", folder_.c_str(), "tmpfs", 0, "size=64m") == 0;
  }
  ~SmallDisk() {
    if (is_there_) ::umount2(folder_.c_str(), MNT_DETACH);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

  /// False where this process may not mount.
  bool IsThere() const { return is_there_; }
  /// What is on it must fit.
  void Resize(int kbyte) { Remount(0, "size=" + std::to_string(kbyte) + "k"); }
  void MakeReadOnly() { Remount(MS_RDONLY, ""); }

 private:
  void Remount(unsigned long flags, const std::string& options) {
    if (::mount("tmpfs", folder_.c_str(), "tmpfs", MS_REMOUNT | flags, options.c_str()) != 0) {
      throw std::runtime_error("cannot change the disk in " + folder_.string());
    }
  }

  std::filesystem::path folder_;
  bool is_there_ = false;
};

}  // namespace rift::test

/// Ends the test case, visibly: CTest counts it as skipped.
#define RIFT_SKIP_WITHOUT(disk)                             \
  if (!(disk).IsThere()) {                                  \
    WARN("SKIPPED: this process may mount no disk (root)"); \
    return;                                                 \
  }
