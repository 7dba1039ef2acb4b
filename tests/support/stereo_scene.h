#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/buffer.h"
#include "engine/image/frame.h"
#include "engine/image/image.h"

namespace vs {

// A real, rectified pair of pictures with ground truth.
struct StereoScene {
  std::string name;
  GreyImage left;
  GreyImage right;
  StereoTruth truth;
  int num_disparities = 0;  // the range to search, from 0
};

// Reads a folder with left.png, right.png, disp.png (16 bit, disparity in px = value / 256, 0 =
// unknown), nonocc.png (255 = visible in both) and meta.json (name, num_disparities).
Result<StereoScene> LoadStereoScene(const std::filesystem::path& folder, BufferPool& pool);

// The folders in `folder` that hold a scene, by name.
std::vector<std::filesystem::path> StereoSceneFoldersIn(const std::filesystem::path& folder);

// The scene folders below $VS_TEST_DATA/stereo, by name; empty when the variable is not set.
std::vector<std::filesystem::path> StereoSceneFolders();

// Debian's opencv-doc aloe pair at half size (its truth in whole pixels of the full size).
// NOT_FOUND when the package is not installed.
Result<StereoScene> LoadAloe(BufferPool& pool);

// Writes it as a scene that LoadStereoScene reads.
Status WriteStereoScene(const StereoScene& scene, const std::filesystem::path& folder);

}  // namespace vs
