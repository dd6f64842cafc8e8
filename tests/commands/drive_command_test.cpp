#include <catch2/catch.hpp>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "hardware/pseudo_terminal.hpp"
#include "rift/hardware/listener.hpp"
#include "rift/hardware/serial_port.hpp"
#include "support/inputs/wire_bytes.hpp"
#include "support/processes/broken_streams.hpp"
#include "support/processes/process.hpp"
#include "support/until.hpp"

namespace rift {
namespace {

/// A robot behind a pseudo terminal, answering until its scope ends.
class RobotBehindTerminal {
 public:
  explicit RobotBehindTerminal(bool answers)
      : thread_([this, answers](const std::stop_token& stop) {
          hardware::Listener listener;
          hardware::SteadyClock clock;
          while (!stop.stop_requested()) {
            const auto heard = terminal_.Read(5);
            const std::lock_guard lock(mutex_);
            heard_.insert(heard_.end(), heard.begin(), heard.end());
            const auto said = listener.Poll(static_cast<std::uint32_t>(1000.0 * clock.Now_s()),
                                            heard, {10, 20, 4800});
            if (answers) terminal_.Write(said);
          }
        }) {}
  const std::string& path() const { return terminal_.path(); }
  std::vector<std::uint8_t> Heard() {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  std::mutex mutex_;
  std::vector<std::uint8_t> heard_;
  hardware::PseudoTerminal terminal_;
  std::jthread thread_;
};

TEST_CASE("Ping tells how the link is and which keys it sets") {
  const RobotBehindTerminal robot(true);
  const test::TemporaryFolder folder;
  // A budget that a loaded machine keeps as well.
  test::WriteText(folder / "lenient.yaml",
                  "hardware: {line: {hello_s: 30},\n"
                  "           ping: {max_p99_s: 10, max_loss: 0.9, max_burst: 500}}\n");
  const test::ProcessResult result =
      test::RunRift({"drive", folder / "lenient.yaml", "--ping", "--port", robot.path(), "--json"});
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  const auto json = nlohmann::json::parse(result.out);
  CHECK(json["protocol"] == "framed");
  CHECK(json["sent"] > 10);
  CHECK(json["answered"] > 5);
  CHECK(json["battery_v"] == Approx(4.8));
  CHECK(json["p50_s"] > 0.0);
  CHECK(json["set"].contains("hardware.stopping.delay_s"));
}

TEST_CASE("Ping of a robot that never answers says that it cannot be measured") {
  const RobotBehindTerminal robot(false);
  const test::ProcessResult result = test::RunRift({"drive", "--ping", "--port", robot.path()});
  CHECK(result.exit_code == 1);
  CHECK_THAT(result.out, Catch::Contains("a 3pi+ answers with src/firmware on it"));
}

TEST_CASE("A robot hears nothing but commands when the streams of a ping are closed or full") {
  RobotBehindTerminal robot(true);
  const test::TemporaryFolder folder;
  test::WriteText(folder / "lenient.yaml",
                  "hardware: {line: {hello_s: 30},\n"
                  "           ping: {max_p99_s: 10, max_loss: 0.9, max_burst: 500}}\n");
  for (const test::Streams& streams : test::BrokenStreams(folder)) {
    test::ProcessResult result;
    // A machine that stands still for seconds answers nothing: exit 1, and another try.
    test::WaitUntil("a ping was not held up", [&] {
      result = test::RunRift({"drive", folder / "lenient.yaml", "--ping", "--port", robot.path()},
                             streams.redirection);
      return result.exit_code != 1;
    });
    INFO(streams.redirection << ": " << result.err);
    CHECK(result.exit_code == (streams.take_results ? 0 : 3));
    CHECK(test::BytesThatAreNoCommands(robot.Heard()) == "");
  }
  CHECK(robot.Heard().size() > 1000);
}

TEST_CASE("A port that is not there is a failure of one clear line") {
  const test::ProcessResult result =
      test::RunRift({"drive", "--ping", "--port", "/dev/no_such_port"});
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::StartsWith("rift: there is no serial port /dev/no_such_port"));
  CHECK(test::RunRift({"drive", "--ping"}).exit_code == 2);
}

}  // namespace
}  // namespace rift
