#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rift::vision {

/// Natural order: digits compare as numbers, so that frame2 comes before frame10.
bool IsBefore(const std::string& a, const std::string& b);

/// Whether the names of pictures count them: the numbers at one place of their names, counted from
/// the end, rise throughout (frame012_cam2.jpg: the first). Unix seconds with a fraction, ten
/// digits and a point before more, are one number; so are a date and time, 20261127_101559 or in
/// one, which count in seconds.
bool AreCounted(const std::vector<std::string>& files);

/// When pictures were taken, seconds after the first, `fps` a second. Where their names count them,
/// by the last numbers that do, these are the time: the usual step between two of them is 1 / fps,
/// and pictures that are missing leave their time out. Otherwise they follow each other.
std::vector<double> TimesByNames(const std::vector<std::string>& files, double fps);

/// The same from a file of times: a line for each picture in their order, or `name seconds` in any
/// order (of further pictures as well), blanks or commas between; '#' begins a comment. Throws
/// std::invalid_argument `source:line: ...` for what is no time, for a picture with two, for times
/// that do not rise, and for too few or, without names, too many.
std::vector<double> TimesFromText(std::string_view text, const std::string& source,
                                  const std::vector<std::string>& files);

}  // namespace rift::vision
