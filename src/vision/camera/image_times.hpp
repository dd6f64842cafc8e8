#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rift::vision {

/// Natural order: digits compare as numbers, so that frame2 comes before frame10.
bool IsBefore(const std::string& a, const std::string& b);

/// When pictures were taken, seconds after the first, `fps` a second. Where the last numbers in
/// their names rise throughout, they are the time: the usual step between two of them is 1 / fps,
/// and pictures that are missing leave their time out. Otherwise they follow each other.
std::vector<double> TimesByNames(const std::vector<std::string>& files, double fps);

/// The same from a file of times: a line for each picture in their order, or `name seconds` in any
/// order (of further pictures as well), blanks or commas between; '#' begins a comment. Throws
/// std::invalid_argument `source:line: ...` for what is no time, for a picture with two, for times
/// that do not rise, and for too few or, without names, too many.
std::vector<double> TimesFromText(std::string_view text, const std::string& source,
                                  const std::vector<std::string>& files);

}  // namespace rift::vision
