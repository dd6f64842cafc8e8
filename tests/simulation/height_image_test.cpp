#include "rift/simulation/terrain.hpp"

#include <png.h>

#include <catch2/catch.hpp>
#include <string>
#include <vector>

namespace rift::simulation {
namespace {

/// A PNG made by libpng's simple writer; `format` is one of PNG_FORMAT_*.
std::string Encode(int columns, int rows, png_uint_32 format, const void* pixels) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = columns;
  image.height = rows;
  image.format = format;
  png_alloc_size_t size = 0;
  REQUIRE(png_image_write_get_memory_size(image, size, 0, pixels, 0, nullptr));
  std::string bytes(size, '\0');
  REQUIRE(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels, 0, nullptr));
  bytes.resize(size);
  return bytes;
}

TEST_CASE("A grey PNG becomes heights in proportion to its samples") {
  const std::vector<png_byte> pixels{0, 51, 102, 255, 204, 0};
  const HeightImage image = DecodeHeightImage(Encode(3, 2, PNG_FORMAT_GRAY, pixels.data()));
  CHECK(image.columns == 3);
  CHECK(image.rows == 2);
  REQUIRE(image.samples.size() == 6);
  for (size_t i = 0; i < 6; ++i) CHECK(image.samples[i] == Approx(pixels[i] / 255.0));
}

TEST_CASE("Sixteen bits are kept") {
  const std::vector<png_uint_16> pixels{0, 1, 32768, 65535};
  const HeightImage image = DecodeHeightImage(Encode(2, 2, PNG_FORMAT_LINEAR_Y, pixels.data()));
  for (size_t i = 0; i < 4; ++i) CHECK(image.samples[i] == Approx(pixels[i] / 65535.0));
}

TEST_CASE("A coloured PNG with transparency counts by its luminance") {
  const std::vector<png_byte> pixels{255, 255, 255, 255, 0, 0,   0, 255,
                                     100, 100, 100, 9,   0, 255, 0, 255};
  const HeightImage image = DecodeHeightImage(Encode(2, 2, PNG_FORMAT_RGBA, pixels.data()));
  CHECK(image.samples[0] == Approx(1.0));
  CHECK(image.samples[1] == 0.0);
  CHECK(image.samples[2] == Approx(100 / 255.0).margin(0.001));
  CHECK(image.samples[3] == Approx(0.86).margin(0.02));  // luminance of sRGB green
}

TEST_CASE("A picture may be 65536 pixels wide or high and no more") {
  const std::vector<png_byte> pixels(65537, 51);
  const auto decode = [&](int columns, int rows) {
    return DecodeHeightImage(Encode(columns, rows, PNG_FORMAT_GRAY, pixels.data()));
  };
  CHECK(decode(65536, 1).samples.back() == Approx(0.2));
  CHECK(decode(1, 65536).rows == 65536);
  CHECK_THROWS_WITH(decode(65537, 1), Catch::StartsWith("not a PNG height image: "));
  CHECK_THROWS_WITH(decode(1, 65537), Catch::StartsWith("not a PNG height image: "));
}

TEST_CASE("A picture of more pixels than are taken is refused before it is read") {
  const std::vector<png_byte> pixels(4096 * 4097, 51);
  CHECK_THROWS_WITH(
      DecodeHeightImage(Encode(4096, 4097, PNG_FORMAT_GRAY, pixels.data())),
      Catch::StartsWith("PNG height image: 16781312 pixels: at most 16777216 are taken"));
}

TEST_CASE("Bytes that are no PNG or end too early are refused") {
  CHECK_THROWS_AS(DecodeHeightImage("hello, this is no picture"), std::runtime_error);
  CHECK_THROWS_AS(DecodeHeightImage(""), std::runtime_error);
  const std::vector<png_byte> pixels(64 * 64, 77);
  const std::string bytes = Encode(64, 64, PNG_FORMAT_GRAY, pixels.data());
  for (const size_t kept : {size_t{8}, size_t{20}, bytes.size() / 2}) {
    CHECK_THROWS_WITH(DecodeHeightImage(bytes.substr(0, kept)),
                      "not a PNG height image: it ends too early");
  }
}

}  // namespace
}  // namespace rift::simulation
