#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace rift::test {

inline std::string BigEndian(std::uint32_t number) {
  std::string bytes;
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift);
  return bytes;
}

inline std::string PngChunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum =
      crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()));
  return BigEndian(static_cast<std::uint32_t>(data.size())) + body +
         BigEndian(static_cast<std::uint32_t>(sum));
}

/// A square grey picture; `rows` are those of the file, each after its filter byte.
inline std::string Png(std::uint32_t side, int bits_a_pixel, const std::string& rows) {
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(rows.data()), rows.size());
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         PngChunk("IHDR", BigEndian(side) + BigEndian(side) + static_cast<char>(bits_a_pixel) +
                              std::string(4, '\0')) +
         PngChunk("IDAT", packed) + PngChunk("IEND", "");
}

/// All black, of one bit a pixel: few bytes for many pixels.
inline std::string BlackPng(std::uint32_t side) {
  return Png(side, 1, std::string(static_cast<size_t>(side) * (1 + (side + 7) / 8), '\0'));
}

/// 4 x 4 pixels that rise to this grey from left to right.
inline std::string RampPng(int grey) {
  std::string rows;
  for (int row = 0; row < 4; ++row) {
    rows += '\0';
    for (int column = 0; column < 4; ++column) rows += static_cast<char>(grey * column / 3);
  }
  return Png(4, 8, rows);
}

}  // namespace rift::test
