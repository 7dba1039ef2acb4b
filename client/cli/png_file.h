#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace vs::cli {

// Writes a grey PNG of 16 bits; pixels row by row. False when the file cannot be written.
bool WritePng16(const std::filesystem::path& path, int width, int height,
                const std::vector<uint16_t>& pixels);

}  // namespace vs::cli
