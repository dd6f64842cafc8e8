#pragma once

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// Plays the film in a window until it is over or the user leaves. Throws std::runtime_error with
/// MissingDisplay() where that is not empty.
void PlayInWindow(const Film& film, const ViewOptions& options);

}  // namespace rift::view
