#include "picture_size.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "rift/vision/camera/jpeg.hpp"
#include "tiff.hpp"

namespace rift::vision {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool Begins(Bytes bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), bytes.begin(),
                    [](char letter, std::uint8_t byte) { return std::uint8_t(letter) == byte; });
}

/// Its first chunk holds it (ISO 15948 11.2.2).
std::optional<PictureSize> SizeOfPng(Bytes bytes) {
  if (bytes.size() < 24) return std::nullopt;
  const auto number = [&](std::size_t at) {
    return 16777216.0 * bytes[at] + 65536.0 * bytes[at + 1] + 256.0 * bytes[at + 2] + bytes[at + 3];
  };
  return PictureSize{number(16), number(20)};
}

/// BITMAPCOREHEADER and those after it; a height below zero is of rows from the top.
std::optional<PictureSize> SizeOfBmp(Bytes bytes) {
  constexpr std::uint32_t kCoreHeader = 12;
  if (bytes.size() < 26) return std::nullopt;
  const auto number = [&](std::size_t at) {
    return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8 |
           std::uint32_t{bytes[at + 2]} << 16 | std::uint32_t{bytes[at + 3]} << 24;
  };
  if (number(14) == kCoreHeader) {
    return PictureSize{double(number(18) & 0xFFFF), double(number(18) >> 16)};
  }
  const auto side = [&](std::size_t at) {
    return std::abs(static_cast<double>(static_cast<std::int32_t>(number(at))));
  };
  return PictureSize{side(18), side(22)};
}

std::optional<PictureSize> SizeOfTiff(Bytes bytes) {
  constexpr int kWidth = 256, kHeight = 257, kTileWidth = 322, kTileHeight = 323;
  const Tiff tiff(bytes);
  const auto root = tiff.Root();
  if (!root) return std::nullopt;
  const auto number = [&](int tag) {
    const auto entry = tiff.Find(*root, tag);
    return entry ? tiff.Value(*entry) : std::nullopt;
  };
  const auto width = number(kWidth), height = number(kHeight);
  if (!width || !height) return std::nullopt;
  const auto larger = [&](std::size_t side, int tile_tag) {
    return static_cast<double>(std::max(side, number(tile_tag).value_or(0)));
  };
  return PictureSize{larger(*width, kTileWidth), larger(*height, kTileHeight)};
}

/// Two numbers of digits behind "P5", white space and comments between them.
std::optional<PictureSize> SizeOfNetpbm(Bytes bytes) {
  std::array<double, 2> sides{};
  std::size_t at = 2;
  for (double& side : sides) {
    while (at < bytes.size() && (std::isspace(bytes[at]) != 0 || bytes[at] == '#')) {
      if (bytes[at] == '#') {
        while (at < bytes.size() && bytes[at] != '\n') ++at;
      } else {
        ++at;
      }
    }
    const std::size_t begin = at;
    for (; at < bytes.size() && std::isdigit(bytes[at]) != 0; ++at) {
      side = 10.0 * side + (bytes[at] - '0');
    }
    if (at == begin) return std::nullopt;
  }
  return PictureSize{sides[0], sides[1]};
}

}  // namespace

std::optional<PictureSize> StatedSize(std::span<const std::uint8_t> bytes) {
  using namespace std::string_view_literals;
  if (const auto size = SizeOfJpeg(bytes)) {
    return PictureSize{double(size->width_px), double(size->height_px)};
  }
  if (Begins(bytes, "\x89PNG\r\n\x1a\n"sv)) return SizeOfPng(bytes);
  if (Begins(bytes, "BM"sv)) return SizeOfBmp(bytes);
  if (Begins(bytes, "II*\0"sv) || Begins(bytes, "MM\0*"sv)) return SizeOfTiff(bytes);
  for (const std::string_view kind : {"P2", "P3", "P5", "P6"}) {
    if (Begins(bytes, kind)) return SizeOfNetpbm(bytes);
  }
  return std::nullopt;
}

}  // namespace rift::vision
