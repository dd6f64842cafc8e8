#pragma once

#include <string_view>
#include <vector>

namespace rift::report {

/// A file of src/report/page, or Vega, as it was when the program was built.
struct EmbeddedFile {
  std::string_view name;  ///< "page.html"
  std::string_view text;
};

/// Made by cmake/Embed.cmake.
const std::vector<EmbeddedFile>& EmbeddedFiles();

/// Its text; a name that is not there is our own mistake.
std::string_view Embedded(std::string_view name);

}  // namespace rift::report
