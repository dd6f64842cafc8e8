#include "rift/simulation/terrain.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <stdexcept>

#include "rift/limits/limits.hpp"

namespace rift::simulation {
namespace {

constexpr png_uint_32 kMaxSide = 65536;

void RememberError(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}
void IgnoreWarning(png_structp, png_const_charp) {}

void TakeBytes(png_structp png, png_bytep to, size_t count) {
  auto* left = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (left->size() < count) png_error(png, "it ends too early");
  std::copy_n(left->begin(), count, to);
  left->remove_prefix(count);
}

/// The only user of libpng. Its errors are long jumps: every function that calls into it is entered
/// through setjmp and owns nothing that a jump would skip.
class PngReader {
 public:
  explicit PngReader(std::string_view bytes)
      : png_(png_create_read_struct(PNG_LIBPNG_VER_STRING, &error_, RememberError, IgnoreWarning)),
        info_(png_ ? png_create_info_struct(png_) : nullptr),
        bytes_(bytes) {}
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Reads up to the pixels and asks for one grey sample of 16 bits a pixel.
  bool Open() {
    if (!png_ || !info_ || setjmp(png_jmpbuf(png_))) return false;
    png_set_read_fn(png_, &bytes_, TakeBytes);
    png_set_user_limits(png_, kMaxSide, kMaxSide);
    SkipMetadata();
    png_read_info(png_, info_);
    png_set_expand_16(png_);
    png_set_strip_alpha(png_);
    if (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) {
      png_set_rgb_to_gray(png_, PNG_ERROR_ACTION_NONE, PNG_RGB_TO_GRAY_DEFAULT,
                          PNG_RGB_TO_GRAY_DEFAULT);
    }
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool ReadRows(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_))) return false;
    png_read_image(png_, rows);
    return true;
  }
  int Columns() const { return static_cast<int>(png_get_image_width(png_, info_)); }
  int Rows() const { return static_cast<int>(png_get_image_height(png_, info_)); }
  size_t BytesPerRow() const { return png_get_rowbytes(png_, info_); }
  const std::string& Error() const { return error_; }

 private:
  /// libpng asks for as much memory as such a chunk says that it is long, up to 2 GB.
  void SkipMetadata() {
    constexpr png_byte kNames[] = "sPLT\0iCCP\0tEXt\0zTXt\0iTXt\0eXIf\0hIST\0pCAL\0sCAL";
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, kNames, sizeof(kNames) / 5);
  }

  std::string error_ = "no memory for libpng";
  png_structp png_;
  png_infop info_;
  std::string_view bytes_;
};

[[noreturn]] void Fail(const std::string& why) {
  throw std::runtime_error("not a PNG height image: " + why);
}

double BigEndian16(const png_byte* bytes) {
  return static_cast<double>(bytes[0] * 256 + bytes[1]) / 65535.0;
}

}  // namespace

HeightImage DecodeHeightImage(std::string_view png_bytes) {
  PngReader reader(png_bytes);
  if (!reader.Open()) Fail(reader.Error());
  limits::Require(limits::Amount::kPixels, 1.0 * reader.Columns() * reader.Rows(),
                  "PNG height image");

  if (reader.BytesPerRow() != 2u * reader.Columns()) Fail("its pixels do not turn into grey");
  HeightImage image{reader.Columns(), reader.Rows(), {}};
  std::vector<png_byte> pixels(reader.BytesPerRow() * image.rows);
  std::vector<png_bytep> rows(image.rows);
  for (int row = 0; row < image.rows; ++row) rows[row] = &pixels[row * reader.BytesPerRow()];
  if (!reader.ReadRows(rows.data())) Fail(reader.Error());

  image.samples.reserve(static_cast<size_t>(image.columns) * image.rows);
  for (const png_byte* row : rows) {
    for (int column = 0; column < image.columns; ++column) {
      image.samples.push_back(BigEndian16(row + 2 * column));
    }
  }
  return image;
}

}  // namespace rift::simulation
