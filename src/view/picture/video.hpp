#pragma once

#include <filesystem>

#include "rift/view/scene.hpp"
#include "rift/view/view_options.hpp"

namespace rift::view {

/// See Viewer::WriteVideo.
void WriteVideo(const Film& film, const std::filesystem::path& path, const ViewOptions& options);

}  // namespace rift::view
