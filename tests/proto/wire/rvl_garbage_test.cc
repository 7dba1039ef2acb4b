// Bytes from a broken or hostile sender. The address sanitizer watches the buffers' ends, which is
// why they are exactly as long as they need to be.
#include <gtest/gtest.h>

#include "proto/wire/rvl.h"
#include "tests/proto/wire/images.h"

namespace vs::wire {
namespace {

// A copy in memory of exactly its size.
DecodeError DecodeExactly(const std::vector<uint8_t>& packed, size_t pixels) {
  const std::vector<uint8_t> exact(packed.begin(), packed.end());
  std::vector<uint16_t> unpacked(pixels);
  return DecodeRvl(exact, unpacked);
}

TEST(RvlGarbage, EveryTruncationIsAnError) {
  const std::vector<uint16_t> pixels = DisparityLikeImage(60, 20, 7);
  std::vector<uint8_t> packed = Packed(pixels);
  while (!packed.empty()) {
    packed.pop_back();
    EXPECT_EQ(DecodeError::kTruncated, DecodeExactly(packed, pixels.size())) << packed.size();
  }
}

TEST(RvlGarbage, AnotherImageSizeIsAnError) {
  const std::vector<uint8_t> packed = Packed(DisparityLikeImage(60, 20, 7));
  EXPECT_NE(DecodeError::kNone, DecodeExactly(packed, 60UL * 20 - 1));
  EXPECT_NE(DecodeError::kNone, DecodeExactly(packed, 60UL * 20 + 1));
  EXPECT_EQ(DecodeError::kTrailingBytes, DecodeExactly(packed, 0));
}

TEST(RvlGarbage, FlippedBitsNeverLeaveTheBuffers) {
  const std::vector<uint8_t> packed = Packed(DisparityLikeImage(60, 20, 7));
  size_t refused = 0;
  for (size_t bit = 0; bit < packed.size() * 8; ++bit) {
    std::vector<uint8_t> flipped = packed;
    flipped[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
    if (DecodeExactly(flipped, 60UL * 20) != DecodeError::kNone) ++refused;
  }
  // Most flips change where numbers end; those that only change a difference cannot be seen.
  EXPECT_GT(refused, packed.size() * 8 / 4);
}

TEST(RvlGarbage, RandomBytesNeverLeaveTheBuffers) {
  std::mt19937 random(11);
  for (int round = 0; round < 20000; ++round) {
    std::vector<uint8_t> packed(random() % 16 * 4 + random() % 2);
    const uint32_t mask = round % 2 == 0 ? 0xFF : 0x33;  // the latter: plenty of short numbers
    for (uint8_t& byte : packed) byte = static_cast<uint8_t>(random() & mask);
    std::vector<uint16_t> wide(random() % 200);
    std::vector<uint8_t> narrow(wide.size());
    const DecodeError of_wide = DecodeRvl(packed, wide);
    const DecodeError of_narrow = DecodeRvl(packed, narrow);
    if (of_narrow == DecodeError::kNone) {
      EXPECT_EQ(DecodeError::kNone, of_wide);
    }
  }
}

TEST(RvlGarbage, AValueTooLargeForAByteIsAnError) {
  std::vector<uint8_t> narrow(2);
  EXPECT_EQ(DecodeError::kValueOutOfRange, DecodeRvl(Packed<uint16_t>({255, 256}), narrow));
  EXPECT_EQ(DecodeError::kNone, DecodeRvl(Packed<uint16_t>({254, 255}), narrow));
}

}  // namespace
}  // namespace vs::wire
