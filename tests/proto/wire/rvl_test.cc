#include "proto/wire/rvl.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/proto/wire/images.h"

namespace vs::wire {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Le;

template <class T>
void ExpectRoundTrip(const std::vector<T>& pixels) {
  const std::vector<uint8_t> packed = Packed(pixels);
  std::vector<T> unpacked(pixels.size(), T{77});
  ASSERT_EQ(DecodeError::kNone, DecodeRvl(packed, unpacked));
  EXPECT_EQ(pixels, unpacked);
}

TEST(Rvl, WritesTheNibblesThatThePaperDescribes) {
  // No zeroes (0), two values (2), +5 (zigzag 10: 2 and more, 1), -1 (zigzag 1): nibbles 0 2 A 1 1.
  EXPECT_THAT(Packed<uint16_t>({5, 4}), ElementsAre(0x00, 0x10, 0xA1, 0x02));
}

TEST(Rvl, PacksAnImageWithoutPixelsIntoNothing) {
  EXPECT_TRUE(Packed<uint16_t>({}).empty());
  EXPECT_EQ(DecodeError::kNone, DecodeRvl({}, std::span<uint16_t>()));
}

TEST(Rvl, BringsBackRandomImagesOfEverySize) {
  std::mt19937 random(1);
  for (size_t size = 1; size < 300; ++size) {
    std::vector<uint16_t> pixels(size);
    const uint32_t hole_percent = random() % 101;
    const uint32_t largest = 1 + random() % 65535;
    for (uint16_t& pixel : pixels) {
      pixel = random() % 100 < hole_percent ? 0 : static_cast<uint16_t>(1 + random() % largest);
    }
    ExpectRoundTrip(pixels);
  }
}

TEST(Rvl, BringsBackTheLargestDifferencesAndStaysInItsBound) {
  std::vector<uint16_t> pixels(100000);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 2 == 0 ? 1 : 65535;
  ExpectRoundTrip(pixels);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 2 == 0 ? 0 : 65535;
  ExpectRoundTrip(pixels);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = i % 32769 == 0 ? 0 : 1 + (i % 2) * 65534;
  ExpectRoundTrip(pixels);
}

TEST(Rvl, BringsBackRunsLongerThanAnyTable) {
  std::vector<uint16_t> pixels(3000000);
  pixels[2500000] = 9;
  ExpectRoundTrip(pixels);
  ExpectRoundTrip(std::vector<uint16_t>(3000000, 65535));
}

TEST(Rvl, BringsBackBytesOfAReasonPlane) {
  std::vector<uint8_t> reasons(5000);
  for (size_t i = 0; i < reasons.size(); ++i) reasons[i] = i / 7 % 12;
  ExpectRoundTrip(reasons);
  for (size_t i = 0; i < reasons.size(); ++i) reasons[i] = i % 2 == 0 ? 1 : 255;
  ExpectRoundTrip(reasons);
}

TEST(Rvl, PacksTheSameBytesWhenRowsLieApart) {
  const std::vector<uint16_t> pixels = DisparityLikeImage(100, 30, 3);
  std::vector<uint16_t> apart(130UL * 30, 4242);
  for (size_t y = 0; y < 30; ++y) {
    std::copy_n(&pixels[y * 100], 100, &apart[y * 130]);
  }
  std::vector<uint8_t> packed(RvlBound(pixels.size()));
  packed.resize(EncodeRvl(apart.data(), 100, 30, 130 * sizeof(uint16_t), packed));
  EXPECT_EQ(Packed(pixels), packed);
}

TEST(Rvl, WritesNothingWhenTheRoomIsTooSmall) {
  const std::vector<uint16_t> pixels(10, 500);
  std::vector<uint8_t> packed(RvlBound(10) - 1, 0xEE);
  EXPECT_EQ(0U, EncodeRvl(pixels.data(), 5, 2, 10, packed));
  EXPECT_THAT(packed, Each(0xEE));
}

TEST(Rvl, MakesADisparityMapSeveralTimesSmaller) {
  const std::vector<uint16_t> pixels = DisparityLikeImage(648, 482, 5);
  EXPECT_THAT(Packed(pixels).size(), Le(648 * 482 * 2 / 3));
  ExpectRoundTrip(pixels);
}

}  // namespace
}  // namespace vs::wire
