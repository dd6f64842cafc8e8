#pragma once

#include <string>

namespace rift::files {

/// `text` in single quotes, which a shell takes for one word, whatever it holds.
std::string ShellQuoted(const std::string& text);
/// The same for people to read and type: without quotes where a shell needs none.
std::string ShellWord(const std::string& text);

}  // namespace rift::files
