#pragma once

#include <string>

namespace rift::view {

/// Why no window can be opened here, in one line for people; empty when one can.
std::string MissingDisplay();

/// To be called before a window is opened. Throws std::runtime_error with MissingDisplay() where
/// that is not empty.
void RequireDisplay();

}  // namespace rift::view
