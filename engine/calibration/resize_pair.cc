#include "engine/calibration/resize_pair.h"

#include <cmath>
#include <memory>
#include <utility>

#include "engine/base/str.h"
#include "engine/image/resample.h"

namespace vs {
namespace {

Result<FramePtr> ResizeFrame(const FramePtr& frame, double scale, const Recycler<Frame>& frames,
                             BufferPool& pool) {
  if (frame == nullptr) return InvalidArgument("resize: a picture of the pair is missing");
  const GreyImage& image = frame->image;
  const auto width = static_cast<int>(std::lround(image.width() * scale));
  const auto height = static_cast<int>(std::lround(image.height() * scale));
  if (width < 16 || height < 16 || width > 16384 || height > 16384) {
    return InvalidArgument(Str("resize: ", image.width(), " x ", image.height(), " px times ",
                               scale, " is ", width, " x ", height,
                               " px; the result must be 16 x 16 to 16384 x 16384 px"));
  }
  auto resized = std::allocate_shared<Frame>(frames, *frame);
  resized->image = Resample(image, width, height, pool);
  return FramePtr(std::move(resized));
}

}  // namespace

Result<StereoFrame> ResizePair(const StereoFrame& pair, double scale, const Recycler<Frame>& frames,
                               BufferPool& pool) {
  if (!(scale >= 0.05 && scale <= 4)) {
    return InvalidArgument(Str("resize: the scale is ", scale, "; it must be 0.05 .. 4"));
  }
  StereoFrame resized = pair;
  VS_ASSIGN_OR_RETURN(resized.left, ResizeFrame(pair.left, scale, frames, pool));
  VS_ASSIGN_OR_RETURN(resized.right, ResizeFrame(pair.right, scale, frames, pool));
  if (pair.geometry) {
    resized.geometry =
        Scaled(*pair.geometry, resized.left->image.width(), resized.left->image.height());
  }
  resized.truth = nullptr;
  return resized;
}

}  // namespace vs
