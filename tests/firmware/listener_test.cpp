#include "rift/hardware/listener.hpp"

#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "rift/hardware/wire.hpp"
#include "support/processes/npm.hpp"
#include "support/processes/process.hpp"
#include "support/processes/shell.hpp"
#include "support/tree.hpp"

namespace rift::hardware {
namespace {

using Chunk = std::vector<std::uint8_t>;

struct Turn {
  std::uint32_t now_ms = 0;
  Chunk bytes;
};

/// How main.py ended, and what it did in each turn: "LEFT RIGHT HEX".
struct Run {
  std::vector<std::string> turns;
  std::map<std::string, std::string> end;
};

std::string Hex(const Chunk& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) text += fmt::format("{:02x}", byte);
  return text.empty() ? "-" : text;
}

std::string ScriptOf(const std::vector<Turn>& turns) {
  std::string script;
  for (const Turn& turn : turns) script += fmt::format("{} {}\n", turn.now_ms, Hex(turn.bytes));
  return script;
}

/// The firmware as it is copied to the robot, under MicroPython.
Run RunFirmware(const std::string& script) {
  const test::TemporaryFolder folder;
  test::WriteText(folder / "script", script);
  const std::string source = test::SourceDir();
  const std::string command = fmt::format(
      "node '{0}/tests/firmware/run_firmware.mjs' '{1}' '{0}/src/firmware' "
      "'{0}/tests/firmware/stand_in' '{2}' > '{3}' 2>&1",
      source, test::NpmDir(), folder / "script", folder / "out");
  const int status = test::RunShell(command);
  std::ifstream out(folder / "out");
  Run run;
  for (std::string line; std::getline(out, line);) {
    if (line.empty()) continue;
    if (std::isdigit(line[0]) || line[0] == '-') {
      run.turns.push_back(line);
    } else {
      const size_t blank = line.find(' ');
      run.end[line.substr(0, blank)] = blank == std::string::npos ? "" : line.substr(blank + 1);
    }
  }
  INFO(fmt::format("exit status {}, {} turns", status, run.turns.size()));
  REQUIRE(status == 0);
  return run;
}

/// The same turns through the model of the listener.
std::vector<std::string> RunModel(const std::vector<Turn>& turns) {
  constexpr int kSpeedPerMilli = 6;  // Pololu's full speed is 6000
  Listener listener;
  std::vector<std::string> trace;
  for (size_t i = 0; i < turns.size(); ++i) {
    const Listener::Senses senses{static_cast<std::int32_t>(3 * i),
                                  -static_cast<std::int32_t>(5 * i),
                                  static_cast<std::uint16_t>(4000 + i % 1000)};
    const Chunk said = listener.Poll(turns[i].now_ms, turns[i].bytes, senses);
    trace.push_back(fmt::format("{} {} {}", kSpeedPerMilli * listener.Motors().left,
                                kSpeedPerMilli * listener.Motors().right, Hex(said)));
  }
  return trace;
}

Chunk Text(const std::string& text) { return {text.begin(), text.end()}; }

/// What may come in over a bad radio, good commands among it.
class Babble {
 public:
  explicit Babble(std::uint64_t seed) : random_(seed) {}

  std::vector<Turn> Turns(size_t count) {
    std::vector<Turn> turns;
    std::uint32_t now_ms = 0;
    for (size_t i = 0; i < count; ++i) {
      now_ms += Below(20) == 0 ? Below(700) : Below(40);
      Chunk bytes;
      for (unsigned pieces = Below(3); pieces > 0; --pieces) {
        const Chunk piece = Spoiled(Piece());
        bytes.insert(bytes.end(), piece.begin(), piece.end());
      }
      turns.push_back({now_ms, bytes});
    }
    return turns;
  }

 private:
  unsigned Below(unsigned end) { return static_cast<unsigned>(random_() % end); }
  int Milli() { return static_cast<int>(Below(2001)) - 1000; }

