#pragma once

#include <string>
#include <string_view>

#include "rift/yaml/node.hpp"

namespace rift::yaml {

/// Refuses what yaml-cpp would silently repair or misread: bytes that are no UTF-8, control
/// characters (it takes 0x04 for the end of the file), and tabs in an indentation.
/// Throws Error with `source:line:column`.
void CheckText(std::string_view text, const std::string& source);

/// Refuses a quoted scalar at `text[at]` that the end of the text cuts off: yaml-cpp takes it as
/// closed when a line break comes before the end. Throws Error; other scalars pass.
void CheckClosed(std::string_view text, std::size_t at, const Origin& origin);

}  // namespace rift::yaml
