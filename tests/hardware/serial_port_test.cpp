#include "rift/hardware/serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <grp.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <functional>
#include <numeric>
#include <thread>

#include "pseudo_terminal.hpp"
#include "support/until.hpp"

namespace rift::hardware {
namespace {

TEST_CASE("Every byte value passes through the port unchanged both ways") {
  PseudoTerminal terminal;
  SerialPort port(terminal.path(), 9600, 0.1);
  std::vector<std::uint8_t> all(256);
  std::iota(all.begin(), all.end(), std::uint8_t{0});
  CHECK(port.Read().empty());
  CHECK(port.Write(all));
  const auto all_of = [&](const auto& read) {
    std::vector<std::uint8_t> got;
    test::WaitUntil("all bytes came", [&] {
      const auto more = read();
      got.insert(got.end(), more.begin(), more.end());
      return got.size() >= all.size();
    });
    return got;
  };
  CHECK(all_of([&] { return terminal.Read(1000); }) == all);
  terminal.Write(all);
  CHECK(all_of([&] { return port.Read(); }) == all);
  CHECK(port.Unsent() == 0);
}

TEST_CASE("A port is set to any baud rate") {
  PseudoTerminal terminal;
  for (const int baud : {9600, 115200, 12345, 3'000'000}) {
    SerialPort port(terminal.path(), baud, 0.1);
    const int other = ::open(terminal.path().c_str(), O_RDWR | O_NOCTTY);
    termios2 set{};
    if (other >= 0) {  // root is let in although the port is claimed
      REQUIRE(::ioctl(other, TCGETS2, &set) == 0);
      CHECK(set.c_ospeed == static_cast<unsigned>(baud));
      ::close(other);
    }
  }
}

TEST_CASE("A port is raw, of eight bits, and only a read that finds nothing returns none") {
  const PseudoTerminal terminal;
  const SerialPort port(terminal.path(), 19200, 0.1);
  const int other = ::open(terminal.path().c_str(), O_RDWR | O_NOCTTY);
  if (other < 0) return;  // root is let in although the port is claimed
  termios2 set{};
  REQUIRE(::ioctl(other, TCGETS2, &set) == 0);
  ::close(other);
  CHECK(set.c_iflag == 0);
  CHECK(set.c_oflag == 0);
  CHECK(set.c_lflag == 0);
  CHECK((set.c_cflag & CSIZE) == CS8);
  CHECK((set.c_cflag & (PARENB | CSTOPB | CRTSCTS)) == 0);
  CHECK((set.c_cflag & (CREAD | CLOCAL)) == (CREAD | CLOCAL));
  CHECK(set.c_ispeed == 19200);
  CHECK(set.c_ospeed == 19200);
  CHECK(set.c_cc[VMIN] == 1);
  CHECK(set.c_cc[VTIME] == 0);
}

TEST_CASE("What a port held before it was opened is neither read nor taken for an answer") {
  PseudoTerminal terminal;
  const int before = ::open(terminal.path().c_str(), O_RDWR | O_NOCTTY);
  REQUIRE(before >= 0);
  terminal.Write({'o', 'l', 'd', '\n'});
  pollfd wanted{before, POLLIN, 0};
  REQUIRE(::poll(&wanted, 1, static_cast<int>(1000 * test::kGiveUp.count())) == 1);
  SerialPort port(terminal.path(), 9600, 0.1);
  CHECK(port.Read().empty());
  ::close(before);
}

TEST_CASE("A port that cannot be had is refused with what to do") {
  CHECK_THROWS_WITH(SerialPort("/dev/no_such_port", 9600, 0.1),
                    Catch::Contains("no serial port /dev/no_such_port"));
  CHECK_THROWS_WITH(SerialPort("/dev/null", 9600, 0.1), Catch::Contains("is no serial port"));
  // Nobody, not even root, may write to this file, whose group has no ports; where /sys is mounted
  // to be read only, the reason is another one.
  const std::string forbidden = "/sys/devices/system/cpu/online";
  if (::open(forbidden.c_str(), O_RDWR | O_CLOEXEC) < 0 && errno == EACCES) {
    CHECK_THROWS_WITH(SerialPort(forbidden, 9600, 0.1),
                      Catch::Contains("no permission to open") &&
                          Catch::Contains("its group (root) does not give it to people"));
  }
  PseudoTerminal terminal;
  const SerialPort first(terminal.path(), 9600, 0.1);
  CHECK_THROWS_WITH(SerialPort(terminal.path(), 9600, 0.1),
                    Catch::Contains("in use by another program"));
}

TEST_CASE("Each reason why a port is not opened is told in whole with the port's name") {
  CHECK_THROWS_WITH(SerialPort("/dev/no_such_port", 9600, 0.1),
                    "there is no serial port /dev/no_such_port: plug it in or bind it (rfcomm "
                    "bind, a BLE bridge), and look with ls /dev/tty* /dev/rfcomm*");
  CHECK_THROWS_WITH(SerialPort("/dev/null", 9600, 0.1), "/dev/null is no serial port");
  CHECK_THROWS_WITH(SerialPort("/tmp", 9600, 0.1),
                    "cannot open the serial port /tmp: Is a directory");
  CHECK_THROWS_WITH(SerialPort("/dev/null/port", 9600, 0.1),
                    "cannot open the serial port /dev/null/port: Not a directory");
  const PseudoTerminal terminal;
  const SerialPort first(terminal.path(), 9600, 0.1);
  CHECK_THROWS_WITH(SerialPort(terminal.path(), 9600, 0.1),
                    fmt::format("{0} is in use by another program: end it first (fuser {0} names "
                                "it)",
                                terminal.path()));
}

/// What a child of the test's own has to tell.
std::string ToldInChild(const std::function<std::string()>& tell) {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const std::string told = tell();
    ::_exit(::write(ends[1], told.data(), told.size()) < 0 ? 1 : 0);
  }
  ::close(ends[1]);
  std::array<char, 1024> told{};
  const ssize_t length = ::read(ends[0], told.data(), told.size());
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return {told.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0))};
}

