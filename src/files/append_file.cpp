#include "rift/files/append_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "cannot_write.hpp"

namespace rift::files {

AppendFile::AppendFile(std::filesystem::path path)
    : path_(std::move(path)), file_(path_, O_WRONLY | O_CREAT | O_EXCL | O_APPEND) {
  if (!file_.IsOpen()) CannotWrite(path_);
}

void AppendFile::Append(std::string_view text) {
  const off_t before = ::lseek(file_.Number(), 0, SEEK_END);
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(file_.Number(), text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) {
      const int reason = errno;
      const auto whole_lines = static_cast<off_t>(text.substr(0, done).rfind('\n') + 1);
      // Where even that fails a torn row stays, which readers leave out.
      if (before >= 0) std::ignore = ::ftruncate(file_.Number(), before + whole_lines);
      CannotWrite(path_, reason);
    }
    done += static_cast<size_t>(written);
  }
}

void AppendFile::Sync() {
  // EINVAL: a file system that has nothing to sync.
  if (::fdatasync(file_.Number()) != 0 && errno != EINVAL) CannotWrite(path_);
}

void AppendFile::RequireInPlace() const {
  struct stat open {};
  struct stat named {};
  if (::fstat(file_.Number(), &open) != 0) CannotWrite(path_);
  const bool is_there = ::stat(path_.c_str(), &named) == 0;
  if (is_there && open.st_dev == named.st_dev && open.st_ino == named.st_ino) return;
  throw std::runtime_error(
      fmt::format("{} was removed or moved while it was being written", path_.string()));
}

}  // namespace rift::files
