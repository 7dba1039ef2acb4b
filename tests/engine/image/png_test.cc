#include "engine/image/png.h"

#include <gtest/gtest.h>

#include <cstring>

namespace vs {
namespace {

TEST(EncodePng, RefusesAnEmptyPicture) {
  EXPECT_EQ(EncodePng(GreyImage()).error().code(), StatusCode::kInvalidArgument);
}

TEST(EncodePng, WritesOnlyThePictureOfAPaddedBuffer) {
  BufferPool pool;
  const Buffer buffer = pool.Acquire(1000);
  std::memset(buffer.data, 7, 1000);
  const GreyImage padded(buffer, 30, 10, 100);
  GreyImage tight(pool, 30, 10);
  tight.Fill(7);
  const auto file = EncodePng(padded).value();
  EXPECT_EQ(file, EncodePng(tight).value());
  EXPECT_EQ(std::memcmp(file.data(), "\x89PNG\r\n\x1a\n", 8), 0);
}

}  // namespace
}  // namespace vs
