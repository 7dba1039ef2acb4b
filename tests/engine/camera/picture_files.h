#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace vs::test {

// A grey picture of one value, as a PGM file. Readers go by the content, so any name will do.
inline void WriteGrey(const std::filesystem::path& file, uint8_t value, int width = 8,
                      int height = 6) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary)
      << "P5\n"
      << width << " " << height << "\n255\n"
      << std::string(static_cast<size_t>(width) * height, static_cast<char>(value));
}

// The same with 16 bits a pixel.
inline void WriteGrey16(const std::filesystem::path& file, uint16_t value, int width = 8,
                        int height = 6) {
  std::string pixels;
  for (int i = 0; i < width * height; ++i) {
    pixels += static_cast<char>(value >> 8);
    pixels += static_cast<char>(value & 255);
  }
  std::ofstream(file, std::ios::binary) << "P5\n"
                                        << width << " " << height << "\n65535\n"
                                        << pixels;
}

inline void WriteText(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << text;
}

}  // namespace vs::test
