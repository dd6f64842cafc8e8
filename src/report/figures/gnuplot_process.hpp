#pragma once

#include <string>

namespace rift::report {

/// What gnuplot writes to its standard output for a script on its standard input.
/// Throws std::runtime_error when it is not installed or complains.
std::string RunGnuplot(const std::string& script);

}  // namespace rift::report
