#pragma once

namespace rift::view {

/// The one symbol the module exports: `Viewer* ()`, the caller owns the result. The number goes up
/// whenever Viewer, Film or ViewOptions change, so that a stale module is refused by name.
inline constexpr const char* kMakeViewerSymbol = "rift_view_make_viewer_1";

}  // namespace rift::view
