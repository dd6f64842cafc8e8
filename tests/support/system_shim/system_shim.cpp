// A system in trouble, for LD_PRELOAD. What is wrong with it is said by the environment:
//   RIFT_SHIM_QUOTA        a folder whose owner has so many bytes left as ...
//   RIFT_SHIM_QUOTA_BYTES  ... says; then writes below it fail with EDQUOT
//   RIFT_SHIM_QUOTA_LATE   set: they succeed, and close and fdatasync tell, as over a network
//   RIFT_SHIM_CLOCK        set: the wall clock jumps an hour ahead or back each time it is read
#include <dlfcn.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <string>

namespace {

template <class Function>
Function* Next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

std::atomic<long> used = 0;

bool IsInFolder(int descriptor) {
  const char* folder = std::getenv("RIFT_SHIM_QUOTA");
  if (folder == nullptr) return false;
  std::array<char, 4096> path{};
  const std::string link = "/proc/self/fd/" + std::to_string(descriptor);
  const ssize_t length = ::readlink(link.c_str(), path.data(), path.size() - 1);
  return length > 0 && std::string(path.data()).starts_with(std::string(folder) + "/");
}

bool IsLate() { return std::getenv("RIFT_SHIM_QUOTA_LATE") != nullptr; }

bool IsOver(std::size_t more) {
  const char* bytes = std::getenv("RIFT_SHIM_QUOTA_BYTES");
  return (used += static_cast<long>(more)) > (bytes == nullptr ? 0 : std::atol(bytes));
}

/// Sets errno when the write is refused.
bool IsRefused(int descriptor, std::size_t more) {
  if (!IsInFolder(descriptor) || !IsOver(more) || IsLate()) return false;
  errno = EDQUOT;
  return true;
}

bool IsRefusedLate(int descriptor) {
  if (!IsLate() || !IsInFolder(descriptor) || !IsOver(0)) return false;
  errno = EDQUOT;
  return true;
}

long Jump_s() {
  static std::atomic<unsigned> reads = 0;
  if (std::getenv("RIFT_SHIM_CLOCK") == nullptr) return 0;
  return ++reads % 2 == 0 ? 3600 : -3600;
}

}  // namespace

extern "C" {

ssize_t write(int descriptor, const void* bytes, size_t count) {
  static auto* const real = Next<decltype(write)>("write");
  return IsRefused(descriptor, count) ? -1 : real(descriptor, bytes, count);
}

ssize_t writev(int descriptor, const iovec* parts, int count) {
  static auto* const real = Next<decltype(writev)>("writev");
  size_t bytes = 0;
  for (int i = 0; i < count; ++i) bytes += parts[i].iov_len;
  return IsRefused(descriptor, bytes) ? -1 : real(descriptor, parts, count);
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t at) {
  static auto* const real = Next<decltype(pwrite)>("pwrite");
  return IsRefused(descriptor, count) ? -1 : real(descriptor, bytes, count, at);
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t at) {
  static auto* const real = Next<decltype(pwrite64)>("pwrite64");
  return IsRefused(descriptor, count) ? -1 : real(descriptor, bytes, count, at);
}

int close(int descriptor) {
  static auto* const real = Next<decltype(close)>("close");
  const bool is_refused = IsRefusedLate(descriptor);
  const int closed = real(descriptor);
  if (is_refused) errno = EDQUOT;
  return is_refused ? -1 : closed;
}

int fdatasync(int descriptor) {
  static auto* const real = Next<decltype(fdatasync)>("fdatasync");
  return IsRefusedLate(descriptor) ? -1 : real(descriptor);
}

int clock_gettime(clockid_t clock, timespec* now) noexcept {
  static auto* const real = Next<int(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, now);
  const bool is_wall = clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE;
  if (is_wall) now->tv_sec += Jump_s();
  return result;
}

int gettimeofday(timeval* now, void*) noexcept {
  timespec exact{};
  clock_gettime(CLOCK_REALTIME, &exact);
  now->tv_sec = exact.tv_sec;
  now->tv_usec = exact.tv_nsec / 1000;
  return 0;
}

time_t time(time_t* now) noexcept {
  timespec exact{};
  clock_gettime(CLOCK_REALTIME, &exact);
  if (now != nullptr) *now = exact.tv_sec;
  return exact.tv_sec;
}

}  // extern "C"
