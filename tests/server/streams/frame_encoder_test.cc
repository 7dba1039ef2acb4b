#include "server/streams/frame_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "proto/wire/rvl.h"
#include "tests/server/streams/published.h"
#include "tests/support/fake_clock.h"

namespace vs {
namespace {

namespace pb = visionserver::v1;
using test::PixelsOf;
using test::UnpackDisparity;
using ::testing::HasSubstr;

class FrameEncoderTest : public ::testing::Test {
 protected:
  template <class T>
  static Value Shared(T value) {
    return Value(std::make_shared<const T>(std::move(value)));
  }

  std::shared_ptr<const Sample> Publish(Value value) {
    Topic topic("demo/out", "any");
    topic.Publish(std::move(value), test::Journey(12), 4000);
    return topic.Latest();
  }

  pb::StreamItem EncodeAs(const Encoding& encoding, Value value) {
    const auto encoded = encoder_.Encode(Publish(std::move(value)), 5, encoding);
    EXPECT_TRUE(encoded->status.ok()) << encoded->status.ToString();
    EXPECT_EQ(5u, encoded->seq);
    return test::Parse(encoded->message);
  }

  BufferPool pool_;
  test::FakeClock clock_;
  FrameEncoder encoder_{clock_};
};

TEST_F(FrameEncoderTest, ADisparityMapArrivesBitForBitInEveryCodec) {
  const DisparityMap map = test::MapOf(61, 17, 3);
  for (const pb::Codec codec : CodecsOf(pb::STREAM_KIND_DISPARITY)) {
    const pb::StreamItem item = EncodeAs({.codec = codec}, Shared(map));
    EXPECT_EQ(codec, item.header().codec());
    EXPECT_EQ(pb::STREAM_KIND_DISPARITY, item.header().kind());
    EXPECT_EQ(61u, item.header().width());
    EXPECT_EQ(17u, item.header().height());
    EXPECT_EQ(61u * 17 * 2, item.header().raw_bytes());
    EXPECT_EQ(1.0 / 16, item.header().value_scale());
    EXPECT_EQ(-3, item.header().value_offset());
    EXPECT_EQ(600, item.header().geometry().focal_px());
    EXPECT_EQ(PixelsOf(map.disparity), UnpackDisparity(item)) << pb::Codec_Name(codec);
    EXPECT_TRUE(item.confidence().empty());
    EXPECT_TRUE(item.reasons().empty());
  }
}

TEST_F(FrameEncoderTest, ConfidenceAndReasonsComeWhenAskedFor) {
  const DisparityMap map = test::MapOf(20, 10, 1);
  const pb::StreamItem raw =
      EncodeAs({.codec = pb::CODEC_RAW, .confidence = true, .reasons = true}, Shared(map));
  ASSERT_EQ(200u, raw.confidence().size());
  ASSERT_EQ(200u, raw.reasons().size());
  EXPECT_EQ(0, std::memcmp(raw.confidence().data(), map.confidence.Row(0), 200));
  EXPECT_EQ(0, std::memcmp(raw.reasons().data(), map.reason.Row(0), 200));

  const pb::StreamItem rvl = EncodeAs({.codec = pb::CODEC_RVL, .reasons = true}, Shared(map));
  EXPECT_TRUE(rvl.confidence().empty());
  std::vector<uint16_t> reasons(200);
  const auto* packed = reinterpret_cast<const uint8_t*>(rvl.reasons().data());
  ASSERT_EQ(wire::DecodeError::kNone, wire::DecodeRvl({packed, rvl.reasons().size()}, reasons));
  for (int i = 0; i < 200; ++i) EXPECT_EQ(map.reason.Row(0)[i], reasons[i]);
}

TEST_F(FrameEncoderTest, RawPixelsAreSharedNotCopied) {
  const auto map = std::make_shared<const DisparityMap>(test::MapOf(64, 8, 0));
  const auto encoded = encoder_.Encode(Publish(Value(map)), 1, {.codec = pb::CODEC_RAW});
  EXPECT_EQ(map->disparity.Row(0), encoded->message.back().data);
  EXPECT_EQ(64u * 8 * 2, encoded->message.back().size_bytes);
}

TEST_F(FrameEncoderTest, PixelsInACamerasMemoryAreCopiedAndGapsBetweenRowsLeftOut) {
  Buffer buffer = pool_.Acquire(64);
  for (int i = 0; i < 64; ++i) buffer.data[i] = static_cast<std::byte>(i);
  GreyImage gaps(buffer, 3, 2, 8);
  EXPECT_EQ(std::string("\0\1\2\10\11\12", 6),
            EncodeAs({.codec = pb::CODEC_RAW}, Shared(gaps)).payload());
  buffer.place = Place::kForeign;
  const GreyImage foreign(buffer, 8, 2, 8);
  const auto encoded = encoder_.Encode(Publish(Shared(foreign)), 1, {.codec = pb::CODEC_RAW});
  EXPECT_NE(static_cast<const void*>(foreign.Row(0)), encoded->message.back().data);
  EXPECT_EQ(16u, test::Parse(encoded->message).payload().size());
}

TEST_F(FrameEncoderTest, DepthIsExactWhenRawAndWithinHalfAStepOtherwise) {
  DepthMap map;
  map.depth_m = Image<float>(pool_, 4, 2);
  const float depth[] = {0.5F, 1.23456F, 3.999F, std::numeric_limits<float>::quiet_NaN(),
                         6.5F, -1,       0,      std::numeric_limits<float>::infinity()};
  std::memcpy(map.depth_m.Row(0), depth, sizeof depth);

  const pb::StreamItem raw = EncodeAs({.codec = pb::CODEC_RAW}, Shared(map));
  ASSERT_EQ(sizeof depth, raw.payload().size());
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(depth), sizeof depth), raw.payload());

