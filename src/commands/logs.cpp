#include "logs.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <stdexcept>

#include "files.hpp"

namespace rift::commands {

trajectory::Log LoadLog(const std::string& path, trajectory::Format format) {
  trajectory::Log log = trajectory::ReadLog(ReadFile(path), path, format);
  for (const std::string& note : log.notes) fmt::print(stderr, "note: {}: {}\n", path, note);
  return log;
}

trajectory::Log LoadLog(const std::string& path, trajectory::Format format, double tag_offset_m,
                        const std::string& format_key) {
  trajectory::Log log = LoadLog(path, format);
  if (tag_offset_m != 0.0 && !log.trajectory.HasYaw()) {
    const std::string why = log.unknown_angles.empty()
                                ? "it logs no yaw: leave the tag offset at 0"
                                : log.unknown_angles + fmt::format(": set {}", format_key);
    throw std::invalid_argument(
        fmt::format("{}: a tag offset of {:g} m needs the yaw, and {}", path, tag_offset_m, why));
  }
  log.trajectory = trajectory::OffsetAlongHeading(std::move(log.trajectory), tag_offset_m);
  return log;
}

}  // namespace rift::commands
