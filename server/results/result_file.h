#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "engine/base/status.h"

namespace vs {

// A picture or point cloud that a result names.
struct ResultFile {
  std::string name;        // without its folder
  std::string media_type;  // "image/png" or "model/ply"
  std::string data;
};

inline constexpr size_t kMaxResultFileBytes = size_t{32} << 20;

// Reads the file that `path`, the text of a result's field, means: relative to `data_dir`, as
// SaveImages writes it. Results are made by whoever builds sequences, so nothing is given away but
// regular files that really are PNG or PLY by their names and, links followed, below `data_dir`.
// INVALID_ARGUMENT when it is not such a file, NOT_FOUND when it is not there (any more),
// RESOURCE_EXHAUSTED beyond kMaxResultFileBytes. Waits for the disk.
Result<ResultFile> ReadResultFile(const std::filesystem::path& data_dir, const std::string& path);

}  // namespace vs
