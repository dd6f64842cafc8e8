// A log as MCAP, read back by the container's own description (mcap.dev/spec).
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

using Catch::Matchers::Contains;

/// Fields in their order, little-endian.
struct Fields {
  std::string bytes;
  size_t at = 0;

  std::uint64_t Number(int width) {
    std::uint64_t value = 0;
    for (int i = 0; i < width; ++i) {
      value |= std::uint64_t(static_cast<unsigned char>(bytes.at(at++))) << (8 * i);
    }
    return value;
  }
  std::string Text() {
    const size_t size = Number(4);
    at += size;
    return bytes.substr(at - size, size);
  }
  std::string Rest() const { return bytes.substr(at); }
};

struct Record {
  int opcode;
  Fields fields;
};

std::vector<Record> RecordsOf(const std::string& file) {
  const std::string magic("\x89MCAP0\r\n", 8);
  REQUIRE(file.substr(0, 8) == magic);
  REQUIRE(file.substr(file.size() - 8) == magic);
  Fields all{file.substr(8, file.size() - 16)};
  std::vector<Record> records;
  while (all.at < all.bytes.size()) {
    const int opcode = static_cast<int>(all.Number(1));
    const size_t size = all.Number(8);
    records.push_back({opcode, {all.bytes.substr(all.at, size)}});
    all.at += size;
  }
  return records;
}

struct Message {
  std::uint64_t channel, sequence, log_ns, publish_ns;
  std::string json;
};

std::vector<Message> MessagesOf(const std::vector<Record>& records) {
  std::vector<Message> messages;
  for (Record record : records) {
    if (record.opcode != 5) continue;
    Fields& f = record.fields;
    Message message{f.Number(2), f.Number(4), f.Number(8), f.Number(8), ""};
    message.json = f.Rest();
    messages.push_back(message);
  }
  return messages;
}

Trajectory TwoRows() {
  Trajectory log;
  log.poses.push_back({.t_s = 1.5, .x_m = 0.25, .y_m = -0.5, .yaw_rad = 0.0});
  log.poses.push_back({.t_s = 2.25,
                       .x_m = 0.75,
                       .y_m = 1.0,
                       .z_m = 0.125,
                       .yaw_rad = 3.141592653589793,
                       .target_x_m = 4.0,
                       .target_y_m = -3.0});
  log.channels = {{"power \"left\"", {0.5, std::nan("")}}, {"count", {7.0, 8.0}}};
  return log;
}

TEST_CASE("An MCAP file begins with its header, ends with its footer, and names every topic") {
  std::vector<Record> records = RecordsOf(WriteMcap(TwoRows()));
  CHECK(records.front().opcode == 1);
  CHECK(records.front().fields.Text().empty());  // no profile
  CHECK(records.front().fields.Text() == "rift");
  CHECK(records[records.size() - 2].opcode == 0x0F);
  CHECK(records[records.size() - 2].fields.bytes == std::string(4, '\0'));
  CHECK(records.back().opcode == 2);
  CHECK(records.back().fields.bytes == std::string(20, '\0'));
  std::vector<std::string> schemas, topics;
  for (Record& record : records) {
    Fields& f = record.fields;
    if (record.opcode == 3) {
      const auto id = f.Number(2);
      const std::string name = f.Text(), encoding = f.Text();
      schemas.push_back(std::to_string(id) + " " + name + " " + encoding);
      const std::string schema = f.Text();
      CHECK(f.Rest().empty());
      if (id == 2) {
        CHECK_THAT(schema, Contains(R"("power \"left\"":{"type":["number","null"]},"count":{)"));
      }
    }
    if (record.opcode == 4) {
      const auto id = f.Number(2), schema = f.Number(2);
      const std::string topic = f.Text(), encoding = f.Text();
      topics.push_back(std::to_string(id) + " " + std::to_string(schema) + " " + topic + " " +
                       encoding);
      CHECK(f.Number(4) == 0);
    }
  }
  CHECK(schemas ==
        std::vector<std::string>{"1 foxglove.PoseInFrame jsonschema", "2 rift.Signals jsonschema"});
  CHECK(topics ==
        std::vector<std::string>{"1 1 /pose json", "2 1 /target json", "3 2 /signals json"});
}

TEST_CASE("Each row is a pose, a target where it has one, and its signals, at its nanosecond") {
  const std::vector<Message> messages = MessagesOf(RecordsOf(WriteMcap(TwoRows())));
  REQUIRE(messages.size() == 5);
  std::vector<std::uint64_t> channels;
  for (const Message& message : messages) {
    channels.push_back(message.channel);
    CHECK(message.log_ns == message.publish_ns);
  }
  CHECK(channels == std::vector<std::uint64_t>{1, 3, 1, 2, 3});
  CHECK(messages[0].log_ns == 1'500'000'000);
  CHECK(messages[0].sequence == 0);
  CHECK(messages[4].log_ns == 2'250'000'000);
  CHECK(messages[4].sequence == 1);
  CHECK(messages[0].json ==
        R"({"timestamp":{"sec":1,"nsec":500000000},"frame_id":"world","pose":{)"
        R"("position":{"x":0.25,"y":-0.5,"z":0},"orientation":{"x":0,"y":0,"z":0,"w":1}}})");
  CHECK_THAT(messages[2].json, Contains(R"("position":{"x":0.75,"y":1,"z":0.125})") &&
                                   Contains(R"("z":1,)") &&
                                   Contains(R"("sec":2,"nsec":250000000)"));
  CHECK_THAT(messages[3].json, Contains(R"("position":{"x":4,"y":-3,"z":0},"orientation":{)"
                                        R"("x":0,"y":0,"z":0,"w":1})"));
  CHECK(messages[1].json == R"({"power \"left\"":0.5,"count":7})");
  CHECK(messages[4].json == R"({"power \"left\"":null,"count":8})");
}

TEST_CASE("Half a target is none, and a log without channels has no signals") {
  Trajectory log = TwoRows();
  log.channels.clear();
  log.poses[0].target_x_m = 1.0;
  log.poses[1].target_x_m = StampedPose::kNotLogged;
  const std::vector<Message> messages = MessagesOf(RecordsOf(WriteMcap(log)));
  REQUIRE(messages.size() == 2);
  for (const Message& message : messages) CHECK(message.channel == 1);
  CHECK(WriteMcap(log).find("/signals") == std::string::npos);
}

TEST_CASE("A name of a signal is text of JSON, without bytes that are none there") {
  Trajectory log = TwoRows();
  log.channels = {{std::string("a\\b\"c\td\x1f \x7f", 10), {1.0, 2.0}}};
  CHECK(MessagesOf(RecordsOf(WriteMcap(log)))[1].json == "{\"a\\\\b\\\"cd \x7f\":1}");
}

TEST_CASE("Times below zero are counted from the first row, and late ones are refused") {
  Trajectory log = TwoRows();
  log.poses[0].t_s = -0.5;
  std::vector<Message> messages = MessagesOf(RecordsOf(WriteMcap(log)));
  CHECK(messages.front().log_ns == 0);
  CHECK(messages.back().log_ns == 2'750'000'000);
  log.poses[0].t_s = 8.9e9;
  log.poses[1].t_s = 8.99e9;
  CHECK_NOTHROW(WriteMcap(log));
  log.poses[1].t_s = 9e9;
  CHECK_THROWS_WITH(WriteMcap(log),
                    "a time of 9000000000 s: MCAP counts nanoseconds up to 9e+09 s");
}

}  // namespace
}  // namespace rift::trajectory
