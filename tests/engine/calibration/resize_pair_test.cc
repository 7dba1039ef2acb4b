#include "engine/calibration/resize_pair.h"

#include <gtest/gtest.h>

#include <memory>

namespace vs {
namespace {

class ResizePairTest : public testing::Test {
 protected:
  void SetUp() override {
    auto frame = std::make_shared<Frame>();
    frame->image = GreyImage(pool_, 64, 48);
    for (int y = 0; y < 48; ++y) {
      for (int x = 0; x < 64; ++x) frame->image.Row(y)[x] = static_cast<uint8_t>(4 * x);
    }
    frame->number = 5;
    pair_.left = frame;
    pair_.right = frame;
    pair_.geometry = RectifiedGeometry{
        .width = 64, .height = 48, .focal_px = 80, .baseline_m = 0.1, .cx_px = 31.5, .cy_px = 23.5};
    pair_.truth = std::make_shared<StereoTruth>();
  }
  BufferPool pool_;
  Recycler<Frame> frames_;
  StereoFrame pair_;
};

TEST_F(ResizePairTest, HalvingAveragesTwoByTwoPixelsAndScalesTheGeometry) {
  const auto half = ResizePair(pair_, 0.5, frames_, pool_);
  ASSERT_TRUE(half.has_value());
  EXPECT_EQ(half->left->image.width(), 32);
  EXPECT_EQ(half->left->image.height(), 24);
  EXPECT_EQ(half->left->image.Row(3)[10], 82);  // of 80 and 84
  EXPECT_EQ(half->left->number, 5u);
  EXPECT_EQ(half->geometry->focal_px, 40);
  EXPECT_EQ(half->geometry->cx_px, 15.5);
  EXPECT_EQ(half->truth, nullptr);
}

TEST_F(ResizePairTest, RefusesImpossibleSizes) {
  EXPECT_FALSE(ResizePair(pair_, 0.2, frames_, pool_).has_value()) << "13 x 10 px";
  EXPECT_FALSE(ResizePair(pair_, 0, frames_, pool_).has_value());
  EXPECT_FALSE(ResizePair(pair_, 5, frames_, pool_).has_value());
  pair_.right = nullptr;
  EXPECT_EQ(ResizePair(pair_, 0.5, frames_, pool_).error().code(), StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace vs
