#pragma once

#include <filesystem>

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// An H.264 file, named so only once it is whole. Throws std::runtime_error when it cannot be
/// written, std::invalid_argument when the name does not end in .mp4.
void WriteVideo(const Film& film, const std::filesystem::path& path, const ViewOptions& options);

}  // namespace rift::view
