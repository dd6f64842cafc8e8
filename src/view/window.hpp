#pragma once

#include <string>

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// See Viewer::PlayInWindow.
void PlayInWindow(const Film& film, const ViewOptions& options);

}  // namespace rift::view
