#pragma once

#include <optional>
#include <string>

#include "rift/experiment/experiment.hpp"

namespace rift::experiment {

/// Throws std::invalid_argument, naming the file, when the experiment has neither waypoints nor a
/// program, as a robot's file has not, and shows how to give it some.
void RequireWaypoints(const Experiment& experiment, const std::string& file);
/// The same when the experiment is nothing to drive for another reason.
void RequireTask(const Experiment& experiment, const std::string& file);

/// Waypoints that no run can reach: throws std::invalid_argument, naming file and waypoint, for one
/// outside trial.arena, and for a path so long and so far out that its metres must be millimetres
/// or centimetres.
void RequireReachableWaypoints(const Experiment& experiment, const std::string& file);

/// A line about the first of the later waypoints that has a heading: the navigator turns to none of
/// them, and only the first waypoint's says where the robot looks. Nothing where none has.
std::optional<std::string> IdleHeadingNote(const Experiment& experiment, const std::string& file);

/// The experiment's tag. Where its surface is bumps, a ramp or a heightfield the tag is not held to
/// a flat floor (TagOptions::ground): `flat` becomes what the surface allows.
vision::TagOptions TagOn(const Experiment& experiment);

}  // namespace rift::experiment
