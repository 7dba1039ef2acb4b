#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "engine/base/status.h"
#include "engine/image/image.h"

namespace vs {

// Pictures as JPEG (libjpeg-turbo; colour at half resolution, as cameras do). Keeps its working
// memory from picture to picture. Not for two threads at once.
class JpegEncoder {
 public:
  JpegEncoder();

  // `quality` 1..100. `jpeg` gets the size that it needs.
  Status Encode(const GreyImage& image, int quality, std::vector<uint8_t>* jpeg);
  Status Encode(const ColorImage& image, int quality, std::vector<uint8_t>* jpeg);

 private:
  struct Destroy {
    void operator()(void* handle) const;
  };

  Status Compress(const void* pixels, int width, int height, size_t stride_bytes, int pixel_format,
                  int subsampling, int quality, std::vector<uint8_t>* jpeg);

  std::unique_ptr<void, Destroy> handle_;
};

}  // namespace vs
