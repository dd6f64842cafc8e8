#pragma once

#include <string>

#include "rift/vision/rendering/precision_map.hpp"

namespace rift::report {

/// A precision map as a person reads it: position and heading errors and the smallest tag, each
/// laid out as the picture is, then what it means for a drive.
std::string PrecisionText(const vision::PrecisionMap& map, const vision::TagOptions& tag);

/// The same place by place (docs/json.md).
std::string PrecisionJson(const vision::PrecisionMap& map, const vision::TagOptions& tag,
                          const vision::SyntheticCameraOptions& look);

}  // namespace rift::report
