#include "exif_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "rift/vision/camera/jpeg.hpp"
#include "tiff.hpp"

namespace rift::vision {
namespace {

constexpr int kExifFolder = 0x8769, kDateTimeOriginal = 0x9003, kSubSecTimeOriginal = 0x9291;

std::optional<int> Digits(std::string_view text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 0) return std::nullopt;
  return number;
}

/// "25" is 0.25 s.
double FractionOf(std::string_view text) {
  double fraction = 0.0, unit = 0.1;
  for (const char letter : text) {
    if (letter < '0' || letter > '9') break;
    fraction += unit * (letter - '0');
    unit /= 10.0;
  }
  return fraction;
}

/// The head of a file: an Exif segment is short and comes first.
std::vector<std::uint8_t> HeadOf(const std::string& path) {
  constexpr std::streamsize kHeadBytes = 256 * 1024;
  if (!std::filesystem::is_regular_file(path)) return {};  // a pipe would be waited for
  std::vector<std::uint8_t> bytes(kHeadBytes);
  std::ifstream file(path, std::ios::binary);
  file.read(reinterpret_cast<char*>(bytes.data()), kHeadBytes);
  bytes.resize(static_cast<std::size_t>(file.gcount()));
  return bytes;
}

}  // namespace

std::optional<double> DateTime_s(std::string_view text) {
  using std::chrono::day, std::chrono::month, std::chrono::year;
  if (text.size() != 19) return std::nullopt;
  const auto y = Digits(text.substr(0, 4)), m = Digits(text.substr(5, 2)),
             d = Digits(text.substr(8, 2)), hour = Digits(text.substr(11, 2)),
             minute = Digits(text.substr(14, 2)), second = Digits(text.substr(17, 2));
  if (!y || !m || !d || !hour || !minute || !second) return std::nullopt;
  const std::chrono::year_month_day date{year(*y), month(unsigned(*m)), day(unsigned(*d))};
  if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) return std::nullopt;
  const auto days = static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count());
  return 86400.0 * days + 3600.0 * *hour + 60.0 * *minute + *second;
}

std::optional<double> ExifTime_s(std::span<const std::uint8_t> jpeg) {
  const Tiff tiff(ExifOfJpeg(jpeg));
  const auto root = tiff.Root();
  const auto folder = root ? tiff.Find(*root, kExifFolder) : std::nullopt;
  const auto at = folder ? tiff.Offset(*folder) : std::nullopt;
  if (!at) return std::nullopt;
  const auto taken = tiff.Find(*at, kDateTimeOriginal);
  const auto seconds = taken ? DateTime_s(tiff.Text(*taken)) : std::nullopt;
  if (!seconds) return std::nullopt;
  const auto fraction = tiff.Find(*at, kSubSecTimeOriginal);
  return *seconds + (fraction ? FractionOf(tiff.Text(*fraction)) : 0.0);
}

std::vector<double> TimesFromExif(const std::vector<std::string>& files) {
  std::vector<double> times_s;
  double first_s = 0.0;
  for (const std::string& file : files) {
    const std::optional<double> taken_s = ExifTime_s(HeadOf(file));
    if (!taken_s) {
      throw std::invalid_argument(fmt::format(
          "{}: no DateTimeOriginal in its EXIF data; --times FILE takes a list of times", file));
    }
    if (times_s.empty()) first_s = *taken_s;
    const double t_s = *taken_s - first_s;
    if (!times_s.empty() && t_s <= times_s.back()) {
      throw std::invalid_argument(
          fmt::format("{}: by its EXIF data it was taken {:.3f} s after the first picture, not "
                      "later than the one before ({:.3f} s): a camera that writes no "
                      "SubSecTimeOriginal tells whole seconds only",
                      file, t_s, times_s.back()));
    }
    times_s.push_back(t_s);
  }
  return times_s;
}

}  // namespace rift::vision
