#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace rift::files {

/// The whole file. Throws std::invalid_argument with the path and the system's reason, and for more
/// bytes than limits::Amount::kFileBytes, also of a device without an end.
std::string ReadFile(const std::filesystem::path& path);

/// The whole file; nothing when there is no such file. Throws as ReadFile does.
std::optional<std::string> ReadIfThere(const std::filesystem::path& path);

/// `name`, or, where there is no such file and rift is installed, the file of that name among those
/// that came with it (PREFIX/share/rift): configs/waypoints/paper.yaml works in any folder.
std::string FindInput(const std::string& name);

/// Writes beside the target and renames, so that the target is whole or absent; a pipe or a device
/// is written to as it is, and a link leads to its file. Missing parent folders are made. Throws
/// std::runtime_error with the path and the system's reason.
void WriteFile(const std::filesystem::path& target, std::string_view text);

/// Removes a file, or a folder with all that is in it; nothing there is fine. A folder that others
/// still write in is tried again for 5 s. The system's reason where something is left.
std::error_code RemoveAll(const std::filesystem::path& path);

/// True for the file that stdout or stderr of this process goes to, as /dev/stdout is. WriteFile()
/// puts the text behind what the stream holds and replaces nothing.
bool IsStandardStream(const std::filesystem::path& path);

/// One file behind two names, there or not.
bool IsSameFile(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace rift::files
