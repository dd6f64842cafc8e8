#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace rift::terminal {

/// What a line break in a text is: a part of a name that somebody else chose, or our own.
enum class LineBreaks { kEscaped, kKept };

/// The text as a terminal may show it. Names, http headers and file contents are of foreign origin
/// and may hold what a terminal obeys or hides, so these are escaped: control characters below
/// 0x20, DEL and bytes that are no UTF-8 as \xNN; C1 controls (U+009B starts a sequence as ESC [
/// does), line separators, and the characters that turn the direction of writing as \u{...}.
/// A backslash stays as it is: the result is for people and cannot be read back.
std::string TerminalText(std::string_view text, LineBreaks line_breaks);

/// At most so many characters of what TerminalText made, none of them cut.
std::string FirstCharacters(const std::string& text, std::size_t most);

}  // namespace rift::terminal
