#include "embedded.hpp"

#include <algorithm>
#include <cassert>

namespace rift::report {

std::string_view Embedded(std::string_view name) {
  const auto& files = EmbeddedFiles();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [name](const EmbeddedFile& file) { return file.name == name; });
  assert(found != files.end());
  return found->text;
}

}  // namespace rift::report