  const pb::StreamItem rvl = EncodeAs({.codec = pb::CODEC_RVL}, Shared(map));
  EXPECT_DOUBLE_EQ(1e-4, rvl.header().value_scale());
  const std::vector<uint16_t> steps = UnpackDisparity(rvl);
  ASSERT_EQ(8u, steps.size());
  for (int i = 0; i < 8; ++i) {
    if (i == 3 || i >= 5) {
      EXPECT_EQ(0, steps[i]) << i;
    } else {
      EXPECT_NEAR(depth[i], steps[i] * 1e-4, 0.51e-4) << i;
    }
  }
}

TEST_F(FrameEncoderTest, FartherDepthTakesLargerSteps) {
  DepthMap map;
  map.depth_m = Image<float>(pool_, 2, 1);
  map.depth_m.Row(0)[0] = 1e-6F;  // known, however near
  const struct {
    float farthest_m;
    double step_m;
  } cases[] = {{6.553F, 1e-4}, {6.6F, 2e-4}, {20, 5e-4}, {60, 1e-3}, {100, 2e-3}, {9e5F, 20}};
  for (const auto& one : cases) {
    map.depth_m.Row(0)[1] = one.farthest_m;
    const pb::StreamItem item = EncodeAs({.codec = pb::CODEC_RVL_ZSTD}, Shared(map));
    EXPECT_NEAR(one.step_m, item.header().value_scale(), one.step_m * 1e-9) << one.farthest_m;
    EXPECT_EQ(1, UnpackDisparity(item).at(0));
    EXPECT_NEAR(one.farthest_m, UnpackDisparity(item).at(1) * one.step_m, one.step_m * 0.51);
  }
}

TEST_F(FrameEncoderTest, PicturesTravelAsJpegOrRaw) {
  ColorImage image(pool_, 32, 16);
  image.Fill({200, 40, 90});
  const pb::StreamItem raw = EncodeAs({.codec = pb::CODEC_RAW}, Shared(image));
  EXPECT_EQ(pb::STREAM_KIND_COLOUR_PICTURE, raw.header().kind());
  EXPECT_EQ(32u * 16 * 3, raw.payload().size());
  EXPECT_EQ("\xc8\x28\x5a", raw.payload().substr(0, 3));

  const pb::StreamItem jpeg =
      EncodeAs({.codec = pb::CODEC_JPEG, .jpeg_quality = 90}, Shared(image));
  tjhandle reader = tjInitDecompress();
  std::vector<unsigned char> pixels(size_t{32} * 16 * 3);
  ASSERT_EQ(0, tjDecompress2(reader, reinterpret_cast<const unsigned char*>(jpeg.payload().data()),
                             jpeg.payload().size(), pixels.data(), 32, 0, 16, TJPF_RGB, 0));
  tjDestroy(reader);
  EXPECT_NEAR(200, pixels[0], 4);
  EXPECT_NEAR(40, pixels[1], 4);
  EXPECT_NEAR(90, pixels[2], 4);
}

