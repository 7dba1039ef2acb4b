#include "engine/image/ply.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "engine/image/buffer.h"

namespace vs {
namespace {

TEST(Ply, HoldsTheKnownPointsRowByRow) {
  BufferPool pool;
  PointCloud cloud{
      Image<float>(pool, 2, 2), Image<float>(pool, 2, 2), Image<float>(pool, 2, 2), {}};
  for (int k = 0; k < 4; ++k) {
    const float z = k == 1 ? std::nanf("") : static_cast<float>(k) + 0.5F;
    cloud.x_m.Row(k / 2)[k % 2] = z * 10;
    cloud.y_m.Row(k / 2)[k % 2] = z * -2;
    cloud.z_m.Row(k / 2)[k % 2] = z;
  }
  const std::vector<uint8_t> file = EncodePly(cloud);
  const std::string text(file.begin(), file.end());
  const size_t end = text.find("end_header\n") + 11;
  EXPECT_EQ(text.substr(0, end),
            "ply\nformat binary_little_endian 1.0\n"
            "comment metres; x right, y down, z away from the left camera\nelement vertex 3\n"
            "property float x\nproperty float y\nproperty float z\nend_header\n");
  const float expected[] = {5, -1, 0.5F, 25, -5, 2.5F, 35, -7, 3.5F};
  EXPECT_EQ(text.substr(end),
            std::string(reinterpret_cast<const char*>(expected), sizeof expected));
}

}  // namespace
}  // namespace vs
