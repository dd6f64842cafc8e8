#pragma once

#include <string>

#include "rift/experiment/experiment.hpp"
#include "rift/hardware/arming.hpp"

namespace rift::report {

/// Loss, round trips, battery, which part of the budget is broken, and the keys of an experiment
/// that the measurement sets.
std::string PingJson(const hardware::PingResult& ping, const hardware::HardwareOptions& options);
std::string PingText(const hardware::PingResult& ping, const hardware::HardwareOptions& options);

/// As a simulated run's, with protocol, link, latency by stage, and how the drive was stopped.
std::string DriveJson(const experiment::Experiment& experiment, const hardware::DriveRun& run);
std::string DriveText(const hardware::DriveRun& run);

/// One row a pose: when it went through each stage. Cells of stages never reached are empty.
std::string StagesCsv(const hardware::DriveRecord& evidence);
/// The wheels in step with the camera: at the capture time of each pose, between two readings.
/// Poses before the first reading or after the last have no row.
std::string EncodersCsv(const hardware::DriveRecord& evidence);

}  // namespace rift::report
