#include "engine/image/png.h"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <cstddef>
#include <exception>
#include <string>

namespace vs {
namespace {

struct Pixels {
  const std::byte* first_row;
  size_t stride_bytes;
  int width;
  int height;
  int bit_depth;
  int color_type;
};

void Append(png_structp png, png_bytep bytes, png_size_t count) {
  auto* file = static_cast<std::vector<uint8_t>*>(png_get_io_ptr(png));
  bool appended = false;
  try {
    file->insert(file->end(), bytes, bytes + count);
    appended = true;
  } catch (const std::exception&) {  // must not pass through a C library
  }
  if (!appended) png_error(png, "out of memory");
}

void Fail(png_structp png, png_const_charp message) {
  *static_cast<std::string*>(png_get_error_ptr(png)) = message;
  png_longjmp(png, 1);
}

void Ignore(png_structp, png_const_charp) {}

// False after an error. libpng leaves it by longjmp, so nothing here has a destructor.
bool Write(png_structp png, png_infop info, const Pixels& pixels, std::vector<uint8_t>* file) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, file, Append, nullptr);
  png_set_compression_level(png, Z_BEST_SPEED);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, pixels.width, pixels.height, pixels.bit_depth, pixels.color_type,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if (pixels.bit_depth == 16) png_set_swap(png);  // files are big-endian
  for (int y = 0; y < pixels.height; ++y) {
    png_write_row(png,
                  reinterpret_cast<png_const_bytep>(pixels.first_row + pixels.stride_bytes * y));
  }
  png_write_end(png, info);
  return true;
}

template <class T>
Result<std::vector<uint8_t>> Encode(const Image<T>& image, int bit_depth, int color_type) {
  if (image.empty()) return InvalidArgument("an empty picture cannot be saved");
  std::string error;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, Fail, Ignore);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  std::vector<uint8_t> file;
  const Pixels pixels{reinterpret_cast<const std::byte*>(image.Row(0)),
                      image.stride_bytes(),
                      image.width(),
                      image.height(),
                      bit_depth,
                      color_type};
  const bool written = info != nullptr && Write(png, info, pixels, &file);
  png_destroy_write_struct(&png, &info);
  if (!written) return ResourceExhausted("the picture cannot be packed as PNG: " + error);
  return file;
}

}  // namespace

Result<std::vector<uint8_t>> EncodePng(const GreyImage& image) {
  return Encode(image, 8, PNG_COLOR_TYPE_GRAY);
}
Result<std::vector<uint8_t>> EncodePng(const Image<uint16_t>& image) {
  return Encode(image, 16, PNG_COLOR_TYPE_GRAY);
}
Result<std::vector<uint8_t>> EncodePng(const ColorImage& image) {
  return Encode(image, 8, PNG_COLOR_TYPE_RGB);
}

}  // namespace vs
