#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Gives the bytes of a file; throws any std::exception when it cannot.
using FileReader = std::function<std::string(const std::string& path)>;

/// One YAML document as a tree; an empty text is a null node. `source` stands in the origins.
/// A plain key with dots is a path: `gap.samples: 5` means `gap: {samples: 5}`; a quoted key is
/// taken as it is. Throws Error (with `source:line:column`) for anything that is not one document
/// of UTF-8 YAML, for a key given twice (naming both places), for anchors, aliases, merge keys and
/// tags, and for more than kMaxDepth levels.
Node Parse(std::string_view text, const std::string& source);
inline constexpr int kMaxDepth = 64;

/// Reads a file and those it includes: `include: other.yaml`, or a list of them, at its top level,
/// relative to the including file. Included values come first, later ones win, the including file
/// wins over all. The result is a map without the key `include`.
/// Throws Error for a missing file (where it was included), a cycle (naming the chain), a file
/// that is no map, and for whatever Parse refuses.
Node Load(const std::string& path, const FileReader& read);

/// The tree of one `--set` argument: `a.b=c` -> `{a: {b: c}}`, with c read as YAML. To be merged
/// over the loaded tree. Throws Error.
Node ParseOverride(std::string_view assignment);

}  // namespace rift::yaml
