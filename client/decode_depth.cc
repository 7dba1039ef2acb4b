#include "client/decode_depth.h"

#include <bit>
#include <cstring>
#include <span>

#include "proto/wire/rvl.h"

namespace vs::client {

namespace v1 = ::visionserver::v1;

namespace {

constexpr uint32_t kMaxSide = 1 << 14;

std::span<const uint8_t> Bytes(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

tl::unexpected<Error> Unreadable(const std::string& why) {
  return Failure(Code::kDataLoss, "a depth image cannot be unpacked: " + why);
}

std::chrono::system_clock::time_point ToTime(const google::protobuf::Timestamp& time) {
  using std::chrono::duration_cast;
  using Clock = std::chrono::system_clock;
  return Clock::time_point(duration_cast<Clock::duration>(std::chrono::seconds(time.seconds()) +
                                                          std::chrono::nanoseconds(time.nanos())));
}

void CopyHeader(const v1::StreamItem& item, DepthFrame* frame) {
  const v1::FrameHeader& header = item.header();
  frame->width = static_cast<int>(header.width());
  frame->height = static_cast<int>(header.height());
  frame->quantity =
      header.kind() == v1::STREAM_KIND_DISPARITY ? Quantity::kDisparityPx : Quantity::kDepthM;
  frame->scale = header.value_scale();
  frame->offset = header.value_offset();
  const v1::RectifiedGeometry& geometry = header.geometry();
  frame->geometry = {.focal_px = geometry.focal_px(),
                     .baseline_m = geometry.baseline_m(),
                     .cx_px = geometry.cx_px(),
                     .cy_px = geometry.cy_px(),
                     .principal_offset_px = geometry.principal_offset_px()};
  frame->seq = item.seq();
  frame->dropped = item.dropped();
  frame->frame_number = header.frame_number();
  frame->capture_ns = header.capture_ns();
  frame->capture_time = ToTime(header.capture_time());
  for (const v1::StageTiming& stage : header.timing()) {
    frame->stages.push_back(
        {.name = stage.stage(), .start_ns = stage.start_ns(), .end_ns = stage.end_ns()});
  }
  frame->sequence_revision = header.sequence_revision();
  frame->received_bytes = item.ByteSizeLong();
}

}  // namespace

template <class T>
Result<void> DepthDecoder::Unpack(const std::string& packed, v1::Codec codec,
                                  std::vector<T>* pixels) {
  if (codec == v1::CODEC_RAW) {
    if (packed.size() != pixels->size() * sizeof(T)) {
      return Unreadable("raw pixels take " + std::to_string(pixels->size() * sizeof(T)) +
                        " bytes, these are " + std::to_string(packed.size()));
    }
    std::memcpy(pixels->data(), packed.data(), packed.size());
    if constexpr (sizeof(T) == 2 && std::endian::native == std::endian::big) {
      for (T& pixel : *pixels) pixel = static_cast<T>(pixel << 8 | pixel >> 8);
    }
    return {};
  }
  std::span<const uint8_t> rvl = Bytes(packed);
  wire::DecodeError error = wire::DecodeError::kNone;
  if (codec == v1::CODEC_RVL_ZSTD) {
    error = zstd_.Unpack(rvl, wire::RvlBound(pixels->size()), &rvl_);
    rvl = rvl_;
  }
  if (error == wire::DecodeError::kNone) error = wire::DecodeRvl(rvl, *pixels);
  if (error != wire::DecodeError::kNone) {
    return Unreadable(std::string(wire::DecodeErrorText(error)));
  }
  return {};
}

Result<DepthFrame> DepthDecoder::Decode(const v1::StreamItem& item) {
  const v1::FrameHeader& header = item.header();
  const bool raw_depth = header.kind() == v1::STREAM_KIND_DEPTH && header.codec() == v1::CODEC_RAW;
  if ((header.kind() != v1::STREAM_KIND_DISPARITY && header.kind() != v1::STREAM_KIND_DEPTH) ||
      raw_depth) {
    return Failure(Code::kFailedPrecondition,
                   "the stream holds " + v1::StreamKind_Name(header.kind()) + " as " +
                       v1::Codec_Name(header.codec()) +
                       "; a depth stream is disparity, or depth packed as CODEC_RVL",
                   "NOT_DEPTH");
  }
  if (header.width() == 0 || header.height() == 0 || header.width() > kMaxSide ||
      header.height() > kMaxSide) {
    return Unreadable("its size is said to be " + std::to_string(header.width()) + " x " +
                      std::to_string(header.height()));
  }
  DepthFrame frame;
  CopyHeader(item, &frame);
  const size_t pixels = static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height);
  const auto unpack = [&](const std::string& packed, auto* plane) {
    plane->resize(pixels);
    return Unpack(packed, header.codec(), plane);
  };
  Result<void> done = unpack(item.payload(), &frame.values);
  if (done && !item.confidence().empty()) done = unpack(item.confidence(), &frame.confidence);
  if (done && !item.reasons().empty()) done = unpack(item.reasons(), &frame.reason);
  if (!done) return tl::unexpected(done.error());
  return frame;
}

}  // namespace vs::client
