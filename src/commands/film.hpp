#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/view/film.hpp"

namespace rift::commands {

/// The robot's outline as its simulation has it.
view::BodyShape ShapeOf(const simulation::BodyOptions& body);

/// Writes the film to `video` where one is named; then plays it in a window, if asked, or says why
/// there is none.
void ShowFilm(const view::Film& film, const std::string& video, bool window);

}  // namespace rift::commands
