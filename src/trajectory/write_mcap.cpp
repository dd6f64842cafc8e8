// The container MCAP (mcap.dev/spec): records of an opcode, a length and fields, little-endian,
// each text and block of bytes behind its length. Messages are JSON under schemas that Foxglove
// knows.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "not_logged.hpp"
#include "rift/trajectory/log.hpp"

namespace rift::trajectory {
namespace {

constexpr std::string_view kMagic = "\x89MCAP0\r\n";
enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kDataEnd = 0x0F
};

constexpr std::string_view kPoseSchema =
    R"({"title":"foxglove.PoseInFrame","type":"object","properties":{)"
    R"("timestamp":{"type":"object","title":"time","properties":{"sec":{"type":"integer"},"nsec":{"type":"integer"}}},)"
    R"("frame_id":{"type":"string"},)"
    R"("pose":{"type":"object","title":"foxglove.Pose","properties":{)"
    R"("position":{"type":"object","title":"foxglove.Vector3","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"}}},)"
    R"("orientation":{"type":"object","title":"foxglove.Quaternion","properties":{"x":{"type":"number"},"y":{"type":"number"},"z":{"type":"number"},"w":{"type":"number"}}}}}}})";

void Put(std::string& bytes, std::uint64_t value, int width) {
  for (int i = 0; i < width; ++i) bytes += static_cast<char>(value >> (8 * i));
}

void PutText(std::string& bytes, std::string_view text) {
  Put(bytes, text.size(), 4);
  bytes += text;
}

void PutRecord(std::string& file, Opcode opcode, std::string_view fields) {
  Put(file, opcode, 1);
  Put(file, fields.size(), 8);
  file += fields;
}

void PutSchema(std::string& file, int id, std::string_view name, std::string_view json_schema) {
  std::string fields;
  Put(fields, static_cast<std::uint64_t>(id), 2);
  PutText(fields, name);
  PutText(fields, "jsonschema");
  PutText(fields, json_schema);
  PutRecord(file, kSchema, fields);
}

void PutChannel(std::string& file, int id, int schema, std::string_view topic) {
  std::string fields;
  Put(fields, static_cast<std::uint64_t>(id), 2);
  Put(fields, static_cast<std::uint64_t>(schema), 2);
  PutText(fields, topic);
  PutText(fields, "json");
  Put(fields, 0, 4);  // no metadata
  PutRecord(file, kChannel, fields);
}

void PutMessage(std::string& file, int channel, std::uint64_t sequence, std::uint64_t time_ns,
                std::string_view json) {
  std::string fields;
  Put(fields, static_cast<std::uint64_t>(channel), 2);
  Put(fields, sequence, 4);
  Put(fields, time_ns, 8);
  Put(fields, time_ns, 8);
  fields += json;
  PutRecord(file, kMessage, fields);
}

std::string PoseJson(std::uint64_t time_ns, const Eigen::Vector3d& position_m,
                     const Eigen::Quaterniond& world_from_body) {
  return fmt::format(
      R"({{"timestamp":{{"sec":{},"nsec":{}}},"frame_id":"world","pose":{{"position":{{"x":{},"y":{},"z":{}}},)"
      R"("orientation":{{"x":{},"y":{},"z":{},"w":{}}}}}}})",
      time_ns / 1'000'000'000, time_ns % 1'000'000'000, position_m.x(), position_m.y(),
      position_m.z(), world_from_body.x(), world_from_body.y(), world_from_body.z(),
      world_from_body.w());
}

/// A name as JSON has it; what is no text there is left out.
std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) quoted += c;
  }
  return quoted + '"';
}

std::string SignalsSchema(const Trajectory& trajectory) {
  std::string properties;
  for (const Channel& channel : trajectory.channels) {
    properties += fmt::format("{}{}:{{\"type\":[\"number\",\"null\"]}}",
                              properties.empty() ? "" : ",", Quoted(channel.name));
  }
  return fmt::format(R"({{"title":"rift.Signals","type":"object","properties":{{{}}}}})",
                     properties);
}

std::string SignalsJson(const Trajectory& trajectory, size_t row) {
  std::string json;
  for (const Channel& channel : trajectory.channels) {
    const double value = channel.values[row];
    json += fmt::format("{}{}:{}", json.empty() ? "" : ",", Quoted(channel.name),
                        std::isfinite(value) ? fmt::format("{}", value) : "null");
  }
  return "{" + json + "}";
}

std::uint64_t Time_ns(double t_s) {
  constexpr double kLatest_s = 9e9;  // 2^63 ns
  if (t_s < kLatest_s) return static_cast<std::uint64_t>(std::llround(t_s * 1e9));
  throw std::invalid_argument(
      fmt::format("a time of {} s: MCAP counts nanoseconds up to {:g} s", t_s, kLatest_s));
}

}  // namespace

std::string WriteMcap(const Trajectory& trajectory) {
  enum { kPose = 1, kTarget = 2, kSignals = 3 };
  enum { kPoseType = 1, kSignalsType = 2 };
  std::string file(kMagic);
  std::string header;
  PutText(header, "");
  PutText(header, "rift");
  PutRecord(file, kHeader, header);
  PutSchema(file, kPoseType, "foxglove.PoseInFrame", kPoseSchema);
  PutChannel(file, kPose, kPoseType, "/pose");
  PutChannel(file, kTarget, kPoseType, "/target");
  const bool has_signals = !trajectory.channels.empty();
  if (has_signals) {
    PutSchema(file, kSignalsType, "rift.Signals", SignalsSchema(trajectory));
    PutChannel(file, kSignals, kSignalsType, "/signals");
  }
  // The picture of the first row may be older than the trial, and MCAP has no times below zero.
  const double zero_s = trajectory.poses.empty() ? 0.0 : std::min(0.0, trajectory.poses[0].t_s);
  for (size_t row = 0; row < trajectory.poses.size(); ++row) {
    const StampedPose& pose = trajectory.poses[row];
    const std::uint64_t time_ns = Time_ns(pose.t_s - zero_s);
    PutMessage(
        file, kPose, row, time_ns,
        PoseJson(time_ns, {pose.x_m, pose.y_m, ZeroIfNotLogged(pose.z_m)}, WorldFromBody(pose)));
    if (!std::isnan(pose.target_x_m) && !std::isnan(pose.target_y_m)) {
      PutMessage(file, kTarget, row, time_ns,
                 PoseJson(time_ns, {pose.target_x_m, pose.target_y_m, 0.0},
                          Eigen::Quaterniond::Identity()));
    }
    if (has_signals) PutMessage(file, kSignals, row, time_ns, SignalsJson(trajectory, row));
  }
  PutRecord(file, kDataEnd, std::string(4, '\0'));  // no checksum
  PutRecord(file, kFooter, std::string(20, '\0'));  // no summary
  file += kMagic;
  return file;
}

}  // namespace rift::trajectory
