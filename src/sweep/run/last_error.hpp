#pragma once

#include <string>

namespace rift::sweep {

/// Why a program failed, of what it wrote to stderr: the last line; where that is one of those that
/// Node writes below an error, the error above, or what is nearest.
std::string ErrorIn(std::string text);

}  // namespace rift::sweep
