#include "embedded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace rift::report {

std::string_view Embedded(std::string_view name) {
  const auto& files = EmbeddedFiles();
  const auto found = std::find_if(files.begin(), files.end(),
                                  [name](const EmbeddedFile& file) { return file.name == name; });
  if (found == files.end()) throw std::logic_error(fmt::format("no embedded file {}", name));
  return found->text;
}

}  // namespace rift::report
