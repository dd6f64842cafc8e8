#pragma once

#include <optional>
#include <string>

namespace rift::report {

/// Whether the robot stands after a drive, as far as it says (DriveRecord::stop_acknowledged): one
/// line, without its end.
std::string StopText(std::optional<bool> acknowledged);

}  // namespace rift::report
