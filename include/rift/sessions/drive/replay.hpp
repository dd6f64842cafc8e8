#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "rift/view/film.hpp"

namespace rift::sessions {

/// Throws std::invalid_argument unless the folder holds the experiment and the log of a drive.
void RequireDrive(const std::filesystem::path& folder);

/// The drive in a folder, finished or interrupted: its log, and in words how it ended. Tells `say`
/// what had to be mended in the log, one line each.
view::Run LoadDrive(const std::filesystem::path& folder,
                    const std::function<void(const std::string&)>& say);

}  // namespace rift::sessions
