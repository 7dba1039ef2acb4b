#include "client/depth_frame.h"

#include <gtest/gtest.h>

#include "client/decode_depth.h"
#include "proto/wire/rvl.h"

namespace vs::client {
namespace {

namespace v1 = ::visionserver::v1;

// Focal length 800 px, baseline 0.1 m: 64 px are 1.25 m.
DepthFrame TwoByTwo() {
  DepthFrame frame;
  frame.width = 2;
  frame.height = 2;
  frame.values = {0, 1024, 512, 2048};
  frame.scale = 1.0 / 16;
  frame.geometry = {.focal_px = 800, .baseline_m = 0.1, .cx_px = 0.5, .cy_px = 0.5};
  return frame;
}

TEST(DepthFrame, TurnsDisparityIntoMetres) {
  const DepthFrame frame = TwoByTwo();
  EXPECT_EQ(64, *frame.DisparityAt(1, 0));
  EXPECT_EQ(1.25, *frame.DepthAt(1, 0));
  EXPECT_EQ(2.5, *frame.DepthAt(0, 1));
  const std::optional<Point> point = frame.PointAt(1, 0);
  EXPECT_DOUBLE_EQ(0.5 * 1.25 / 800, point->x_m);
  EXPECT_DOUBLE_EQ(-0.5 * 1.25 / 800, point->y_m);
  EXPECT_DOUBLE_EQ(1.25, point->z_m);
}

TEST(DepthFrame, KnowsNothingOfInvalidPixelsAndBeyondTheImage) {
  const DepthFrame frame = TwoByTwo();
  EXPECT_FALSE(frame.DepthAt(0, 0));
  EXPECT_FALSE(frame.PointAt(0, 0));
  EXPECT_FALSE(frame.DepthAt(-1, 0));
  EXPECT_FALSE(frame.DepthAt(2, 0));
  EXPECT_FALSE(frame.DepthAt(0, 2));
  EXPECT_DOUBLE_EQ(0.75, frame.ValidShare());
}

TEST(DepthFrame, KnowsNoDepthWithoutGeometryOrAtInfinity) {
  DepthFrame frame = TwoByTwo();
  frame.offset = -64;  // pixel (1, 0) is at infinity now
  EXPECT_EQ(0, *frame.DisparityAt(1, 0));
  EXPECT_FALSE(frame.DepthAt(1, 0));
  frame.offset = 0;
  frame.geometry.focal_px = 0;
  EXPECT_FALSE(frame.DepthAt(1, 0));
  EXPECT_TRUE(frame.DisparityAt(1, 0));
}

TEST(DepthFrame, HeedsThePrincipalOffset) {
  DepthFrame frame = TwoByTwo();
  frame.geometry.principal_offset_px = 16;
  EXPECT_EQ(1.0, *frame.DepthAt(1, 0));  // 80 / (64 + 16)
  frame.quantity = Quantity::kDepthM;
  frame.scale = 1.0 / 1024;
  EXPECT_EQ(1.0, *frame.DepthAt(1, 0));
  EXPECT_EQ(64, *frame.DisparityAt(1, 0));
}

TEST(DepthFrame, FindsTheMiddleDepthOfARegion) {
  const DepthFrame frame = TwoByTwo();
  EXPECT_EQ(1.25, *frame.MedianDepth({.x = -5, .y = -5, .width = 20, .height = 20}));
  EXPECT_EQ(2.5, *frame.MedianDepth({.x = 0, .y = 0, .width = 1, .height = 2}));
  EXPECT_FALSE(frame.MedianDepth({.x = 0, .y = 0, .width = 1, .height = 1}));
  EXPECT_FALSE(frame.MedianDepth({.x = 7, .y = 7, .width = 1, .height = 1}));
}

v1::StreamItem RvlItem(const std::vector<uint16_t>& pixels, uint32_t width, uint32_t height) {
  v1::StreamItem item;
  v1::FrameHeader& header = *item.mutable_header();
  header.set_kind(v1::STREAM_KIND_DISPARITY);
  header.set_codec(v1::CODEC_RVL);
  header.set_width(width);
  header.set_height(height);
  header.set_value_scale(1.0 / 16);
  std::string& payload = *item.mutable_payload();
  payload.resize(wire::RvlBound(pixels.size()));
  payload.resize(wire::EncodeRvl(pixels.data(), width, height, width * sizeof(uint16_t),
                                 {reinterpret_cast<uint8_t*>(payload.data()), payload.size()}));
  return item;
}

TEST(DepthDecoder, UnpacksEveryCodec) {
  const std::vector<uint16_t> pixels = {0, 0, 700, 701, 0, 65535};
  v1::StreamItem item = RvlItem(pixels, 3, 2);
  item.set_seq(41);
  item.set_dropped(3);
  item.mutable_header()->set_frame_number(99);
  item.mutable_header()->mutable_capture_time()->set_seconds(1'700'000'000);
  item.mutable_header()->mutable_geometry()->set_focal_px(800);
  DepthDecoder decoder;
  const Result<DepthFrame> rvl = decoder.Decode(item);
  ASSERT_TRUE(rvl) << rvl.error().ToString();
  EXPECT_EQ(pixels, rvl->values);
  EXPECT_EQ(3, rvl->width);
  EXPECT_EQ(2, rvl->height);
  EXPECT_EQ(41U, rvl->seq);
  EXPECT_EQ(3U, rvl->dropped);
  EXPECT_EQ(99U, rvl->frame_number);
  EXPECT_EQ(800, rvl->geometry.focal_px);
  EXPECT_EQ(1'700'000'000, std::chrono::system_clock::to_time_t(rvl->capture_time));

  const std::string packed = item.payload();
  std::vector<uint8_t> zstd(wire::ZstdPacker::Bound(packed.size()));
  const size_t size = wire::ZstdPacker().Pack(
      {reinterpret_cast<const uint8_t*>(packed.data()), packed.size()}, zstd);
  item.mutable_header()->set_codec(v1::CODEC_RVL_ZSTD);
  item.set_payload(zstd.data(), size);
  EXPECT_EQ(pixels, decoder.Decode(item)->values);

  item.mutable_header()->set_codec(v1::CODEC_RAW);
  item.set_payload(std::string("\0\0\0\0\xBC\x02\xBD\x02\0\0\xFF\xFF", 12));
  EXPECT_EQ(pixels, decoder.Decode(item)->values);
}

TEST(DepthDecoder, UnpacksConfidenceAndReasons) {
  v1::StreamItem item = RvlItem({0, 800}, 2, 1);
  item.mutable_header()->set_codec(v1::CODEC_RAW);
  item.set_payload(std::string("\0\0\x20\x03", 4));
  item.set_confidence(std::string("\0\xC8", 2));
  item.set_reasons(std::string("\x01\0", 2));
  const Result<DepthFrame> frame = DepthDecoder().Decode(item);
  ASSERT_TRUE(frame) << frame.error().ToString();
  EXPECT_EQ((std::vector<uint8_t>{0, 200}), frame->confidence);
  EXPECT_EQ((std::vector<uint8_t>{v1::INVALID_REASON_OCCLUDED, 0}), frame->reason);
}

TEST(DepthDecoder, RefusesPayloadsThatDoNotFitTheirHeader) {
  DepthDecoder decoder;
  v1::StreamItem item = RvlItem({5, 6, 7, 8}, 2, 2);
  item.mutable_header()->set_width(3);
  EXPECT_EQ(Code::kDataLoss, decoder.Decode(item).error().code);
  item.mutable_header()->set_width(0);
  EXPECT_EQ(Code::kDataLoss, decoder.Decode(item).error().code);
  item.mutable_header()->set_width(0xFFFFFFFF);
  EXPECT_EQ(Code::kDataLoss, decoder.Decode(item).error().code);
  item.mutable_header()->set_width(2);
  for (const v1::Codec codec : {v1::CODEC_RAW, v1::CODEC_RVL_ZSTD}) {
    item.mutable_header()->set_codec(codec);
    EXPECT_EQ(Code::kDataLoss, decoder.Decode(item).error().code);
  }
  item.mutable_header()->set_codec(v1::CODEC_RVL);
  EXPECT_TRUE(decoder.Decode(item));
  item.set_reasons("abc");
  EXPECT_EQ(Code::kDataLoss, decoder.Decode(item).error().code);
}

TEST(DepthDecoder, RefusesWhatIsNoDepth) {
  v1::StreamItem item = RvlItem({5, 6}, 2, 1);
  for (const v1::StreamKind kind :
       {v1::STREAM_KIND_GREY_PICTURE, v1::STREAM_KIND_VALUE, v1::STREAM_KIND_UNSPECIFIED}) {
    item.mutable_header()->set_kind(kind);
    const Result<DepthFrame> frame = DepthDecoder().Decode(item);
    ASSERT_FALSE(frame);
    EXPECT_EQ("NOT_DEPTH", frame.error().reason);
  }
}

}  // namespace
}  // namespace vs::client