TEST_F(FrameEncoderTest, AReducedMapHasEveryNthPixelWithItsPlanes) {
  const DisparityMap map = test::MapOf(61, 17, 3);
  for (const pb::Codec codec : CodecsOf(pb::STREAM_KIND_DISPARITY)) {
    const pb::StreamItem item = EncodeAs(
        {.codec = codec, .confidence = true, .reasons = true, .max_width_px = 20}, Shared(map));
    // 61 / 20 is more than 3, so each fourth pixel: 0, 4 ... 60 and 0, 4 ... 16.
    EXPECT_EQ(4u, item.header().step());
    ASSERT_EQ(16u, item.header().width());
    ASSERT_EQ(5u, item.header().height());
    EXPECT_EQ(16u * 5 * 2, item.header().raw_bytes());
    EXPECT_EQ(1.0 / 16, item.header().value_scale());
    EXPECT_EQ(-3, item.header().value_offset());
    EXPECT_EQ(600, item.header().geometry().focal_px());
    const std::vector<uint16_t> disparity = UnpackDisparity(item);
    ASSERT_EQ(80u, disparity.size());
    for (int y = 0; y < 5; ++y) {
      for (int x = 0; x < 16; ++x) {
        EXPECT_EQ(map.disparity.Row(4 * y)[4 * x], disparity[y * 16 + x]) << x << " " << y;
      }
    }
    if (codec != pb::CODEC_RAW) continue;
    ASSERT_EQ(80u, item.reasons().size());
    EXPECT_EQ(map.confidence.Row(4)[8], static_cast<uint8_t>(item.confidence()[16 + 2]));
    EXPECT_EQ(map.reason.Row(16)[60], static_cast<uint8_t>(item.reasons()[79]));
  }
}

TEST_F(FrameEncoderTest, ReducedDepthKeepsItsValues) {
  DepthMap map;
  map.depth_m = Image<float>(pool_, 4, 2);
  const float depth[] = {0.5F, 9, 2, 9, 9, 9, 9, 9};
  std::memcpy(map.depth_m.Row(0), depth, sizeof depth);
  const pb::StreamItem raw = EncodeAs({.codec = pb::CODEC_RAW, .max_width_px = 2}, Shared(map));
  const float half[] = {0.5F, 2};
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(half), sizeof half), raw.payload());
  const pb::StreamItem rvl = EncodeAs({.codec = pb::CODEC_RVL, .max_width_px = 2}, Shared(map));
  EXPECT_EQ((std::vector<uint16_t>{5000, 20000}), UnpackDisparity(rvl));
  EXPECT_DOUBLE_EQ(1e-4, rvl.header().value_scale());
}

TEST_F(FrameEncoderTest, AReducedPictureHasTheMeanOfItsPixels) {
  GreyImage grey(pool_, 5, 3);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 5; ++x) grey.Row(y)[x] = static_cast<uint8_t>(10 * x + y);
  }
  const pb::StreamItem item = EncodeAs({.codec = pb::CODEC_RAW, .max_width_px = 3}, Shared(grey));
  EXPECT_EQ(2u, item.header().step());
  EXPECT_EQ(3u, item.header().width());
  EXPECT_EQ(2u, item.header().height());
  // (0 + 10 + 1 + 11) / 4 = 5.5, rounded up; the last column and row stand for fewer.
  EXPECT_EQ(std::string({6, 26, 41, 7, 27, 42}), item.payload());

  ColorImage colour(pool_, 2, 1);
  colour.Row(0)[0] = {0, 100, 255};
  colour.Row(0)[1] = {10, 200, 255};
  EXPECT_EQ("\x05\x96\xff",
            EncodeAs({.codec = pb::CODEC_RAW, .max_width_px = 1}, Shared(colour)).payload());
  const pb::StreamItem jpeg =
      EncodeAs({.codec = pb::CODEC_JPEG, .jpeg_quality = 90, .max_width_px = 1}, Shared(colour));
  EXPECT_EQ(1u, jpeg.header().width());
}

