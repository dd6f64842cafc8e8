#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rift::commands {

/// The whole file. Throws std::invalid_argument with the path and the system's reason.
std::string ReadFile(const std::filesystem::path& path);

/// Writes beside the target and renames, so that the target is whole or absent; a pipe or a device
/// is written to as it is, and a link leads to its file. Missing parent folders are made. Throws
/// std::runtime_error with the path and the system's reason.
void WriteFile(const std::filesystem::path& target, std::string_view text);

/// `out`, or out/NAME where none was asked for. Throws std::invalid_argument when the name of an
/// experiment would lead elsewhere.
std::filesystem::path OutputOf(const std::string& out, const std::string& name);

}  // namespace rift::commands