  Chunk Piece() {
    switch (Below(8)) {
      case 0: {
        Chunk noise(Below(30));
        for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random_());
        return noise;
      }
      case 1:
        return Text(Below(2) ? "OK+LOST" : "OK+CONN");
      case 2:
        return Text(PlainLine({}));
      case 3:
        return Text(PlainLine({0.001 * Milli(), 0.001 * Milli()}));
      case 4:
        return Text(fmt::format("{:.{}f} {:.2f}\n", 0.002 * Milli(), Below(4), 0.002 * Milli()));
      default: {
        if (Below(10) == 0) sequence_ = static_cast<std::uint8_t>(random_());
        const MilliPower power = Below(3) ? MilliPower{Milli(), Milli()} : MilliPower{};
        const CommandBytes bytes = Encode(CommandFrame{sequence_++, power});
        return {bytes.begin(), bytes.end()};
      }
    }
  }

  Chunk Spoiled(Chunk bytes) {
    if (bytes.empty() || Below(4) != 0) return bytes;
    const size_t at = Below(static_cast<unsigned>(bytes.size()));
    switch (Below(3)) {
      case 0:
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
        break;
      case 1:
        bytes[at] ^= static_cast<std::uint8_t>(1u << Below(8));
        break;
      default:
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), bytes[at]);
    }
    return bytes;
  }

  std::mt19937_64 random_;
  std::uint8_t sequence_ = 1;
};

TEST_CASE("The robot does with random bytes exactly what its model does") {
  if (!test::HasNpm("MicroPython")) return;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<Turn> turns = Babble(seed).Turns(4000);
    const Run run = RunFirmware(ScriptOf(turns));
    CHECK(run.end.at("end") == "over");
    const std::vector<std::string> model = RunModel(turns);
    REQUIRE(run.turns.size() == model.size());
    size_t moving = 0;
    for (size_t i = 0; i < model.size(); ++i) {
      INFO("turn " << i << " of seed " << seed << ": " << Hex(turns[i].bytes));
      REQUIRE(run.turns[i] == model[i]);
      moving += !model[i].starts_with("0 0 ");
    }
    CHECK(moving > 500);
    CHECK(moving < 3500);
  }
}

/// A frame with these powers and, where `spoilt` is 2 or 4, a wrong bit in the complement of left
/// or right; its CRC is right.
Chunk Frame(int sequence, int left, int right, size_t spoilt = 0) {
  Chunk bytes{CommandFrame::kStart, static_cast<std::uint8_t>(sequence)};
  for (const bool is_complement : {false, true}) {
    for (const int power : {left, right}) {
      const auto word = static_cast<std::uint16_t>(is_complement ? ~power : power);
      bytes.push_back(static_cast<std::uint8_t>(word));
      bytes.push_back(static_cast<std::uint8_t>(word >> 8));
    }
  }
  if (spoilt != 0) bytes[4 + spoilt] ^= 1;
  bytes.push_back(Crc8(bytes));
  return bytes;
}

/// Turns of a robot that is told each of its limits, and then one more.
class Limits {
 public:
  std::vector<Turn> Turns() {
    Frames();
    PlainLines();
    Times();
    return turns_;
  }

 private:
  void Say(const Chunk& bytes, std::uint32_t after_ms = 10) {
    now_ms_ += after_ms;
    turns_.push_back({now_ms_, bytes});
  }
  void Stand() { Say(Frame(0, 0, 0)); }  // and says how much it rejected

  void Frames() {
    for (const int power : {1000, -1000, 1001, -1001, 32767, -32768, 1, -1}) {
      for (const bool is_left : {true, false}) {
        Stand();
        Say(Frame(1, is_left ? power : 0, is_left ? 0 : power));
      }
    }
    for (const int ahead : {0, 1, 126, 127, 128, 129, 255}) {
      Stand();
      Say(Frame(ahead, 300, -200));
    }
    for (const size_t spoilt : {2, 4}) {
      Stand();
      Say(Frame(1, 300, -200, spoilt));
    }
    Stand();
  }

  void PlainLines() {
    for (const std::string number :
         {"1.00", "-1.00", "0.99", "1.01", "-1.01", "9.99", "/.50", ":.50", "0/50", "0./0", "0.:0",
          "0.5/", "0.5:", "0.5", "0.500", "00.5"}) {
      for (const bool is_left : {true, false}) {
        const std::string other = "0.25";
        Say(Text("OK+LOST\n0.00 0.00\n"));
        Say(Text((is_left ? number + " " + other : other + " " + number) + "\n"));
      }
    }
    // As long as a line may be, and one byte more, with the module's word at its end.
    for (size_t before = 0; before < 8; ++before) {
      Say(Text("\n0.50 0.50\n"));
      Say(Text(std::string(before, 'x') + "OK+LOST"));
    }
    Say(Text("\n-0.50 -0.50\n"));
    Stand();
  }

