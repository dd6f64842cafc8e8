#pragma once

#include <functional>
#include <string>

#include "rift/view/film.hpp"
#include "rift/view/options.hpp"

namespace rift::view {

/// Why no window can be opened here, in one line for people; empty when one can.
std::string MissingDisplay();

/// To be called before a window is opened; sets the environment so that none is opened on another
/// display, and none waits for a message bus that is not there. Throws std::runtime_error with
/// MissingDisplay() where that is not empty.
void RequireDisplay();

/// Plays the film in a window until it is over or the user leaves. Throws std::runtime_error with
/// MissingDisplay() where that is not empty.
void PlayInWindow(const Film& film, const ViewOptions& options);

/// Writes the film to `video` where one is named; then plays it in a window, if asked, or tells
/// `say` why there is none.
void ShowFilm(const Film& film, const std::string& video, bool window,
              const std::function<void(const std::string&)>& say);

}  // namespace rift::view
