#include "server/streams/jpeg_encoder.h"

#include <turbojpeg.h>

#include "engine/base/str.h"

namespace vs {

void JpegEncoder::Destroy::operator()(void* handle) const { tjDestroy(handle); }

JpegEncoder::JpegEncoder() : handle_(tjInitCompress()) {}

Status JpegEncoder::Encode(const GreyImage& image, int quality, std::vector<uint8_t>* jpeg) {
  return Compress(image.Row(0), image.width(), image.height(), image.stride_bytes(), TJPF_GRAY,
                  TJSAMP_GRAY, quality, jpeg);
}

Status JpegEncoder::Encode(const ColorImage& image, int quality, std::vector<uint8_t>* jpeg) {
  return Compress(image.Row(0), image.width(), image.height(), image.stride_bytes(), TJPF_RGB,
                  TJSAMP_420, quality, jpeg);
}

Status JpegEncoder::Compress(const void* pixels, int width, int height, size_t stride_bytes,
                             int pixel_format, int subsampling, int quality,
                             std::vector<uint8_t>* jpeg) {
  if (width == 0 || height == 0) return InvalidArgument("an empty picture cannot be a JPEG");
  jpeg->resize(tjBufSize(width, height, subsampling));
  unsigned char* out = jpeg->data();
  unsigned long size = jpeg->size();  // NOLINT(google-runtime-int): the library's type
  if (tjCompress2(handle_.get(), static_cast<const unsigned char*>(pixels), width,
                  static_cast<int>(stride_bytes), height, pixel_format, &out, &size, subsampling,
                  quality, TJFLAG_NOREALLOC) != 0) {
    return Internal(Str("the picture cannot be packed as JPEG: ", tjGetErrorStr2(handle_.get())));
  }
  jpeg->resize(size);
  return Status();
}

}  // namespace vs
