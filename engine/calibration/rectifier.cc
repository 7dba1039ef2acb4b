#include "engine/calibration/rectifier.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include <opencv2/calib3d.hpp>

#include "engine/base/recycler.h"
#include "engine/base/str.h"
#include "engine/calibration/validate_rig.h"

namespace vs {
namespace {

constexpr int kMaxBinning = 16;
constexpr int kLeastSize = 16;

// Whether binning makes `size` of `calibrated` pixels in one direction. What does not fill a binned
// pixel is cut off at the far end, so the first pixels stay where they are.
bool IsBinned(int size, int calibrated, int binning) {
  const int whole = calibrated / binning;
  return size == whole || size == whole - whole % 2;
}

// Size of the pictures over the calibrated one, the same in both directions; nullopt when no such
// scale makes one of the other. Not the ratio of the sizes, which binning rounds.
std::optional<double> ScaleOf(const CameraModel& camera, int width, int height) {
  if (int64_t{width} * camera.height == int64_t{height} * camera.width) {
    return static_cast<double>(width) / camera.width;
  }
  for (int binning = 2; binning <= kMaxBinning; ++binning) {
    if (IsBinned(width, camera.width, binning) && IsBinned(height, camera.height, binning)) {
      return 1.0 / binning;
    }
  }
  return std::nullopt;
}

// The camera matrix for pictures of another scale. Pixel centres are integers, hence the half
// pixels.
cv::Matx33d CameraMatrix(const CameraModel& camera, double scale) {
  return {camera.fx_px * scale,
          0,
          (camera.cx_px + 0.5) * scale - 0.5,
          0,
          camera.fy_px * scale,
          (camera.cy_px + 0.5) * scale - 0.5,
          0,
          0,
          1};
}

cv::Vec<double, 5> Distortion(const CameraModel& camera) {
  return {camera.k1, camera.k2, camera.p1, camera.p2, camera.k3};
}

RemapTable MakeTable(const cv::Matx33d& camera, const CameraModel& model,
                     const cv::Matx33d& rotation, const cv::Matx34d& projection, cv::Size size,
                     bool exact) {
  // For whole numbers: pixels, and parts in 1/32 px as 32 * y + x. Else: x, and y.
  cv::Mat first;
  cv::Mat second;
  cv::initUndistortRectifyMap(camera, Distortion(model), rotation, projection, size,
                              exact ? CV_32FC1 : CV_16SC2, first, second);
  RemapTable table{.width = size.width, .height = size.height};
  if (exact) {
    table.positions.reserve(static_cast<size_t>(size.area()));
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        table.positions.push_back({first.at<float>(y, x), second.at<float>(y, x)});
      }
    }
    return table;
  }
  table.sources.reserve(static_cast<size_t>(size.area()));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto pixel = first.at<cv::Vec2s>(y, x);
      const auto part = second.at<uint16_t>(y, x);
      table.sources.push_back({.x = pixel[0],
                               .y = pixel[1],
                               .x_part = static_cast<uint8_t>(part % 32),
                               .y_part = static_cast<uint8_t>(part / 32)});
    }
  }
  return table;
}

Result<double> CheckedScale(const StereoRig& rig, int width, int height) {
  const CameraModel& camera = rig.left;
  if (rig.right.width != camera.width || rig.right.height != camera.height) {
    return InvalidArgument(Str("stereo rig \"", rig.name, "\": the left camera has ", camera.width,
                               " x ", camera.height, " px, the right one ", rig.right.width, " x ",
                               rig.right.height, " px; only equal cameras can be rectified"));
  }
  const bool served =
      width >= kLeastSize && height >= kLeastSize && width <= 16384 && height <= 16384;
  if (const auto scale = ScaleOf(camera, width, height); served && scale) return *scale;
  return InvalidArgument(
      Str("stereo rig \"", rig.name, "\" is calibrated for ", camera.width, " x ", camera.height,
          " px, the pictures have ", width, " x ", height,
          " px; use the full picture, binned alike in both directions if needed, "
          "resize pictures after rectification only, or calibrate again"));
}

}  // namespace

struct Rectifier::Maps {
  Rectification rectification;
  std::array<double, 9> rectified_from_left_rotation{};
  Recycler<Frame> frames;
};

Rectifier::Rectifier(std::shared_ptr<const Maps> maps) : maps_(std::move(maps)) {}

