#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "engine/base/check.h"
#include "engine/image/buffer.h"

namespace vs {

struct Rgb {
  uint8_t r, g, b;

  bool operator==(const Rgb&) const = default;
};

// A rectangle of pixels in row-major order: a typed view over a Buffer. Pixel (x, y) is
// `Row(y)[x]`. Copying an Image shares its pixels, so it is cheap; once published (behind a
// shared_ptr to const) nobody writes them any more.
template <class T>
class Image {
 public:
  Image() = default;
  // A view over bytes that exist already, for example a camera's buffer.
  Image(Buffer buffer, int width, int height, size_t stride_bytes)
      : buffer_(std::move(buffer)), width_(width), height_(height), stride_bytes_(stride_bytes) {
    VS_CHECK(width >= 0 && height >= 0 && stride_bytes >= static_cast<size_t>(width) * sizeof(T));
    VS_CHECK(buffer_.size_bytes >= static_cast<size_t>(height) * stride_bytes);
  }
  // Memory for width x height pixels, not cleared; rows follow each other without a gap.
  Image(BufferPool& pool, int width, int height)
      : Image(pool.Acquire(static_cast<size_t>(width) * height * sizeof(T)), width, height,
              static_cast<size_t>(width) * sizeof(T)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  size_t stride_bytes() const { return stride_bytes_; }
  bool empty() const { return width_ == 0 || height_ == 0; }
  const Buffer& buffer() const { return buffer_; }

  const T* Row(int y) const {
    return reinterpret_cast<const T*>(buffer_.data + static_cast<size_t>(y) * stride_bytes_);
  }
  T* Row(int y) {
    return reinterpret_cast<T*>(buffer_.data + static_cast<size_t>(y) * stride_bytes_);
  }

  void Fill(T value) {
    for (int y = 0; y < height_; ++y) {
      T* row = Row(y);
      for (int x = 0; x < width_; ++x) row[x] = value;
    }
  }

  template <class U>
  bool SameSizeAs(const Image<U>& other) const {
    return width_ == other.width() && height_ == other.height();
  }

 private:
  Buffer buffer_;
  int width_ = 0;
  int height_ = 0;
  size_t stride_bytes_ = 0;
};

using GreyImage = Image<uint8_t>;
using ColorImage = Image<Rgb>;

}  // namespace vs
