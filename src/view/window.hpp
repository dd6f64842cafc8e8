#pragma once

#include <string>

#include "rift/view/options.hpp"
#include "rift/view/scene.hpp"

namespace rift::view {

/// See Viewer::PlayInWindow.
void PlayInWindow(const Film& film, const ViewOptions& options);

}  // namespace rift::view
