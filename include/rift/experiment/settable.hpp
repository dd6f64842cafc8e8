#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rift/experiment/parameter.hpp"

namespace rift::experiment {

/// How a person sets a key on the real robot, as part of the schema.
struct Settable {
  double step = 0.0;  ///< of a number, in the key's unit; 0 for words
};

/// Nothing for keys that only a simulator has: a motor's mismatch, a radio's delay. A column of
/// recorded logs or a parameter of a program ("v_min") is known by the last part of the key that it
/// is named after, unless several keys end in it ("p") or it is of a list ("x").
std::optional<Settable> FindSettable(std::string_view key);

/// The schema's answer, unless the space says otherwise (settable: true or false).
bool IsSettable(const Parameter& parameter);

/// The step of a range in which a person sets it: what the space says (step: 0.01), else the
/// schema, else the next 1, 2 or 5 times a power of ten above a twentieth of the range.
double StepOf(const Parameter& parameter);

/// The value nearest to this one that a person can set: a whole number of steps within the range;
/// of a list the value itself. Of a range that is even in its logarithm, goes over a decade or
/// more, and has a step neither in the space nor in the schema: 1, 2 or 5 times a power of ten.
ParameterValue NearestSettable(const Parameter& parameter, const ParameterValue& value);

}  // namespace rift::experiment
