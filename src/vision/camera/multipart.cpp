#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <stdexcept>

#include "sources.hpp"

namespace rift::vision {
namespace {

/// No camera sends more lines about one picture.
constexpr std::size_t kLargestHead = 16 * 1024;

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::string_view Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The number of a whole Content-Length line; X-Content-Length is another header. A number that no
/// std::size_t holds is the largest one.
std::optional<std::size_t> ContentLength(std::string_view headers) {
  constexpr std::string_view kName = "content-length:";
  while (!headers.empty()) {
    const std::size_t end = std::min(headers.find('\n'), headers.size());
    const std::string_view line = Trimmed(headers.substr(0, end));
    headers.remove_prefix(std::min(end + 1, headers.size()));
    if (!Lower(line).starts_with(kName)) continue;
    const std::string_view digits = Trimmed(line.substr(kName.size()));
    std::size_t length = 0;
    const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), length);
    if (read.ec == std::errc::result_out_of_range) return SIZE_MAX;
    if (read.ec != std::errc{} || read.ptr != digits.data() + digits.size()) return std::nullopt;
    return length;
  }
  return std::nullopt;
}

}  // namespace

MultipartReader::MultipartReader(std::string_view content_type, std::size_t most_bytes)
    : most_bytes_(most_bytes) {
  constexpr std::string_view kBoundary = "boundary=";
  const std::string lower = Lower(content_type);
  const std::size_t at = lower.find(kBoundary);
  if (lower.starts_with("multipart/") && at == std::string::npos) {
    throw std::invalid_argument(fmt::format(
        "the server names no boundary between its pictures: it sends '{}', without boundary=",
        content_type));
  }
  if (!lower.starts_with("multipart/")) {
    throw std::invalid_argument(
        fmt::format("the server sends '{}', but rift reads MJPEG (multipart/x-mixed-replace)",
                    content_type.empty() ? "no content type" : content_type));
  }
  std::string_view boundary = content_type.substr(at + kBoundary.size());
  boundary = boundary.substr(0, boundary.find(';'));
  while (!boundary.empty() && (boundary.back() == '"' || boundary.back() == ' ')) {
    boundary.remove_suffix(1);
  }
  if (boundary.starts_with('"')) boundary.remove_prefix(1);
  delimiter_ = boundary.starts_with("--") ? std::string(boundary) : "--" + std::string(boundary);
}

void MultipartReader::PassOver(std::size_t bytes) {
  waiting_.erase(0, bytes);
  ++skipped_;
}

bool MultipartReader::SkipToBoundary() {
  const std::size_t at = waiting_.find(delimiter_);
  if (at != std::string::npos) {
    waiting_.erase(0, at);
    return true;
  }
  if (waiting_.size() > most_bytes_) {
    throw std::runtime_error(
        fmt::format("{} bytes without the stream's boundary '{}'", waiting_.size(), delimiter_));
  }
  return false;
}

std::optional<MultipartReader::Head> MultipartReader::TakeHead() const {
  const std::string_view all = waiting_;
  const std::size_t crlf = all.find("\r\n\r\n"), lf = all.find("\n\n");
  const std::size_t blank = std::min(crlf, lf);
  if (blank == std::string_view::npos || blank > kLargestHead) return std::nullopt;
  return Head{blank + (crlf < lf ? 4U : 2U), ContentLength(all.substr(0, blank))};
}

std::optional<std::size_t> MultipartReader::EndOf(const Head& head) const {
  if (head.length) {
    const bool is_whole = *head.length <= waiting_.size() - head.begin;
    return is_whole ? std::optional(head.begin + *head.length) : std::nullopt;
  }
  // What was named with dashes is meant with them, or by the letter (RFC 2046) with two more.
  std::size_t end = std::min(waiting_.find("\n" + delimiter_, head.begin),
                             waiting_.find("\n--" + delimiter_, head.begin));
  if (end == std::string::npos) return std::nullopt;
  if (end > head.begin && waiting_[end - 1] == '\r') --end;
  return end;
}

std::optional<std::vector<std::uint8_t>> MultipartReader::Take() {
  while (SkipToBoundary()) {
    const std::optional<Head> head = TakeHead();
    if (!head) {
      if (waiting_.size() <= kLargestHead + delimiter_.size()) return std::nullopt;
      PassOver(delimiter_.size());  // no head of a part: on to the next boundary
      continue;
    }
    if (head->length && *head->length > most_bytes_) {
      PassOver(head->begin);
      continue;
    }
    const std::optional<std::size_t> end = EndOf(*head);
    if (!end) {
      if (waiting_.size() <= head->begin + most_bytes_) return std::nullopt;
      // All of it is the part's but for what may be the begin of a boundary.
      PassOver(std::max(head->begin, waiting_.size() - delimiter_.size()));
      continue;
    }
    std::vector<std::uint8_t> part(waiting_.begin() + static_cast<std::ptrdiff_t>(head->begin),
                                   waiting_.begin() + static_cast<std::ptrdiff_t>(*end));
    waiting_.erase(0, *end);
    return part;
  }
  return std::nullopt;
}

}  // namespace rift::vision
