#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace rift::vision {

/// Seconds since 1970, of whatever time zone, of `2026:11:23 12:34:56`; nothing for what is no date
/// and time.
std::optional<double> DateTime_s(std::string_view text);

/// When a JPEG was taken by its camera's clock, in seconds since 1970 of whatever time zone that
/// clock has: DateTimeOriginal and, where it is there, SubSecTimeOriginal (Exif 2.32, 4.6.5).
/// Nothing where the first is missing or is no date. Reads no byte beyond those given.
std::optional<double> ExifTime_s(std::span<const std::uint8_t> jpeg);

/// The same of each picture, seconds after the first. Throws std::invalid_argument for one without
/// it, and for one that is not later than the picture before.
std::vector<double> TimesFromExif(const std::vector<std::string>& files);

}  // namespace rift::vision
