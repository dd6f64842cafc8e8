#pragma once

#include <string>

#include "rift/trajectory/log.hpp"

namespace rift::commands {

/// Reads a log; what had to be mended goes to stderr as `note: path: ...`.
/// Throws std::invalid_argument when it cannot be read or breaks a rule.
trajectory::Log LoadLog(const std::string& path, trajectory::Format format);

/// The same, moved from the tag to the point `tag_offset_m` ahead of it. `format_key` is what the
/// user sets to tell the dialect ("--real-format"), for the message when the yaw is not known.
trajectory::Log LoadLog(const std::string& path, trajectory::Format format, double tag_offset_m,
                        const std::string& format_key);

}  // namespace rift::commands
