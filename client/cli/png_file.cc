#include "client/cli/png_file.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>

namespace vs::cli {
namespace {

constexpr int kCompression = 3;  // of 1..9; more saves little and takes much longer

// Nothing with a destructor may live here: libpng leaves it by longjmp when something fails.
bool Write(png_structp png, png_infop info, std::FILE* file, int width, int height,
           const uint16_t* pixels) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;  // NOLINT(cert-err52-cpp)
  png_init_io(png, file);
  png_set_compression_level(png, kCompression);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), 16,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  for (int y = 0; y < height; ++y) {
    const uint16_t* row = pixels + static_cast<size_t>(y) * static_cast<size_t>(width);
    png_write_row(png, reinterpret_cast<png_const_bytep>(row));
  }
  png_write_end(png, info);
  return true;
}

}  // namespace

bool WritePng16(const std::filesystem::path& path, int width, int height,
                const std::vector<uint16_t>& pixels) {
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (file == nullptr) return false;
  const auto quiet = [](png_structp, png_const_charp) {};
  const auto leave = [](png_structp png, png_const_charp) { png_longjmp(png, 1); };
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, leave, quiet);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool written = info != nullptr && Write(png, info, file, width, height, pixels.data());
  png_destroy_write_struct(&png, &info);
  return std::fclose(file) == 0 && written;
}

}  // namespace vs::cli
