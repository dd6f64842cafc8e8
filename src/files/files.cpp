#include "rift/files/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "cannot_write.hpp"
#include "rift/files/descriptor.hpp"
#include "rift/limits/limits.hpp"

namespace rift::files {

namespace {

[[noreturn]] void CannotRead(const std::filesystem::path& path) {
  throw std::invalid_argument(fmt::format("cannot read {}: {}", path.string(), strerror(errno)));
}

size_t ReadSome(const Descriptor& file, char* into, size_t most,
                const std::filesystem::path& path) {
  while (true) {
    const ssize_t got = ::read(file.Number(), into, most);
    if (got >= 0) return static_cast<size_t>(got);
    if (errno != EINTR) CannotRead(path);
  }
}

/// A hint only: a pipe has no size and a growing log has more.
size_t SizeOf(const Descriptor& file) {
  struct stat about {};
  const bool has_size = ::fstat(file.Number(), &about) == 0 && S_ISREG(about.st_mode);
  return has_size ? static_cast<size_t>(about.st_size) : 0;
}

bool WriteWhole(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    text.remove_prefix(static_cast<size_t>(written));
  }
  return true;
}

/// A pipe or a device cannot be renamed over; what goes there goes straight through.
void WriteThrough(const std::filesystem::path& path, std::string_view text) {
  Descriptor file(path, O_WRONLY);
  if (!file.IsOpen() || !WriteWhole(file.Number(), text) || !file.Close()) CannotWrite(path);
}

/// The stream of this process that writes to that file, as /dev/stdout does, if any.
std::FILE* StreamTo(const std::filesystem::path& path) {
  struct stat target {};
  if (::stat(path.c_str(), &target) != 0) return nullptr;
  for (std::FILE* stream : {stdout, stderr}) {
    struct stat own {};
    const bool is_open = ::fstat(::fileno(stream), &own) == 0;
    if (is_open && own.st_dev == target.st_dev && own.st_ino == target.st_ino) return stream;
  }
  return nullptr;
}

/// To where the stream is by now, after what was printed before.
void WriteOn(std::FILE* stream, const std::filesystem::path& path, std::string_view text) {
  if (std::fflush(stream) != 0 || !WriteWhole(::fileno(stream), text)) CannotWrite(path);
}

/// The file behind a link, there or not.
std::filesystem::path Followed(const std::filesystem::path& link) {
  constexpr int kMostLinks = 40;
  std::error_code error;
  std::filesystem::path path = link;
  for (int i = 0; i < kMostLinks && std::filesystem::is_symlink(path, error); ++i) {
    const std::filesystem::path next = std::filesystem::read_symlink(path, error);
    path = path.parent_path() / next;  // of an absolute one the first part is dropped
  }
  if (!std::filesystem::is_symlink(path, error)) return path;
  errno = ELOOP;
  CannotWrite(link);
}

}  // namespace

std::string ReadFile(const std::filesystem::path& path) {
  const Descriptor file(path, O_RDONLY);
  if (!file.IsOpen()) CannotRead(path);
  limits::Require(limits::Amount::kFileBytes, static_cast<double>(SizeOf(file)), path.string());
  // One byte more finds the end of the file without another, larger block.
  std::string text(std::max<size_t>(SizeOf(file) + 1, 4096), '\0');
  size_t used = 0;
  while (true) {
    if (used == text.size()) text.resize(2 * used);
    const size_t got = ReadSome(file, text.data() + used, text.size() - used, path);
    used += got;
    if (got == 0) break;
    // A pipe or a device may have no end.
    if (used > SizeOf(file)) {
      limits::Require(limits::Amount::kFileBytes, static_cast<double>(used), path.string());
    }
  }
  text.resize(used);
  return text;
}

std::optional<std::string> ReadIfThere(const std::filesystem::path& path) {
  std::error_code unknown;
  const bool is_missing = !std::filesystem::exists(path, unknown) && !unknown;
  return is_missing ? std::nullopt : std::optional(ReadFile(path));
}

void WriteFile(const std::filesystem::path& target, std::string_view text) {
  if (std::FILE* const stream = StreamTo(target)) return WriteOn(stream, target, text);
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(target, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    return WriteThrough(target, text);
  }
  const std::filesystem::path path = Followed(target);
  error.clear();
  if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), error);
  if (error) {
    throw std::runtime_error(
        fmt::format("cannot make folder {}: {}", path.parent_path().string(), error.message()));
  }
  const std::filesystem::path beside = path.string() + fmt::format(".{}.part", ::getpid());
  {
    Descriptor file(beside, O_WRONLY | O_CREAT | O_TRUNC);
    if (!file.IsOpen()) CannotWrite(path);
    if (!WriteWhole(file.Number(), text) || !file.Close()) {
      const int reason = errno;
      std::filesystem::remove(beside, error);
      errno = reason;
      CannotWrite(path);
    }
  }
  std::filesystem::rename(beside, path, error);
  if (error) {
    const std::error_code reason = error;
    std::filesystem::remove(beside, error);
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), reason.message()));
  }
}

std::string FindInput(const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code not_there;
  if (name.empty() || fs::path(name).is_absolute() || fs::exists(name, not_there)) return name;
  const fs::path program = fs::read_symlink("/proc/self/exe", not_there);
  // PREFIX/bin/rift, or PREFIX/lib/rift/rift-camera.
  for (const fs::path& prefix :
       {program.parent_path().parent_path(), program.parent_path().parent_path().parent_path()}) {
    const fs::path installed = prefix / "share" / "rift" / name;
    if (fs::exists(installed, not_there)) return installed.string();
  }
  return name;
}

std::error_code RemoveAll(const std::filesystem::path& path) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::error_code error;
  do {
    std::filesystem::remove_all(path, error);
    // Or renamed between its listing and its removal.
    const bool is_written_to =
        error == std::errc::directory_not_empty || error == std::errc::no_such_file_or_directory;
    if (!is_written_to) return error;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  } while (std::chrono::steady_clock::now() < end);
  return error;
}

bool IsStandardStream(const std::filesystem::path& path) { return StreamTo(path) != nullptr; }

bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code not_there;
  return std::filesystem::absolute(a).lexically_normal() ==
             std::filesystem::absolute(b).lexically_normal() ||
         std::filesystem::equivalent(a, b, not_there);
}

}  // namespace rift::files
