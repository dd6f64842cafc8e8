#include "image_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "exif_time.hpp"
#include "rift/statistics/descriptive.hpp"

namespace rift::vision {
namespace {

bool IsDigit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The digits from `at` on, zeros in front left out.
std::string_view DigitsAt(const std::string& text, std::size_t at) {
  std::size_t end = at;
  while (end < text.size() && IsDigit(text[end])) ++end;
  while (at + 1 < end && text[at] == '0') ++at;
  return std::string_view(text).substr(at, end - at);
}

std::size_t EndOfDigits(const std::string& text, std::size_t at) {
  while (at < text.size() && IsDigit(text[at])) ++at;
  return at;
}

/// Those from `at` on as they count behind a point: zeros at the end left out.
std::string_view FractionAt(const std::string& text, std::size_t at) {
  std::size_t end = EndOfDigits(text, at);
  while (end > at && text[end - 1] == '0') --end;
  return std::string_view(text).substr(at, end - at);
}

constexpr std::size_t kUnixDigits = 10;  // of seconds since 1970, from 2001 to 2286

/// A date and time in a name: where it ends, and its seconds.
struct DateTime {
  std::size_t end = 0;
  double t_s = 0.0;
};

/// `20261127_101559`, with any sign between, or in one; more digits are a fraction of a second.
std::optional<DateTime> DateTimeAt(const std::string& text, std::size_t at) {
  constexpr std::size_t kDate = 8, kTime = 6;
  std::size_t end = EndOfDigits(text, at);
  const bool is_parted = end - at == kDate && EndOfDigits(text, end + 1) - end > kTime;
  if (!is_parted && end - at < kDate + kTime) return std::nullopt;
  const std::size_t time_at = at + kDate + (is_parted ? 1 : 0);
  if (is_parted) end = EndOfDigits(text, time_at);
  const std::string_view all = text;
  // Other long numbers, such as nanoseconds, are dates of other centuries at most.
  const bool is_of_today = all.substr(at, 2) == "19" || all.substr(at, 2) == "20";
  const auto whole_s = DateTime_s(fmt::format(
      "{}:{}:{} {}:{}:{}", all.substr(at, 4), all.substr(at + 4, 2), all.substr(at + 6, 2),
      all.substr(time_at, 2), all.substr(time_at + 2, 2), all.substr(time_at + 4, 2)));
  if (!is_of_today || !whole_s) return std::nullopt;
  const std::string fraction = "0." + text.substr(time_at + kTime, end - time_at - kTime);
  return DateTime{end, *whole_s + std::strtod(fraction.c_str(), nullptr)};
}

/// The numbers in the name of a file, the last one first, its folder and ending left out; with
/// `has_dates` a date and time are one.
std::vector<double> NumbersIn(const std::string& file, bool has_dates) {
  const std::string stem = std::filesystem::path(file).stem().string();
  std::vector<double> numbers;
  for (std::size_t at = 0; at < stem.size();) {
    if (const auto taken = has_dates ? DateTimeAt(stem, at) : std::nullopt) {
      numbers.push_back(taken->t_s);
      at = taken->end;
      continue;
    }
    std::size_t end = EndOfDigits(stem, at);
    const bool has_fraction = end - at == kUnixDigits && end + 1 < stem.size() &&
                              stem[end] == '.' && IsDigit(stem[end + 1]);
    if (has_fraction) end = EndOfDigits(stem, end + 1);
    if (end > at) numbers.push_back(std::strtod(stem.substr(at, end - at).c_str(), nullptr));
    at = std::max(end, at + 1);
  }
  std::reverse(numbers.begin(), numbers.end());
  return numbers;
}

/// Those at one place of all names; none unless they rise.
std::optional<std::vector<double>> RisingAt(const std::vector<std::vector<double>>& names,
                                            std::size_t place) {
  std::vector<double> numbers;
  for (const std::vector<double>& name : names) {
    if (place >= name.size()) return std::nullopt;
    if (!numbers.empty() && name[place] <= numbers.back()) return std::nullopt;
    numbers.push_back(name[place]);
  }
  return numbers;
}

/// The last numbers of the names that rise throughout; none where none do. A count behind a date,
/// 20261127_000061, is no time of the day for long.
std::optional<std::vector<double>> RisingNumbers(const std::vector<std::string>& files) {
  for (const bool has_dates : {true, false}) {
    std::vector<std::vector<double>> names;
    for (const std::string& file : files) names.push_back(NumbersIn(file, has_dates));
    const std::size_t places = names.empty() ? 0 : names.front().size();
    for (std::size_t place = 0; place < places; ++place) {
      if (auto rising = RisingAt(names, place)) return rising;
    }
  }
  return std::nullopt;
}

/// The smallest step where all are multiples of it (counts, some missing), else the median (clock
/// times). 1 for a single number.
double UsualStep(const std::vector<double>& numbers) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < numbers.size(); ++i) steps.push_back(numbers[i] - numbers[i - 1]);
  if (steps.empty()) return 1.0;
  const double least = *std::min_element(steps.begin(), steps.end());
  const bool are_multiples = std::all_of(
      steps.begin(), steps.end(), [least](double step) { return std::fmod(step, least) == 0.0; });
  return are_multiples ? least : statistics::Median(steps);
}

