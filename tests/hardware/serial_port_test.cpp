#include "rift/hardware/serial_port.hpp"

#include <asm/termbits.h>
#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#include <numeric>

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

/// What a process with this as its terminal is told when it opens it, in the test's own child.
std::string ToldOfOwn(const std::string& terminal) {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
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
    if (::write(ends[1], told.data(), told.size()) < 0) ::_exit(1);
    ::_exit(0);
  }
  ::close(ends[1]);
  std::array<char, 512> told{};
  const ssize_t length = ::read(ends[0], told.data(), told.size());
  ::close(ends[0]);
  ::waitpid(child, nullptr, 0);
  return {told.data(), static_cast<std::size_t>(std::max<ssize_t>(length, 0))};
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
  const std::vector<std::uint8_t> bytes{1, 2, 3};
  CHECK_THROWS_AS(port.Write(bytes), LineGone);
}

TEST_CASE("A write to a port that nobody reads gives up") {
  PseudoTerminal terminal;
  SerialPort port(terminal.path(), 9600, 0.05);
  const std::vector<std::uint8_t> much(1'000'000, 'x');
  CHECK_FALSE(port.Write(much));
}

}  // namespace
}  // namespace rift::hardware
