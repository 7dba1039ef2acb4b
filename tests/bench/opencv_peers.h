#pragma once

#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "engine/image/disparity_map.h"
#include "engine/image/image.h"
#include "engine/image/stereo_rig.h"

namespace vs::test {

// OpenCV's StereoSGBM in a mode, with the settings that were found best for these scenes (block 3,
// P1 50, P2 200, x-Sobel capped at 15, uniqueness 5, left-right difference 1, speckles of 100 px).
struct OpenCvPeer {
  std::string_view name;
  int mode;  // cv::StereoSGBM's
};
const std::vector<OpenCvPeer>& OpenCvPeers();

// Disparities over the whole width: OpenCV leaves out the first num_disparities columns, so both
// pictures are widened by as many on the left. The time is the matcher's alone.
struct PeerResult {
  DisparityMap map;
  double ms = 0;
};
PeerResult RunOpenCvPeer(const OpenCvPeer& peer, const GreyImage& left, const GreyImage& right,
                         int num_disparities, BufferPool& pool);

// OpenCV's remap by fixed-point maps, linearly: what takes the distortion out of a picture.
class OpenCvRemap {
 public:
  OpenCvRemap(const CameraModel& camera, int width, int height);
  // For one picture.
  double Milliseconds(const GreyImage& picture) const;

 private:
  cv::Mat pixels_;
  cv::Mat parts_;
};

}  // namespace vs::test
