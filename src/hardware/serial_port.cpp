// The kernel's own termios, since glibc's knows only a list of baud rates.
#include "rift/hardware/serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "rift/vision/camera/steady_now.hpp"

namespace rift::hardware {

double SteadyClock::Now_s() { return vision::SteadyNow_s(); }

void SteadyClock::Wait(double dt_s) {
  std::this_thread::sleep_for(std::chrono::duration<double>(dt_s));
}

namespace {

/// Only membership in a group that is there for serial ports is advised: that of root gives far
/// more than a port.
std::string PermissionAdvice(const std::string& path) {
  struct stat about {};
  const bool is_known = ::stat(path.c_str(), &about) == 0;
  const group* owner = is_known ? ::getgrgid(about.st_gid) : nullptr;
  const std::string name = owner != nullptr ? owner->gr_name : "";
  const bool is_for_ports = name == "dialout" || name == "uucp" || name == "plugdev";
  const bool may_group = (about.st_mode & (S_IRGRP | S_IWGRP)) == (S_IRGRP | S_IWGRP);
  if (is_for_ports && may_group) {
    return fmt::format("it belongs to group {0}: run sudo usermod -aG {0} $USER and log in again",
                       name);
  }
  return fmt::format(
      "its group ({}) does not give it to people: run sudo chgrp dialout {} && sudo chmod g+rw {}, "
      "which holds until it is plugged in again, and be a member of dialout",
      name.empty() ? "unknown" : name, path, path);
}

std::string WhyNotOpened(const std::string& path, int reason) {
  switch (reason) {
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return fmt::format(
          "there is no serial port {}: plug it in or bind it (rfcomm bind, a BLE bridge), and look "
          "with ls /dev/tty* /dev/rfcomm*",
          path);
    case EACCES:
    case EPERM:
      return fmt::format("no permission to open {}: {}", path, PermissionAdvice(path));
    case EBUSY:
    case EWOULDBLOCK:
      return fmt::format("{} is in use by another program: end it first (fuser {} names it)", path,
                         path);
    default:
      return fmt::format("cannot open the serial port {}: {}", path, strerror(reason));
  }
}

int RemainingMs(std::chrono::steady_clock::time_point end) {
  const auto left =
      std::chrono::duration_cast<std::chrono::milliseconds>(end - std::chrono::steady_clock::now());
  return static_cast<int>(std::max<std::int64_t>(left.count(), 0));
}

}  // namespace

SerialPort::SerialPort(const std::string& path, int baud, double write_timeout_s)
    : path_(path),
      write_timeout_s_(write_timeout_s),
      descriptor_(::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
  if (descriptor_ < 0) throw std::runtime_error(WhyNotOpened(path, errno));
  try {
    Claim();
    Configure(baud);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

SerialPort::~SerialPort() { ::close(descriptor_); }

// TIOCEXCL keeps others out, but not root; the lock keeps out whoever asks for it.
void SerialPort::Claim() {
  if (::isatty(descriptor_) == 0) {
    throw std::runtime_error(fmt::format("{} is no serial port", path_));
  }
  // One digit away from the twin's /dev/pts/N, and without echo and Ctrl-C once it is configured.
  if (pid_t session = 0; ::ioctl(descriptor_, TIOCGSID, &session) == 0) {
    throw std::invalid_argument(
        fmt::format("{} is the terminal that rift was started from, and no robot", path_));
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 || ::ioctl(descriptor_, TIOCEXCL) != 0) {
    throw std::runtime_error(WhyNotOpened(path_, errno));
  }
}

void SerialPort::Configure(int baud) {
  termios2 line{};
  if (::ioctl(descriptor_, TCGETS2, &line) != 0) ThrowGone(errno);
  line.c_iflag = 0;
  line.c_oflag = 0;
  line.c_lflag = 0;
  line.c_cflag = CS8 | CREAD | CLOCAL | BOTHER | (BOTHER << IBSHIFT);
  line.c_ispeed = line.c_ospeed = static_cast<speed_t>(baud);
  line.c_cc[VMIN] = 1;  // so that nothing to read and hung up are different answers
  line.c_cc[VTIME] = 0;
  if (::ioctl(descriptor_, TCSETS2, &line) != 0) {
    throw std::invalid_argument(
        fmt::format("{} does not do {} baud: {}", path_, baud, strerror(errno)));
  }
  termios2 set{};
  constexpr double kUartTolerance = 0.02;  // a receiver samples the ninth bit up to half a bit off
  if (::ioctl(descriptor_, TCGETS2, &set) != 0 ||
      std::abs(static_cast<double>(set.c_ospeed) - baud) > kUartTolerance * baud) {
    throw std::invalid_argument(
        fmt::format("{} does not do {} baud, the nearest is {}", path_, baud, set.c_ospeed));
  }
  ::ioctl(descriptor_, TCFLSH, TCIOFLUSH);
}

void SerialPort::ThrowGone(int reason) const {
  throw LineGone(fmt::format("the serial port {} went away: {}", path_,
                             reason == 0 ? "the other end was closed" : strerror(reason)));
}

bool SerialPort::Write(Bytes bytes) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::microseconds(std::llround(1e6 * write_timeout_s_));
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written > 0) {
      bytes = bytes.subspan(static_cast<size_t>(written));
      continue;
    }
    if (written < 0 && errno != EAGAIN && errno != EINTR) ThrowGone(errno);
    const int remaining_ms = RemainingMs(end);
    if (remaining_ms == 0) return false;
    pollfd wanted{descriptor_, POLLOUT, 0};
    ::poll(&wanted, 1, remaining_ms);
    if ((wanted.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) ThrowGone(0);
  }
  return true;
}

std::vector<std::uint8_t> SerialPort::Read() {
  constexpr size_t kMost = 65536;  // a device that never stops talking must not hold us here
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 4096> chunk;
  while (bytes.size() < kMost) {
    const ssize_t got = ::read(descriptor_, chunk.data(), chunk.size());
    if (got > 0) {
      bytes.insert(bytes.end(), chunk.begin(), chunk.begin() + got);
      continue;
    }
    if (got < 0 && errno == EINTR) continue;
    if (!bytes.empty() || (got < 0 && errno == EAGAIN)) break;
    ThrowGone(got < 0 ? errno : 0);
  }
  return bytes;
}

size_t SerialPort::Unsent() {
  int waiting = 0;
  if (::ioctl(descriptor_, TIOCOUTQ, &waiting) != 0) ThrowGone(errno);
  return static_cast<size_t>(waiting);
}

}  // namespace rift::hardware
