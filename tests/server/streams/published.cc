#include "tests/server/streams/published.h"

#include <cstring>
#include <vector>

#include "proto/wire/rvl.h"
#include "proto/wire/zstd.h"

namespace vs::test {

namespace pb = visionserver::v1;

FrameContext Journey(uint64_t number) {
  static const auto run = std::make_shared<const RunInfo>(
      RunInfo{.sequence = "demo", .sequence_revision = 7, .block_ids = {"source", "match"}});
  FrameContext frame;
  frame.run = run;
  frame.number = number;
  frame.source_number = number + 100;
  frame.capture_ns = 1000;
  frame.arrival_ns = 2000;
  frame.popped_ns = 3000;
  frame.block_times.resize(2);
  frame.block_times[0].start_ns = 3100;
  frame.block_times[0].end_ns = 3200;
  frame.block_times[1].start_ns = 3300;
  return frame;
}

DisparityMap MapOf(int width, int height, int seed) {
  static BufferPool pool;
  DisparityMap map;
  map.disparity = Image<uint16_t>(pool, width, height);
  map.confidence = GreyImage(pool, width, height);
  map.reason = GreyImage(pool, width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const bool valid = (x * 7 + y * 3 + seed) % 5 != 0;
      map.disparity.Row(y)[x] =
          valid ? static_cast<uint16_t>(500 + (x + seed) % 40 + y) : kInvalidDisparity;
      map.confidence.Row(y)[x] = static_cast<uint8_t>(valid ? 200 + x % 50 : 0);
      map.reason.Row(y)[x] =
          static_cast<uint8_t>(valid ? InvalidReason::kNone : InvalidReason::kSpeckle);
    }
  }
  map.offset_px = -3;
  map.geometry = {.width = width, .height = height, .focal_px = 600, .baseline_m = 0.1};
  return map;
}

pb::StreamItem Parse(const WireMessage& message) {
  std::string bytes;
  for (const WireSlice& slice : message) {
    bytes.append(static_cast<const char*>(slice.data), slice.size_bytes);
  }
  pb::StreamItem item;
  if (!item.ParseFromString(bytes)) item.set_notice("not a StreamItem");
  return item;
}

std::vector<uint16_t> UnpackDisparity(const pb::StreamItem& item) {
  std::vector<uint16_t> pixels(size_t{item.header().width()} * item.header().height());
  const auto* payload = reinterpret_cast<const uint8_t*>(item.payload().data());
  std::vector<uint8_t> packed(payload, payload + item.payload().size());
  if (item.header().codec() == pb::CODEC_RAW) {
    if (packed.size() != pixels.size() * sizeof(uint16_t)) return {};
    std::memcpy(pixels.data(), packed.data(), packed.size());
    return pixels;
  }
  if (item.header().codec() == pb::CODEC_RVL_ZSTD) {
    std::vector<uint8_t> rvl;
    if (wire::ZstdUnpacker().Unpack(packed, 1 << 24, &rvl) != wire::DecodeError::kNone) return {};
    packed = rvl;
  }
  if (wire::DecodeRvl(packed, pixels) != wire::DecodeError::kNone) return {};
  return pixels;
}

std::vector<uint16_t> PixelsOf(const Image<uint16_t>& image) {
  std::vector<uint16_t> pixels;
  for (int y = 0; y < image.height(); ++y) {
    pixels.insert(pixels.end(), image.Row(y), image.Row(y) + image.width());
  }
  return pixels;
}

}  // namespace vs::test
