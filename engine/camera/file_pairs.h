#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/status.h"
#include "engine/camera/file_pair_source.h"

namespace vs {

// The files of one pair. Truth and visible are empty when there are none.
struct FilePair {
  std::filesystem::path left;
  std::filesystem::path right;
  std::filesystem::path truth;
  std::filesystem::path visible;
};

// The pairs that the options describe, in counting order. Errors: INVALID_ARGUMENT (a pattern makes
// no sense or leads out of the folder), NOT_FOUND (no folder, no pair; says what is missing).
Result<std::vector<FilePair>> FindFilePairs(const FilePairOptions& options);

}  // namespace vs
