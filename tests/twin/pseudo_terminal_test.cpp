// The twin's serial port before anybody has opened it, and from program to program.

#include "twin/pseudo_terminal.hpp"

#include <fcntl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdint>
#include <vector>

#include "rift/hardware/serial_port.hpp"
#include "support/until.hpp"

namespace rift::twin {
namespace {

TEST_CASE("The twin's serial port neither echoes nor changes a byte from the beginning") {
  const PseudoTerminal robot;
  const int port = ::open(robot.path().c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK);
  REQUIRE(port >= 0);
  termios line{};
  CHECK(::tcgetattr(port, &line) == 0);
  CHECK((line.c_lflag & (ECHO | ECHONL | ICANON | ISIG | IEXTEN)) == 0);
  CHECK((line.c_iflag & (ICRNL | INLCR | IGNCR | ISTRIP | IXON)) == 0);
  CHECK((line.c_oflag & OPOST) == 0);
  CHECK((line.c_cflag & CSIZE) == CS8);
  ::close(port);
}

TEST_CASE("The twin's serial port outlives the program that had it and serves the next") {
  PseudoTerminal robot;
  for (const std::uint8_t byte : {std::uint8_t{7}, std::uint8_t{'\n'}}) {
    hardware::SerialPort host(robot.path(), 9600, 1.0);
    const std::vector<std::uint8_t> bytes{byte, 200, byte};
    CHECK(host.Write(bytes));
    std::vector<std::uint8_t> heard, back;
    test::WaitUntil("the robot heard it", [&] {
      const auto more = robot.Read();
      heard.insert(heard.end(), more.begin(), more.end());
      return heard.size() >= bytes.size();
    });
    CHECK(heard == bytes);
    robot.Write(bytes);
    test::WaitUntil("the host heard it", [&] {
      const auto more = host.Read();
      back.insert(back.end(), more.begin(), more.end());
      return back.size() >= bytes.size();
    });
    CHECK(back == bytes);
  }
}

TEST_CASE("What nobody reads does not hold up the twin, and the oldest of it is kept") {
  PseudoTerminal robot;
  hardware::SerialPort host(robot.path(), 9600, 1.0);
  std::vector<std::uint8_t> much(1'000'000);
  for (size_t i = 0; i < much.size(); ++i) much[i] = static_cast<std::uint8_t>(i % 251);
  robot.Write(much);
  std::vector<std::uint8_t> heard;
  test::WaitUntil("a thousand bytes came", [&] {
    const auto more = host.Read();
    heard.insert(heard.end(), more.begin(), more.end());
    return heard.size() >= 1000;
  });
  CHECK(heard.size() < much.size());
  CHECK(std::equal(heard.begin(), heard.begin() + 1000, much.begin()));
}

}  // namespace
}  // namespace rift::twin
