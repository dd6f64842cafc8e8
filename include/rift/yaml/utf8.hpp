#pragma once

#include <cstddef>
#include <string_view>

namespace rift::yaml {

/// Bytes of the UTF-8 sequence at `text[at]`; 0 when there is no valid one (overlong forms,
/// surrogates and code points above U+10FFFF are not valid).
std::size_t Utf8Length(std::string_view text, std::size_t at);

/// Whether the whole text is valid UTF-8.
bool IsUtf8(std::string_view text);

}  // namespace rift::yaml