Result<Rectifier> Rectifier::Make(const StereoRig& rig, int width, int height,
                                  const RectifyOptions& options) {
  VS_RETURN_IF_ERROR(ValidateRig(rig));
  VS_ASSIGN_OR_RETURN(const double full_scale, CheckedScale(rig, width, height));
  if (!(options.alpha >= 0 && options.alpha <= 1)) {
    return InvalidArgument(Str("rectification: alpha is ", options.alpha, "; it must be 0 .. 1"));
  }
  const double scale = options.half_size ? full_scale / 2 : full_scale;
  const cv::Size size =
      options.half_size ? cv::Size(width / 2, height / 2) : cv::Size(width, height);
  if (size.width < kLeastSize || size.height < kLeastSize) {
    return InvalidArgument(Str("rectification: pictures of ", width, " x ", height,
                               " px are too small to be halved; choose full resolution"));
  }
  const cv::Matx33d left_camera = CameraMatrix(rig.left, scale);
  const cv::Matx33d right_camera = CameraMatrix(rig.right, scale);
  const cv::Matx33d rotation(rig.right_from_left_rotation.data());
  const cv::Vec3d translation(rig.right_from_left_translation_m.data());
  auto maps = std::make_shared<Maps>();
  Rectification& made = maps->rectification;
  made.raw_width = width;
  made.raw_height = height;
  made.half_size = options.half_size;
  made.interpolation = options.interpolation;
  try {
    cv::Matx33d left_rotation;
    cv::Matx33d right_rotation;
    cv::Matx34d left_projection;
    cv::Matx34d right_projection;
    cv::Matx44d unused;
    cv::stereoRectify(left_camera, Distortion(rig.left), right_camera, Distortion(rig.right), size,
                      rotation, translation, left_rotation, right_rotation, left_projection,
                      right_projection, unused, cv::CALIB_ZERO_DISPARITY, options.alpha, size);
    made.left =
        MakeTable(left_camera, rig.left, left_rotation, left_projection, size, options.exact_maps);
    made.right = MakeTable(right_camera, rig.right, right_rotation, right_projection, size,
                           options.exact_maps);
    std::copy_n(left_rotation.val, 9, maps->rectified_from_left_rotation.begin());
    const double focal = left_projection(0, 0);
    made.geometry = {.width = size.width,
                     .height = size.height,
                     .focal_px = focal,
                     .baseline_m = -right_projection(0, 3) / focal,
                     .cx_px = left_projection(0, 2),
                     .cy_px = left_projection(1, 2),
                     .principal_offset_px = right_projection(0, 2) - left_projection(0, 2)};
  } catch (const cv::Exception& error) {
    return InvalidArgument(
        Str("stereo rig \"", rig.name, "\" cannot be rectified: ", error.what()));
  }
  const RectifiedGeometry& g = made.geometry;
  if (!(std::isfinite(g.focal_px) && g.focal_px > 0 && g.baseline_m > 0)) {
    return InvalidArgument(Str("stereo rig \"", rig.name,
                               "\" cannot be rectified: its distortion leaves no common view"));
  }
  return Rectifier(std::move(maps));
}

Result<StereoFrame> Rectifier::Rectify(const StereoFrame& raw, BufferPool& pool) const {
  const Rectification& how = maps_->rectification;
  const auto rectify = [&](const FramePtr& frame, const RemapTable& table) -> Result<FramePtr> {
    if (frame == nullptr) return InvalidArgument("rectification: a picture of the pair is missing");
    const GreyImage& image = frame->image;
    if (!Fits(image.width(), image.height())) {
      return InvalidArgument(Str("rectification: camera ", frame->camera, " gave ", image.width(),
                                 " x ", image.height(), " px, expected ", how.raw_width, " x ",
                                 how.raw_height, " px; set both cameras to the same size"));
    }
    Frame rectified = *frame;
    rectified.image = Rectified(image, how, table, pool);
    return FramePtr(std::allocate_shared<Frame>(maps_->frames, std::move(rectified)));
  };
  StereoFrame pair = raw;
  VS_ASSIGN_OR_RETURN(pair.left, rectify(raw.left, how.left));
  VS_ASSIGN_OR_RETURN(pair.right, rectify(raw.right, how.right));
  pair.geometry = how.geometry;
  pair.truth = nullptr;
  return pair;
}

std::shared_ptr<const Rectification> Rectifier::rectification() const {
  return {maps_, &maps_->rectification};
}

bool Rectifier::Fits(int width, int height) const {
  const Rectification& how = maps_->rectification;
  return width == how.raw_width && height == how.raw_height;
}

const RectifiedGeometry& Rectifier::geometry() const { return maps_->rectification.geometry; }

const std::array<double, 9>& Rectifier::rectified_from_left_rotation() const {
  return maps_->rectified_from_left_rotation;
}

}  // namespace vs
