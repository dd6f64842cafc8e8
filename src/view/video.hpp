#pragma once

#include <filesystem>

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// See Viewer::WriteVideo.
void WriteVideo(const Film& film, const std::filesystem::path& path, const ViewOptions& options);

}  // namespace rift::view
