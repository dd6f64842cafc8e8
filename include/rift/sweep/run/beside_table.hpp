#pragma once

namespace rift::sweep {

/// Keys of what a journal keeps beside the rows of the sweep's table begin so: trials beyond its
/// own, a calibration. A summary of the journal counts none of them.
inline constexpr const char* kBesideTable = "beside the table: ";

}  // namespace rift::sweep
