#pragma once

#include <filesystem>
#include <string_view>

namespace rift::files {

/// The name of a file system that another machine, or a program, may stand behind ("NFS", "Lustre",
/// "FUSE", ...), where processes of two machines have no memory in common and locks are slow or
/// missing; empty for a local one. `type` is f_type of statfs(2).
std::string_view NetworkFileSystemName(unsigned long type);

/// The same of the file system that a path is on; empty as well when that cannot be told.
std::string_view NetworkFileSystemOf(const std::filesystem::path& path);

}  // namespace rift::files
