#pragma once

#include <string>

namespace rift::commands {

/// Name and version, the commit it was built from, compiler and the libraries it was built with: a
/// line each.
std::string VersionText();

}  // namespace rift::commands
