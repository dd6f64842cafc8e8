#include "logs.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>

#include "files.hpp"

namespace rift::commands {

trajectory::Log LoadLog(const std::string& path, trajectory::Format format) {
  return trajectory::ReadLog(ReadFile(path), path, format);
}

void PrintNotes(const trajectory::Log& log, const std::string& path) {
  for (const std::string& note : log.notes) fmt::print(stderr, "note: {}: {}\n", path, note);
}

namespace {

std::string WhyNoYaw(const trajectory::Log& log, const std::string& format_key) {
  if (!log.unknown_angles.empty()) return fmt::format("{}: set {}", log.unknown_angles, format_key);
  if (log.line_without_yaw) return fmt::format("line {} has none", *log.line_without_yaw);
  return "it logs none: leave the tag offset at 0";
}

}  // namespace

trajectory::Log LoadLog(const std::string& path, trajectory::Format format, double tag_offset_m,
                        const std::string& format_key) {
  trajectory::Log log = LoadLog(path, format);
  if (tag_offset_m != 0.0 && !log.trajectory.HasYaw()) {
    const std::string why = WhyNoYaw(log, format_key);
    throw std::invalid_argument(
        fmt::format("{}: a tag offset of {:g} m needs the yaw, and {}", path, tag_offset_m, why));
  }
  log.trajectory = trajectory::OffsetAlongHeading(std::move(log.trajectory), tag_offset_m);
  return log;
}

}  // namespace rift::commands
