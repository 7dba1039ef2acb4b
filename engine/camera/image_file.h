#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/frame.h"
#include "engine/image/image.h"

namespace vs {

// Any format that OpenCV reads, converted to 8-bit grey (Y = 0.299 R + 0.587 G + 0.114 B). Pixels
// stay where the file has them: an orientation tag is ignored. NOT_FOUND when there is no such
// file, INVALID_ARGUMENT when it is no picture.
Result<GreyImage> ReadGreyImage(const std::filesystem::path& file);

// True disparity from a 16-bit PNG: px = value / 256, 0 = unknown.
Result<Image<float>> ReadDisparityFile(const std::filesystem::path& file);

// The files below `folder` whose path, relative to it, matches `pattern` (as in a shell: * ? [abc],
// none of them matches '/'), in the order in which people count: 2 before 10. NOT_FOUND when there
// is no such folder, or no such file (with what there is instead).
Result<std::vector<std::filesystem::path>> FindFiles(const std::filesystem::path& folder,
                                                     const std::string& pattern);

}  // namespace vs
