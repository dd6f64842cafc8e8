#pragma once

#include <string_view>

namespace rift::sweep {

/// Fingerprint of the sources of everything that a simulated trial runs through: rows of an older
/// one may be other rows today.
std::string_view PhysicsVersion();

}  // namespace rift::sweep
