#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "client/depth_frame.h"
#include "client/error.h"

namespace vs::cli {

// Disparity as it stands in the files: value / 256 = pixels, 0 = invalid (as KITTI and Middlebury
// tools read it).
inline constexpr double kFileScale = 256;

struct FileImage {
  std::vector<uint16_t> pixels;
  uint64_t clipped = 0;  // valid disparities that do not fit (below 1/256 px, or 256 px and more)
};

FileImage ToFileImage(const client::DepthFrame& frame);

// Writes `folder`/frame_NNNNNN.png and .json with what belongs to it: geometry, times, drops.
// `latency_ms` is from exposure to this client, negative when unknown.
client::Result<void> WriteDepthFiles(const client::DepthFrame& frame, const std::string& stream,
                                     double latency_ms, int64_t number,
                                     const std::filesystem::path& folder);

}  // namespace vs::cli
