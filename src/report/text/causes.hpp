#pragma once

#include "rift/report/text/findings.hpp"

namespace rift::report {

/// The text with a capital first letter.
std::string Capital(std::string text);

/// What matters, what does not, and why not.
Finding Because(const sweep::Explanation& explanation);

/// Start, frame, shape, and what a better simulator could remove.
Finding MadeOf(const sweep::Explanation& explanation);

}  // namespace rift::report