  void Times() {
    for (const std::uint32_t later_ms : {298, 299, 300, 301}) {
      Stand();
      Say(Frame(1, 300, -200));
      Say({}, later_ms);
      Say({}, 300);
    }
    for (const std::uint32_t later_ms : {98, 99, 100, 101}) {  // after a hundred: 200 in all
      Say(Text("0.00 0.00\n"), 500);
      Say(Text("0.10 0.10\n"), 100);
      Say(Text("0.20 0.20\n"), later_ms);
    }
  }

  std::vector<Turn> turns_;
  std::uint32_t now_ms_ = 0;
};

TEST_CASE("The robot has the limits of its model: powers, numbers, lengths and times") {
  if (!test::HasNpm("MicroPython")) return;
  const std::vector<Turn> turns = Limits().Turns();
  const Run run = RunFirmware(ScriptOf(turns));
  const std::vector<std::string> model = RunModel(turns);
  REQUIRE(run.turns.size() == model.size());
  size_t moving = 0;
  for (size_t i = 0; i < model.size(); ++i) {
    INFO("turn " << i << " at " << turns[i].now_ms << " ms: " << Hex(turns[i].bytes));
    CHECK(run.turns[i] == model[i]);
    moving += !model[i].starts_with("0 0 ");
  }
  CHECK(moving > 30);
}

TEST_CASE("The robot's watchdog works across the wrap of its clock") {
  if (!test::HasNpm("MicroPython")) return;
  constexpr std::uint32_t kWrap_ms = 0x4000'0000;
  const std::string script = fmt::format("{} {}\n{} -\n{} -\n", kWrap_ms - 100,
                                         Hex(Text("0.50 0.50\n")), kWrap_ms + 199, kWrap_ms + 200);
  const Run run = RunFirmware(script);
  REQUIRE(run.turns.size() == 3);
  CHECK(run.turns[1] == "3000 3000 -");
  CHECK(run.turns[2] == "0 0 -");
}

TEST_CASE("The robot starts at zero and whatever ends its program stops the motors") {
  if (!test::HasNpm("MicroPython")) return;
  const Run broken = RunFirmware(fmt::format("0 -\n10 {}\n20 !\n", Hex(Text("0.50 0.50\n"))));
  REQUIRE(broken.turns.size() == 2);
  CHECK(broken.turns[0] == "0 0 -");
  CHECK(broken.turns[1].starts_with("3000 3000 "));
  CHECK(broken.end.at("speeds") == "0 0");
  CHECK(broken.end.at("screen") == "rift FAILED|the serial line |broke, and nobod");
  CHECK(broken.end.at("end").starts_with("failed OSError("));
  CHECK(broken.end.at("off") == "2");  // before it draws, and when it ends

  const Run unplugged = RunFirmware(fmt::format("0 -\n10 {}\n", Hex(Text("0.50 0.50\n"))));
  CHECK(unplugged.end.at("end") == "over");
  CHECK(unplugged.end.at("speeds") == "0 0");
  CHECK(unplugged.end.at("off") == "1");
  CHECK(unplugged.end.at("told") == "2");  // the motors, of what changes alone
}

TEST_CASE("The robot shows what it does while it stands") {
  if (!test::HasNpm("MicroPython")) return;
  // Drawing takes time: it is done each half second.
  const std::string rejected = fmt::format("0 -\n10 {}\n499 -\n", Hex(Text("85 0.90\n")));
  CHECK(RunFirmware(rejected).end.at("screen") ==
        "rift waiting|L 0 R 0|stops 0|rejected 0|4000 mV");
  const Run later = RunFirmware(rejected + "500 -\n");
  CHECK(later.end.at("screen") == "rift waiting|L 0 R 0|stops 0|rejected 1|4003 mV");
  CHECK(later.end.at("uart") == "0 9600 28 29 512");
  const std::string script =
      fmt::format("0 -\n10 {}\n400 -\n600 -\n", Hex(Text("0.50 0.50\n85 0.90\n")));
  CHECK(RunFirmware(script).end.at("screen") == "rift STOPPED|L 0 R 0|stops 1|rejected 1|4003 mV");
}

}  // namespace
}  // namespace rift::hardware
