#include "multipart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace rift::vision {
namespace {

constexpr std::size_t kLargestPart = 64U << 20U;
constexpr std::string_view kBlankLine = "\r\n\r\n";

std::string Lower(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return lower;
}

std::optional<std::size_t> ContentLength(std::string_view headers) {
  constexpr std::string_view kName = "content-length:";
  const std::size_t name = Lower(headers).find(kName);
  if (name == std::string::npos) return {};
  const std::size_t digits = headers.find_first_of("0123456789", name + kName.size());
  std::size_t length = 0;
  if (digits == std::string::npos) return {};
  std::from_chars(headers.data() + digits, headers.data() + headers.size(), length);
  return length;
}

}  // namespace

MultipartReader::MultipartReader(std::string_view content_type) {
  constexpr std::string_view kBoundary = "boundary=";
  const std::string lower = Lower(content_type);
  const std::size_t at = lower.find(kBoundary);
  if (!lower.starts_with("multipart/") || at == std::string::npos) {
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

void MultipartReader::CheckSize() const {
  if (waiting_.size() <= kLargestPart) return;
  throw std::runtime_error(
      fmt::format("{} bytes without an end of the picture: the stream's "
                  "boundary '{}' does not come",
                  waiting_.size(), delimiter_));
}

bool MultipartReader::SkipToHeaders() {
  const std::size_t at = waiting_.find(delimiter_);
  if (at == std::string::npos) {
    CheckSize();
    return false;
  }
  waiting_.erase(0, at);
  return true;
}

std::optional<std::vector<std::uint8_t>> MultipartReader::Take() {
  if (!SkipToHeaders()) return {};
  const std::size_t blank = waiting_.find(kBlankLine);
  if (blank == std::string::npos) return {};
  const std::size_t begin = blank + kBlankLine.size();
  std::size_t end = 0;
  if (const auto length = ContentLength(std::string_view(waiting_).substr(0, blank))) {
    end = begin + *length;
    if (end > waiting_.size()) return CheckSize(), std::nullopt;
  } else {
    end = waiting_.find("\r\n" + delimiter_, begin);
    if (end == std::string::npos) return CheckSize(), std::nullopt;
  }
  std::vector<std::uint8_t> part(waiting_.begin() + begin, waiting_.begin() + end);
  waiting_.erase(0, end);
  return part;
}

}  // namespace rift::vision