/// Why somebody who is neither root nor in the file's group may not open it.
std::string ToldNobody(const std::string& path) {
  return ToldInChild([&path]() -> std::string {
    constexpr unsigned kNobody = 65534;
    if (::setgroups(0, nullptr) != 0 || ::setresgid(kNobody, kNobody, kNobody) != 0 ||
        ::setresuid(kNobody, kNobody, kNobody) != 0) {
      return "still root";
    }
    try {
      const SerialPort port(path, 9600, 0.1);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "opened";
  });
}

TEST_CASE("Who may not open a port is told of its group where that is one for ports") {
  // Only root gives a file to another group, and not in every container.
  if (::geteuid() != 0 || ToldNobody("/dev/null") == "still root") return;
  std::array<char, 32> path{"/tmp/rift_no_port_XXXXXX"};
  const int file = ::mkstemp(path.data());
  REQUIRE(file >= 0);
  const std::string port = path.data();
  const auto told = [&](gid_t group, mode_t mode) {
    REQUIRE(::fchown(file, 0, group) == 0);
    REQUIRE(::fchmod(file, mode) == 0);
    return ToldNobody(port);
  };
  const auto of_group = [&](const std::string& name) {
    return fmt::format(
        "no permission to open {1}: its group ({0}) does not give it to people: run sudo chgrp "
        "dialout {1} && sudo chmod g+rw {1}, which holds until it is plugged in again, and be a "
        "member of dialout",
        name, port);
  };
  for (const char* name : {"dialout", "uucp", "plugdev"}) {
    const group* owner = ::getgrnam(name);
    if (owner == nullptr) continue;
    const gid_t id = owner->gr_gid;
    INFO(name);
    CHECK(told(id, 0660) ==
          fmt::format("no permission to open {1}: it belongs to group {0}: run sudo usermod -aG "
                      "{0} $USER and log in again",
                      name, port));
    // A member of a group that may only read or only write cannot drive.
    CHECK(told(id, 0640) == of_group(name));
    CHECK(told(id, 0620) == of_group(name));
    CHECK(told(id, 0600) == of_group(name));
  }
  CHECK(told(0, 0660) == of_group("root"));
  constexpr gid_t kOfNobody = 4'123'456;
  if (::fchown(file, 0, kOfNobody) == 0) CHECK(told(kOfNobody, 0660) == of_group("unknown"));
  ::close(file);
  ::unlink(port.c_str());
}

/// What a process with this as its terminal is told when it opens it, in a child.
std::string ToldOfOwn(const std::string& terminal) {
  return ToldInChild([&terminal] {
    ::setsid();
    const int own = ::open(terminal.c_str(), O_RDWR);
    std::string told = ::ioctl(own, TIOCSCTTY, 0) == 0 ? "nothing" : "no terminal of its own";
    try {
      const SerialPort port(terminal, 9600, 0.1);
    } catch (const std::invalid_argument& error) {
      told = error.what();
    }
    termios2 line{};
    if (::ioctl(own, TCGETS2, &line) != 0 || (line.c_lflag & ECHO) == 0) told += ", without echo";
    return told;
  });
}

TEST_CASE("The terminal that rift was started from is no port, and keeps its echo") {
  const PseudoTerminal terminal;
  CHECK(ToldOfOwn(terminal.path()) ==
        terminal.path() + " is the terminal that rift was started from, and no robot");
}

TEST_CASE("A port closed at the other end is gone for reading and writing") {
  PseudoTerminal terminal;
  SerialPort port(terminal.path(), 9600, 0.1);
  terminal.Close();
  CHECK_THROWS_AS(port.Read(), LineGone);
  CHECK_THROWS_WITH(port.Read(), Catch::Contains(terminal.path() + " went away: ") &&
                                     (Catch::Contains("the other end was closed") ||
                                      Catch::Contains("Input/output error")));
  errno = EINTR;  // of an earlier call
  CHECK_THROWS_AS(port.Read(), LineGone);
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  CHECK_THROWS_AS(port.Write(bytes), LineGone);
}

TEST_CASE("A write larger than the port holds goes on as it is read, byte for byte") {
  PseudoTerminal terminal;
  const auto patience_s = static_cast<double>(test::kGiveUp.count()) / 10.0;
  SerialPort port(terminal.path(), 9600, patience_s);
  std::vector<std::uint8_t> much(200'000);
  for (size_t i = 0; i < much.size(); ++i) much[i] = static_cast<std::uint8_t>(i % 251);
  std::vector<std::uint8_t> got;
  std::thread reader([&] {
    while (got.size() < much.size()) {
      const auto more = terminal.Read(static_cast<int>(1000.0 * patience_s));
      if (more.empty()) return;
      got.insert(got.end(), more.begin(), more.end());
    }
  });
  CHECK(port.Write(much));
  reader.join();
  CHECK(got == much);
}

TEST_CASE("A write that waits for its reader ends when that goes away") {
  PseudoTerminal terminal;
  SerialPort port(terminal.path(), 9600, static_cast<double>(test::kGiveUp.count()) / 10.0);
  const std::vector<std::uint8_t> much(1'000'000, 'x');
  std::thread reader([&] {
    terminal.Read(static_cast<int>(1000 * test::kGiveUp.count()));
    terminal.Close();
  });
  CHECK_THROWS_WITH(port.Write(much),
                    Catch::StartsWith("the serial port " + terminal.path() + " went away: "));
  reader.join();
}

TEST_CASE("A write to a port that nobody reads gives up") {
  PseudoTerminal terminal;
  SerialPort port(terminal.path(), 9600, 0.05);
  const std::vector<std::uint8_t> much(1'000'000, 'x');
  CHECK_FALSE(port.Write(much));
}

}  // namespace
}  // namespace rift::hardware
