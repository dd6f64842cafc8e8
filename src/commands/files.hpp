#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace rift::commands {

/// The whole file. Throws std::invalid_argument with the path and the system's reason.
std::string ReadFile(const std::filesystem::path& path);

/// Writes beside the target and renames, so that the target is whole or absent. Missing parent
/// folders are made. Throws std::runtime_error with the path and the system's reason.
void WriteFile(const std::filesystem::path& path, std::string_view text);

}  // namespace rift::commands
