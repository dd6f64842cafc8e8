#include "exif_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

#include "rift/vision/camera/jpeg.hpp"

namespace rift::vision {
namespace {

constexpr int kExifFolder = 0x8769, kDateTimeOriginal = 0x9003, kSubSecTimeOriginal = 0x9291;
constexpr int kAscii = 2, kLong = 4;
constexpr std::size_t kEntryBytes = 12;

/// The TIFF structure inside an Exif segment: folders of entries, offsets from its first byte
/// (TIFF 6.0, section 2). What lies outside reads as nothing.
class Tiff {
 public:
  explicit Tiff(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    is_little_ = bytes_.size() > 1 && bytes_[0] == 'I' && bytes_[1] == 'I';
  }

  struct Entry {
    int type = 0;
    std::size_t count = 0, at = 0;  ///< at: of its value or its offset
  };

  /// Where the first folder begins.
  std::optional<std::size_t> Root() const { return Number(2, 2) == 42U ? Number(4, 4) : none_; }
  std::optional<Entry> Find(std::size_t folder, int tag) const {
    const auto entries = Number(folder, 2);
    for (std::size_t i = 0; entries && i < *entries; ++i) {
      const std::size_t at = folder + 2 + i * kEntryBytes;
      const auto found = Number(at, 2), type = Number(at + 2, 2), count = Number(at + 4, 4);
      if (!found || !type || !count) return std::nullopt;
      if (*found == static_cast<std::size_t>(tag)) return Entry{int(*type), *count, at + 8};
    }
    return std::nullopt;
  }
  std::optional<std::size_t> Offset(const Entry& entry) const {
    return entry.type == kLong ? Number(entry.at, 4) : none_;
  }
  /// Up to its zero byte; up to four letters stand in the entry itself.
  std::string_view Text(const Entry& entry) const {
    const auto at = entry.count <= 4 ? entry.at : Number(entry.at, 4);
    if (entry.type != kAscii || !at || *at >= bytes_.size()) return {};
    const std::size_t length = std::min(entry.count, bytes_.size() - *at);
    const auto* letters = reinterpret_cast<const char*>(bytes_.data() + *at);
    return {letters, strnlen(letters, length)};
  }

 private:
  std::optional<std::size_t> Number(std::size_t at, std::size_t length) const {
    if (at > bytes_.size() || bytes_.size() - at < length) return std::nullopt;
    std::size_t number = 0;
    for (std::size_t i = 0; i < length; ++i) {
      number = number << 8 | bytes_[at + (is_little_ ? length - 1 - i : i)];
    }
    return number;
  }

  static constexpr std::optional<std::size_t> none_ = std::nullopt;
  std::span<const std::uint8_t> bytes_;
  bool is_little_ = false;
};

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
