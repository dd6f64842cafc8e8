#pragma once

#include <string>

#include "rift/view/scene.hpp"
#include "rift/view/view_options.hpp"

namespace rift::view {

/// See Viewer::PlayInWindow.
void PlayInWindow(const Film& film, const ViewOptions& options);

}  // namespace rift::view
