#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rift::vision {

/// When a JPEG was taken by its camera's clock, in seconds since 1970 of whatever time zone that
/// clock has: DateTimeOriginal and, where it is there, SubSecTimeOriginal (Exif 2.32, 4.6.5).
/// Nothing where the first is missing or is no date. Reads no byte beyond those given.
std::optional<double> ExifTime_s(std::span<const std::uint8_t> jpeg);

/// The same of each picture, seconds after the first. Throws std::invalid_argument for one without
/// it, and for one that is not later than the picture before.
std::vector<double> TimesFromExif(const std::vector<std::string>& files);

}  // namespace rift::vision