TEST_F(FrameEncoderTest, WhatIsSmallEnoughIsNotReduced) {
  for (const uint32_t max_width_px : {0u, 61u, 4'000'000'000u}) {
    const pb::StreamItem item = EncodeAs({.codec = pb::CODEC_RVL, .max_width_px = max_width_px},
                                         Shared(test::MapOf(61, 17, 3)));
    EXPECT_EQ(1u, item.header().step());
    EXPECT_EQ(61u, item.header().width());
  }
}

TEST_F(FrameEncoderTest, CameraFramesAndPairsAreGreyPictures) {
  Frame frame;
  frame.image = GreyImage(pool_, 8, 4);
  frame.image.Fill(77);
  EXPECT_EQ(std::string(32, 77), EncodeAs({.codec = pb::CODEC_RAW}, Shared(frame)).payload());
  StereoFrame pair;
  pair.left = std::make_shared<const Frame>(frame);
  const pb::StreamItem item = EncodeAs({.codec = pb::CODEC_RAW}, Shared(pair));
  EXPECT_EQ(pb::STREAM_KIND_GREY_PICTURE, item.header().kind());
  EXPECT_EQ(std::string(32, 77), item.payload());
}

TEST_F(FrameEncoderTest, NumbersTextsListsAndTablesAreValues) {
  EXPECT_EQ(0.25, EncodeAs({}, Value(0.25)).value().double_value());
  EXPECT_TRUE(EncodeAs({}, Value(true)).value().bool_value());
  EXPECT_EQ("ok", EncodeAs({}, Value(std::string("ok"))).value().string_value());
  Table table{.columns = {"name", "n"}, .rows = {{Value(std::string("a")), Value(int64_t{3})}}};
  const pb::StreamItem item = EncodeAs({}, Shared(table));
  EXPECT_EQ(pb::STREAM_KIND_VALUE, item.header().kind());
  EXPECT_EQ("n", item.value().table_value().columns(1));
  EXPECT_EQ(3, item.value().table_value().rows(0).cells(1).int_value());
}

TEST_F(FrameEncoderTest, TheHeaderTellsTheJourneyOfTheFrame) {
  clock_.Advance(std::chrono::nanoseconds(0));
  const pb::FrameHeader header =
      EncodeAs({.codec = pb::CODEC_RVL}, Shared(test::MapOf(8, 8, 0))).header();
  EXPECT_EQ(12u, header.frame_number());
  EXPECT_EQ(112u, header.source_frame_number());
  EXPECT_EQ(7u, header.sequence_revision());
  EXPECT_EQ(1000, header.capture_ns());
  EXPECT_GT(header.capture_time().seconds(), 0);
  ASSERT_EQ(4, header.timing_size());  // "match" was not over yet
  EXPECT_EQ("arrival", header.timing(0).stage());
  EXPECT_EQ(1000, header.timing(0).start_ns());
  EXPECT_EQ(2000, header.timing(0).end_ns());
  EXPECT_EQ("pair", header.timing(1).stage());
  EXPECT_EQ("source", header.timing(2).stage());
  EXPECT_EQ(3100, header.timing(2).start_ns());
  EXPECT_EQ("encode", header.timing(3).stage());
}

TEST_F(FrameEncoderTest, ACodecThatDoesNotFitIsRefused) {
  const auto encoded = encoder_.Encode(Publish(Shared(test::MapOf(8, 8, 0))), 1,
                                       {.codec = pb::CODEC_JPEG, .jpeg_quality = 80});
  EXPECT_EQ(StatusCode::kFailedPrecondition, encoded->status.code());
  EXPECT_TRUE(encoded->message.empty());
  const auto empty = encoder_.Encode(Publish(Shared(GreyImage())), 1,
                                     {.codec = pb::CODEC_JPEG, .jpeg_quality = 80});
  EXPECT_EQ(StatusCode::kInvalidArgument, empty->status.code());
}

TEST(Encoding, FillsInTheServersChoices) {
  const Encoding disparity = Resolve(pb::STREAM_KIND_DISPARITY,
                                     {.confidence = true, .jpeg_quality = 50, .max_width_px = 9})
                                 .value();
  EXPECT_EQ((Encoding{.codec = pb::CODEC_RVL, .confidence = true, .max_width_px = 9}), disparity);
  const Encoding picture =
      Resolve(pb::STREAM_KIND_GREY_PICTURE, {.confidence = true, .reasons = true}).value();
  EXPECT_EQ((Encoding{.codec = pb::CODEC_JPEG, .jpeg_quality = 80}), picture);
  EXPECT_EQ(Encoding(), Resolve(pb::STREAM_KIND_VALUE,
                                {.codec = pb::CODEC_JPEG, .reasons = true, .max_width_px = 9})
                            .value());
}

TEST(Encoding, RefusesWhatDoesNotFitAndSaysWhatDoes) {
  const auto picture = Resolve(pb::STREAM_KIND_GREY_PICTURE, {.codec = pb::CODEC_RVL});
  EXPECT_EQ(StatusCode::kInvalidArgument, picture.error().code());
  EXPECT_THAT(picture.error().message(), HasSubstr("CODEC_JPEG, CODEC_RAW, not as CODEC_RVL"));
  EXPECT_FALSE(Resolve(pb::STREAM_KIND_DISPARITY, {.codec = pb::CODEC_JPEG}));
  EXPECT_FALSE(
      Resolve(pb::STREAM_KIND_GREY_PICTURE, {.codec = pb::CODEC_JPEG, .jpeg_quality = 101}));
  EXPECT_FALSE(Resolve(KindOf("stereo_rig"), {.codec = pb::CODEC_RAW}));
}

}  // namespace
}  // namespace vs