std::string FileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

struct TimeLine {
  std::string name;  ///< none: the next picture's
  double t_s = 0.0;
};

/// Seconds from any clock's zero: Unix times of thirty thousand years.
constexpr double kFarthest_s = 1e12;

TimeLine ParseLine(std::string line, const std::string& where) {
  if (line.find('\0') != std::string::npos) {
    throw std::invalid_argument(
        fmt::format("{}: a byte 0 is in the line: a list of times is a text", where));
  }
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  std::vector<std::string> word;
  for (std::string each; words >> each;) word.push_back(each);
  char* end = nullptr;
  const double t_s = word.empty() ? 0.0 : std::strtod(word.back().c_str(), &end);
  if (word.empty() || word.size() > 2 || *end != '\0' || !(std::abs(t_s) <= kFarthest_s)) {
    throw std::invalid_argument(
        fmt::format("{}: '{}' is no time: seconds up to {:g}, or a picture's name and seconds",
                    where, line, kFarthest_s));
  }
  return {word.size() == 2 ? word[0] : "", t_s};
}

}  // namespace

bool IsBefore(const std::string& a, const std::string& b) {
  std::size_t i = 0, k = 0;
  while (i < a.size() && k < b.size()) {
    if (!IsDigit(a[i]) || !IsDigit(b[k])) {
      if (a[i] != b[k]) return a[i] < b[k];
      ++i, ++k;
      continue;
    }
    const std::string_view x = DigitsAt(a, i), y = DigitsAt(b, k);
    if (x.size() != y.size()) return x.size() < y.size();
    if (x != y) return x < y;
    i = EndOfDigits(a, i);
    k = EndOfDigits(b, k);
    // Programs leave zeros at the end of a time out: .5 comes after .25.
    if (x.size() != kUnixDigits || a[i] != '.' || b[k] != '.') continue;
    const std::string_view x_fraction = FractionAt(a, ++i), y_fraction = FractionAt(b, ++k);
    if (x_fraction != y_fraction) return x_fraction < y_fraction;
    i = EndOfDigits(a, i);
    k = EndOfDigits(b, k);
  }
  if (a.size() - i != b.size() - k) return a.size() - i < b.size() - k;
  return a < b;
}

bool AreCounted(const std::vector<std::string>& files) { return RisingNumbers(files).has_value(); }

std::vector<double> TimesByNames(const std::vector<std::string>& files, double fps) {
  std::vector<double> times_s;
  const auto numbers = RisingNumbers(files);
  const double step = numbers ? UsualStep(*numbers) : 1.0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const double count =
        numbers ? ((*numbers)[i] - numbers->front()) / step : static_cast<double>(i);
    times_s.push_back(count / fps);
  }
  return times_s;
}

std::vector<double> TimesFromText(std::string_view text, const std::string& source,
                                  const std::vector<std::string>& files) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  std::map<std::string, double> by_name;
  std::vector<double> in_order;
  std::istringstream lines{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line = line.substr(0, line.find('#'));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const std::string where = fmt::format("{}:{}", source, number);
    const TimeLine read = ParseLine(line, where);
    if (read.name.empty()) {
      in_order.push_back(read.t_s);
    } else if (!by_name.emplace(FileName(read.name), read.t_s).second) {
      throw std::invalid_argument(
          fmt::format("{}: a second time for the picture {}", where, read.name));
    }
    if (!in_order.empty() && !by_name.empty()) {
      throw std::invalid_argument(fmt::format(
          "{}: times with and without a picture's name: name all pictures, or none", where));
    }
  }
  // With a picture too few, all after it would have the time of another.
  if (in_order.size() > files.size()) {
    throw std::invalid_argument(fmt::format(
        "{}: {} times for {} pictures: name the pictures, as in `{} 0.5`", source, in_order.size(),
        files.size(), files.empty() ? "frame1.jpg" : FileName(files.front())));
  }
  std::vector<double> times_s;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const auto named = by_name.find(FileName(files[i]));
    if (named == by_name.end() && i >= in_order.size()) {
      throw std::invalid_argument(fmt::format("{}: no time for the picture {}", source, files[i]));
    }
    times_s.push_back(named != by_name.end() ? named->second : in_order[i]);
    if (i > 0 && times_s[i] <= times_s[i - 1]) {
      throw std::invalid_argument(
          fmt::format("{}: {:.9g} s of {} is not later than {:.9g} s of the picture before", source,
                      times_s[i], files[i], times_s[i - 1]));
    }
  }
  return times_s;
}

}  // namespace rift::vision
