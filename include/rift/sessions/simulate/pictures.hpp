#pragma once

#include "rift/report/figures/figure.hpp"
#include "rift/sessions/simulate/run.hpp"
#include "rift/view/film.hpp"

namespace rift::sessions {

/// Path, heights, speed and powers.
report::Figure FigureOf(const Simulated& made);

/// From above and from the side.
view::Film FilmOf(const Simulated& made);

}  // namespace rift::sessions
