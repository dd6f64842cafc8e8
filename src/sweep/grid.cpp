#include "rift/sweep/grid.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "rift/sweep/options.hpp"

namespace rift::sweep {

Space PaperSpace() {
  return {{{.key = "simulation.terrain.surface",
            .levels = {{"ground", {}},
                       {"cardboard", {}},
                       {"parchment", {}},
                       {"uphill", {}},
                       {"downhill", {}}}},
           {.key = "control.v_min", .levels = {{"0.15", 0.15}, {"0.20", 0.20}}},
           {.key = "control.v_max", .levels = {{"0.30", 0.30}, {"0.40", 0.40}, {"0.50", 0.50}}}}};
}

std::vector<std::vector<ParameterValue>> GridPoints(const std::vector<Parameter>& parameters) {
  std::vector<std::vector<ParameterValue>> points{{}};
  for (const Parameter& parameter : parameters) {
    if (parameter.IsContinuous()) {
      throw std::invalid_argument(
          fmt::format("space.{} is a range, and a grid needs the values to visit: write a list",
                      parameter.key));
    }
    std::vector<std::vector<ParameterValue>> longer;
    longer.reserve(points.size() * parameter.levels.size());
    for (const auto& point : points) {
      for (const ParameterValue& level : parameter.levels) {
        longer.push_back(point);
        longer.back().push_back(level);
      }
    }
    points = std::move(longer);
  }
  return points;
}

}  // namespace rift::sweep
