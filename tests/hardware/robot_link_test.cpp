// The link beside a line whose every write and answer is at hand.

#include "rift/hardware/robot_link.hpp"

#include <catch2/catch.hpp>
#include <optional>

namespace rift::hardware {
namespace {

using Chunk = std::vector<std::uint8_t>;

struct FakeLine : ByteLine, Clock {
  std::vector<Chunk> written;
  std::vector<double> written_s;
  Chunk incoming;
  size_t unsent = 0;
  bool takes = true;
  double now_s = 0.0;

  bool Write(Bytes bytes) override {
    written.emplace_back(bytes.begin(), bytes.end());
    written_s.push_back(now_s);
    return takes;
  }
  Chunk Read() override { return std::exchange(incoming, {}); }
  size_t Unsent() override { return unsent; }
  double Now_s() override { return now_s; }
  void Wait(double dt_s) override { now_s += dt_s; }

  CommandFrame Last() const { return DecodeCommand(written.back()).value(); }
  void Answers(std::uint8_t sequence) {
    const AnswerBytes bytes = Encode(Answer{sequence, 0, 10, 20, 5000, 0});
    incoming.insert(incoming.end(), bytes.begin(), bytes.end());
  }
};

constexpr double kStep_s = 1.0 / 64.0;

LineOptions Fast() { return {.baud = 1'000'000, .heartbeat_s = 4 * kStep_s}; }

TEST_CASE("A command goes out when it changes or is asked for, and again after the heartbeat") {
  FakeLine line;
  RobotLink link(line, Fast(), Protocol::kFramed);
  link.Tick(0.0);
  CHECK(line.written.size() == 1);
  CHECK(line.Last().power.IsZero());
  link.Put({}, false);
  link.Tick(kStep_s);
  CHECK(line.written.size() == 1);
  link.Put({0.25, 0.0}, false);
  link.Tick(kStep_s);
  CHECK(line.Last().power == MilliPower{250, 0});
  link.Put({0.25, -0.5}, false);
  link.Tick(2 * kStep_s);
  CHECK(line.Last().power == MilliPower{250, -500});
  link.Put({0.25, -0.5}, true);
  link.Tick(3 * kStep_s);
  CHECK(line.written.size() == 4);
  link.Tick(7 * kStep_s - 0.001);
  CHECK(line.written.size() == 4);
  link.Tick(7 * kStep_s);
  CHECK(line.written.size() == 5);
  link.PutForLater({0.75, 0.125});
  link.Tick(11 * kStep_s - 0.001);
  CHECK(line.written.size() == 5);
  link.Tick(11 * kStep_s);
  CHECK(line.Last().power == MilliPower{750, 125});
  CHECK(line.Last().sequence == 6);
  CHECK(link.last_sent()->at_s == 11 * kStep_s);
  CHECK(link.sent_count() == 6);
}

TEST_CASE("A line whose bytes do not leave gets no more of them, and that time counts as lag") {
  FakeLine line;
  RobotLink link(line, Fast(), Protocol::kFramed);
  line.unsent = 1;
  CHECK(link.Lag_s(1.0) == 0.0);
  link.Tick(1.0);
  link.Tick(1.5);
  CHECK(line.written.empty());
  CHECK(link.Lag_s(1.75) == 0.75);
  line.unsent = 0;
  link.Tick(2.0);
  CHECK(line.written.size() == 1);
  CHECK(link.Lag_s(2.25) == 0.25);  // it waits for its answer
  line.Answers(1);
  link.Tick(2.0);
  CHECK(link.Lag_s(2.25) == 0.0);
}

TEST_CASE(
    "A write that was not taken is tried again at once and counts as lag from its first try") {
  FakeLine line;
  RobotLink link(line, Fast(), Protocol::kPlain, {});
  line.takes = false;
  link.Tick(1.0);
  link.Tick(1.0 + kStep_s);
  CHECK(line.written.size() == 2);
  CHECK(link.Lag_s(1.5) == 0.5);
  line.takes = true;
  link.Tick(1.0 + 2 * kStep_s);
  CHECK(line.written.size() == 3);
  CHECK(link.Lag_s(1.5) == 0.0);
  link.Tick(1.0 + 3 * kStep_s);
  CHECK(line.written.size() == 3);
}

TEST_CASE("An answer counts once, for the command it names, and gives up all before it") {
  FakeLine line;
  RobotLink link(line, Fast(), Protocol::kFramed);
  for (int i = 0; i < 4; ++i) {
    link.Put({0.001 * i, 0.0}, true);
    link.Tick(1.0 + kStep_s * i);
  }
  CHECK(link.Lag_s(2.0) == 1.0);
  line.Answers(9);  // never asked
  line.Answers(2);
  line.Answers(2);
  line.Answers(1);  // came late
  link.Listen(1.5);
  const std::vector<RobotLink::Heard> heard = link.TakeHeard();
  REQUIRE(heard.size() == 1);
  CHECK(heard[0].at_s == 1.5);
  CHECK(heard[0].sent->sequence == 2);
  CHECK(heard[0].sent->at_s == 1.0 + kStep_s);
  CHECK(heard[0].sent->power == MilliPower{1, 0});
  CHECK(heard[0].answer.left == 10);
  CHECK(heard[0].answer.right == 20);
  CHECK(link.answered_count() == 1);
  CHECK(link.TakeHeard().empty());
  CHECK(link.Lag_s(2.0) == 1.0 - 2 * kStep_s);  // the third waits
}

TEST_CASE("After more silence than there are numbers an answer is that of the newest command") {
  FakeLine line;
  RobotLink link(line, Fast(), Protocol::kFramed);
  for (int i = 0; i < 300; ++i) {
    link.Put({}, true);
    link.Tick(kStep_s * i);
  }
  const double now_s = kStep_s * 299;
  CHECK(link.Lag_s(now_s) == now_s);
  line.Answers(300 % 256);
  link.Listen(now_s);
  const std::vector<RobotLink::Heard> heard = link.TakeHeard();
  REQUIRE(heard.size() == 1);
  CHECK(heard[0].sent->at_s == now_s);
  CHECK(link.Lag_s(now_s) == 0.0);
}

TEST_CASE("Commands keep the line for their own bytes and those of the answers") {
  // Half of 960 bytes a second: frames of 11 and answers of 15, plain lines of up to 12.
  for (const auto& [protocol, bytes] : {std::pair{Protocol::kFramed, 15}, {Protocol::kPlain, 12}}) {
    FakeLine line;
    RobotLink link(line, {}, protocol);
    CHECK(link.Occupied_s() == Approx(bytes / 480.0));
    for (int i = 0; i < 100'000; ++i) {
      link.Put({}, true);
      link.Tick(line.now_s);
      line.now_s += 1e-4;
    }
    CHECK(static_cast<double>(line.written.size()) == Approx(4800.0 / bytes).margin(2.0));
  }
}

TEST_CASE("Answers are found between a radio's words, after damaged ones and in any pieces") {
  const Answer first{3, 1, -7, 9, 4800, 2}, second{4, 1, -8, 10, 4790, 2};
  const Answer said{{}, 0, 123, -456, 4700, 0};
  Chunk all;
  const auto add = [&all](const auto& bytes) {
    for (const auto byte : bytes) all.push_back(static_cast<std::uint8_t>(byte));
  };
  add(std::string("OK+CONNZ"));
  AnswerBytes damaged = Encode(first);
  damaged[5] ^= 4;
  add(damaged);
  add(Encode(first));
  add(std::string(100, 'x') + AnswerLine(said));
  add(std::string("rift1 1 2 3*00\n"));
  add(Encode(second));
  for (const size_t piece : {all.size(), size_t{1}, size_t{7}}) {
    AnswerDecoder decoder;
    std::vector<Answer> answers;
    for (size_t at = 0; at < all.size(); at += piece) {
      const auto found = decoder.Take(Bytes(all).subspan(at, std::min(piece, all.size() - at)));
      answers.insert(answers.end(), found.begin(), found.end());
    }
    INFO(piece);
    REQUIRE(answers.size() == 3);
    CHECK(answers[0] == first);
    CHECK(answers[1].left == 123);
    CHECK(answers[1].right == -456);
    CHECK(answers[1].battery_mv == 4700);
    CHECK(answers[2] == second);
  }
}

TEST_CASE("The hello is a zero in the robot's own words, four times a second for its time") {
  FakeLine line;
  const PlainOptions plain{.format = "M {left:d},{right:d}\r\n", .range = {10.0, 30.0}};
  CHECK(FindProtocol(line, line, {.hello_s = 2.0}, plain) == Protocol::kPlain);
  CHECK(line.now_s == Approx(2.0).margin(0.006));
  REQUIRE(line.written.size() == 8);
  for (size_t i = 0; i < line.written.size(); ++i) {
    CHECK(std::string(line.written[i].begin(), line.written[i].end()) == "M 20,20\r\n");
    CHECK(line.written_s[i] == Approx(0.25 * static_cast<double>(i)).margin(0.05));
  }
  FakeLine full;
  full.unsent = 1;
  CHECK(FindProtocol(full, full, {.hello_s = 0.5}) == Protocol::kPlain);
  CHECK(full.written.empty());
  FakeLine talks;
  const std::string line_said = AnswerLine(Answer{});
  talks.incoming.assign(line_said.begin(), line_said.end());
  CHECK(FindProtocol(talks, talks, {}) == Protocol::kFramed);
  CHECK(talks.now_s == 0.0);
}

}  // namespace
}  // namespace rift::hardware
