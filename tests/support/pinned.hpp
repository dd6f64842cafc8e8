#pragma once

#include <string>

namespace rift::test {

/// Empty when `text` is what tests/pinned/`name` holds, else the first line that differs, from
/// both. Words are compared byte for byte; numbers may differ by one in the ninth digit, as
/// roundings of another compiler do. The version of rift counts as one word. With RIFT_PIN=1 in the
/// environment the file is written instead, so that a wanted change is a difference that somebody
/// reads.
std::string DifferenceFromPinned(const std::string& name, std::string text);

}  // namespace rift::test
