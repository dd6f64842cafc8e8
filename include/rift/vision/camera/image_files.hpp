#pragma once

#include <string>
#include <vector>

namespace rift::vision {

/// The pictures of a folder, of a glob (`run/*.jpg`), or one file, in the order of their names.
/// Throws std::invalid_argument when there is none.
std::vector<std::string> ImageFiles(const std::string& pattern);

}  // namespace rift::vision
