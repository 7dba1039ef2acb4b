#include "engine/image/ply.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "engine/base/str.h"

namespace vs {

static_assert(std::endian::native == std::endian::little);

std::vector<uint8_t> EncodePly(const PointCloud& cloud) {
  const int width = cloud.z_m.width();
  const int height = cloud.z_m.height();
  size_t points = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) points += std::isnan(cloud.z_m.Row(y)[x]) ? 0 : 1;
  }
  const std::string header =
      Str("ply\nformat binary_little_endian 1.0\n"
          "comment metres; x right, y down, z away from the left camera\nelement vertex ",
          points, "\nproperty float x\nproperty float y\nproperty float z\nend_header\n");
  std::vector<uint8_t> file(header.size() + points * 3 * sizeof(float));
  std::memcpy(file.data(), header.data(), header.size());
  uint8_t* to = file.data() + header.size();
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float point[] = {cloud.x_m.Row(y)[x], cloud.y_m.Row(y)[x], cloud.z_m.Row(y)[x]};
      if (std::isnan(point[2])) continue;
      std::memcpy(to, point, sizeof point);
      to += sizeof point;
    }
  }
  return file;
}

}  // namespace vs
