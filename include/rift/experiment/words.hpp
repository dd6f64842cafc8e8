#pragma once

#include <string>
#include <string_view>

#include "rift/experiment/parameter.hpp"

namespace rift::experiment {

/// The unit that the last part of a key names, as people write it: "s" of "processing_s", "m/s" of
/// "speed_mps"; empty where there is none.
std::string UnitOf(std::string_view name);

/// A parameter as an axis or a column calls it: "processing (s)", "v_min", "surface".
std::string LabelOf(std::string_view name);

/// A parameter at a value: "processing 0.25 s", "v_min 0.2"; a word stands for itself: "ground".
std::string NamedValue(const Parameter& parameter, const std::string& value_text);

/// What the schema says of a key, or of the only key with that last part; empty where it knows
/// none.
std::string HelpOf(std::string_view key);

}  // namespace rift::experiment
