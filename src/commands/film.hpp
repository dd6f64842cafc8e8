#pragma once

#include <string>
#include <vector>

#include "rift/experiment/experiment.hpp"
#include "rift/view/film.hpp"

namespace rift::commands {

/// The robot's outline as its simulation has it.
view::BodyShape ShapeOf(const simulation::BodyOptions& body);

/// The task in the picture: its waypoints, and the polyline through them as the path to keep.
void ShowTask(view::Run& shown, const std::vector<control::Waypoint>& waypoints);

/// Writes the film to `video` where one is named; then plays it in a window, if asked, or says why
/// there is none.
void ShowFilm(const view::Film& film, const std::string& video, bool window);

}  // namespace rift::commands
