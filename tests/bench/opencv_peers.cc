#include "tests/bench/opencv_peers.h"

#include <chrono>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "engine/image/opencv_view.h"

namespace vs::test {

const std::vector<OpenCvPeer>& OpenCvPeers() {
  static const std::vector<OpenCvPeer> peers = {{"opencv_3way", cv::StereoSGBM::MODE_SGBM_3WAY},
                                                {"opencv_hh", cv::StereoSGBM::MODE_HH},
                                                {"opencv_hh4", cv::StereoSGBM::MODE_HH4},
                                                {"opencv_sgbm", cv::StereoSGBM::MODE_SGBM}};
  return peers;
}

PeerResult RunOpenCvPeer(const OpenCvPeer& peer, const GreyImage& left, const GreyImage& right,
                         int num_disparities, BufferPool& pool) {
  const int range = (num_disparities + 15) / 16 * 16;
  cv::Mat wide_left;
  cv::Mat wide_right;
  cv::copyMakeBorder(CvView(left), wide_left, 0, 0, range, 0, cv::BORDER_REPLICATE);
  cv::copyMakeBorder(CvView(right), wide_right, 0, 0, range, 0, cv::BORDER_REPLICATE);
  const auto matcher = cv::StereoSGBM::create(0, range, 3, 50, 200, 1, 15, 5, 100, 2, peer.mode);
  cv::Mat found;
  const auto begin = std::chrono::steady_clock::now();
  matcher->compute(wide_left, wide_right, found);
  const auto end = std::chrono::steady_clock::now();

  PeerResult result;
  result.ms = std::chrono::duration<double, std::milli>(end - begin).count();
  result.map.disparity = Image<uint16_t>(pool, left.width(), left.height());
  for (int y = 0; y < left.height(); ++y) {
    const auto* row = found.ptr<int16_t>(y) + range;  // sixteenths of a pixel, negative if invalid
    for (int x = 0; x < left.width(); ++x) {
      result.map.disparity.Row(y)[x] =
          row[x] > 0 ? static_cast<uint16_t>(row[x]) : kInvalidDisparity;
    }
  }
  return result;
}

OpenCvRemap::OpenCvRemap(const CameraModel& camera, int width, int height) {
  const double scale = static_cast<double>(width) / camera.width;
  const cv::Matx33d matrix(camera.fx_px * scale, 0, camera.cx_px * scale, 0, camera.fy_px * scale,
                           camera.cy_px * scale, 0, 0, 1);
  cv::initUndistortRectifyMap(
      matrix, cv::Vec<double, 5>(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3),
      cv::Matx33d::eye(), matrix, {width, height}, CV_16SC2, pixels_, parts_);
}

double OpenCvRemap::Milliseconds(const GreyImage& picture) const {
  cv::Mat out;
  const cv::Mat in = CvView(picture);
  const auto begin = std::chrono::steady_clock::now();
  cv::remap(in, out, pixels_, parts_, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

}  // namespace vs::test
