#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/status.h"
#include "engine/camera/player.h"
#include "engine/camera/stereo_source.h"
#include "engine/image/rectified_geometry.h"

namespace vs {

// Which files of a folder belong together. Each pattern has at most one '*'; what it stands for is
// the same in all files of a pair: "*_left.png" and "*_right.png", "left/*.png" and "right/*.png".
struct FilePairOptions {
  std::filesystem::path folder;
  // Both empty: every picture with "left" in its file name, and the one with "right" there instead.
  std::string left_pattern;
  std::string right_pattern;
  // Optional files of a pair. Disparity of the left view: 16-bit PNG, px = value / 256, 0 =
  // unknown. Visible: 8 bit, 255 where both cameras see the point. Without patterns: the left
  // file's name with "disp" or "nonocc" instead of "left", as .png, where it exists.
  std::string truth_pattern;
  std::string visible_pattern;
  // Set when the pictures are rectified. Pictures of another size than its own get it scaled; with
  // width 0 it holds as it is for every size.
  std::optional<RectifiedGeometry> geometry;
  PlayOptions play;
};

// Plays the pairs of a folder, each exactly once (or over and over), in counting order. A pair with
// an unreadable file, or whose two pictures differ in size, is left out, counted as incomplete on
// the side at fault and named in that side's last error; a whole round of them ends the play. Start
// fails with NOT_FOUND when there is no pair, INVALID_ARGUMENT when none can be read.
std::unique_ptr<StereoSource> MakeFilePairSource(FilePairOptions options);

}  // namespace vs
