#include "engine/image/rectification.h"

#include "engine/base/check.h"
#include "engine/image/resample.h"

namespace vs {

GreyImage Rectified(const GreyImage& raw, const Rectification& rectification,
                    const RemapTable& table, BufferPool& pool) {
  VS_CHECK(raw.width() == rectification.raw_width && raw.height() == rectification.raw_height);
  GreyImage rectified(pool, table.width, table.height);
  Remap(rectification.half_size ? Halved(raw, pool) : raw, table, rectification.interpolation,
        &rectified);
  return rectified;
}

}  // namespace vs
