#pragma once

#include <string>

namespace rift::module {

/// Why no window can be opened here, in one line for people; empty when one can.
std::string MissingDisplay();

}  // namespace rift::module
