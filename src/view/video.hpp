#pragma once

#include <filesystem>

#include "rift/view/options.hpp"
#include "rift/view/scene.hpp"

namespace rift::view {

/// See Viewer::WriteVideo.
void WriteVideo(const Film& film, const std::filesystem::path& path, const ViewOptions& options);

}  // namespace rift::view
