#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// What of the task is not driven, at most a line of each kind: a heading of a later waypoint,
/// since only the first one's says where the robot looks; a waypoint that counts as reached while
/// the robot is at the one before it; everything, where the trial ends before its first power.
/// Nothing where all of it is driven.
std::vector<std::string> TaskNotes(const Experiment& experiment, const std::string& file);

/// A line about commands that the simulated serial line cannot take as fast as they are decided, so
/// that each waits longer for its turn than the one before. Nothing for a line that takes them.
std::optional<std::string> FullLineNote(const Experiment& experiment);

/// A line about a host_period_s of a surface to drive on, which changes nothing while
/// simulation.mocap.host_period_s is none. Nothing where it counts.
std::optional<std::string> IdleHostNote(const Experiment& experiment);

/// world_from_robot, of the middle of the axle, of a simulated robot that is put down as a real one
/// is: its tag (simulation.mocap.tag_ahead_m) on the start of the task, which has a first waypoint.
geometry::Pose2 AxleAtStart(const Experiment& experiment);

/// The experiment's tag. Where its surface is bumps, a ramp or a heightfield the tag is not held to
/// a flat floor (TagOptions::ground): `flat` becomes what the surface allows.
vision::TagOptions TagOn(const Experiment& experiment);

}  // namespace rift::experiment
