#include "proto/wire/rvl.h"

#include <algorithm>
#include <limits>

#include "proto/wire/nibbles.h"

namespace vs::wire {
namespace {

// An image read as one line of pixels, although its rows may lie apart.
template <class T>
class Line {
 public:
  Line(const T* pixels, size_t width, size_t height, size_t stride_bytes)
      : pixels_(pixels), row_size_(width), size_(width * height), stride_bytes_(stride_bytes) {
    if (stride_bytes == width * sizeof(T)) row_size_ = size_;
  }

  size_t size() const { return size_; }

  // From pixel `index` on: those that lie in memory one after the other.
  std::span<const T> From(size_t index) const {
    const auto* row = reinterpret_cast<const uint8_t*>(pixels_) + index / row_size_ * stride_bytes_;
    return {reinterpret_cast<const T*>(row) + index % row_size_, row_size_ - index % row_size_};
  }

  // How many pixels from `index` on are zero, or how many are not.
  size_t RunLength(size_t index, bool zero) const {
    const size_t begin = index;
    while (index < size_) {
      const std::span<const T> pixels = From(index);
      const auto end = std::find_if(pixels.begin(), pixels.end(),
                                    [zero](T pixel) { return (pixel == 0) != zero; });
      index += end - pixels.begin();
      if (end != pixels.end()) break;
    }
    return index - begin;
  }

 private:
  const T* pixels_;
  size_t row_size_;
  size_t size_;
  size_t stride_bytes_;
};

// The difference with its sign in the lowest bit, so that small differences are small numbers.
uint32_t Zigzag(int32_t difference) {
  return static_cast<uint32_t>(difference) << 1 ^ static_cast<uint32_t>(difference >> 31);
}

// Returns the last value, from which the next one differs.
template <class T>
int32_t PutValues(std::span<const T> values, int32_t previous, NibbleWriter* writer) {
  size_t i = 0;
  for (; i + 1 < values.size(); i += 2) {
    writer->PutTwo(Zigzag(values[i] - previous), Zigzag(values[i + 1] - values[i]));
    previous = values[i + 1];
  }
  if (i < values.size()) {
    writer->Put(Zigzag(values[i] - previous));
    previous = values[i];
  }
  return previous;
}

template <class T>
size_t Encode(const Line<T>& line, std::span<uint8_t> packed) {
  if (line.size() == 0 || packed.size() < RvlBound(line.size())) return 0;
  NibbleWriter writer(packed.data());
  int32_t previous = 0;
  for (size_t index = 0; index < line.size();) {
    const size_t zeroes = line.RunLength(index, true);
    index += zeroes;
    size_t values = line.RunLength(index, false);
    writer.Put(static_cast<uint32_t>(zeroes));
    writer.Put(static_cast<uint32_t>(values));
    while (values > 0) {
      const std::span<const T> row = line.From(index);
      const std::span<const T> part = row.first(std::min(row.size(), values));
      previous = PutValues(part, previous, &writer);
      values -= part.size();
      index += part.size();
    }
  }
  return writer.Finish() - packed.data();
}

template <class T>
DecodeError Decode(std::span<const uint8_t> packed, std::span<T> pixels) {
  if (packed.size() % 4 != 0) return DecodeError::kTruncated;
  NibbleReader reader(packed.data(), packed.size());
  uint32_t previous = 0;
  for (size_t index = 0; index < pixels.size();) {
    uint32_t zeroes = 0;
    uint32_t values = 0;
    if (!reader.Get(&zeroes) || !reader.Get(&values)) return DecodeError::kTruncated;
    const size_t left = pixels.size() - index;
    if (zeroes > left || values > left - zeroes || (zeroes == 0 && values == 0)) {
      return DecodeError::kBadRun;
    }
    std::fill_n(pixels.begin() + index, zeroes, T{0});
    index += zeroes;
    for (T& pixel : pixels.subspan(index, values)) {
      uint32_t zigzag = 0;
      if (!reader.Get(&zigzag)) return DecodeError::kTruncated;
      previous += zigzag >> 1 ^ (~(zigzag & 1) + 1);
      if (previous == 0 || previous > std::numeric_limits<T>::max()) {
        return DecodeError::kValueOutOfRange;
      }
      pixel = static_cast<T>(previous);
    }
    index += values;
  }
  return reader.AtEnd() ? DecodeError::kNone : DecodeError::kTrailingBytes;
}

}  // namespace

size_t RvlBound(size_t pixels) {
  // A value takes at most 6 nibbles (17 bits) and pays for the length of its run; only a run of
  // more than 32767 can take more, by at most 6 nibbles. The rest is for the first run, the filling
  // of the last word and the writer's look-ahead.
  return 3 * pixels + pixels / 32768 * 3 + 24;
}

size_t EncodeRvl(const uint16_t* pixels, size_t width, size_t height, size_t stride_bytes,
                 std::span<uint8_t> packed) {
  return Encode(Line(pixels, width, height, stride_bytes), packed);
}

size_t EncodeRvl(const uint8_t* pixels, size_t width, size_t height, size_t stride_bytes,
                 std::span<uint8_t> packed) {
  return Encode(Line(pixels, width, height, stride_bytes), packed);
}

DecodeError DecodeRvl(std::span<const uint8_t> packed, std::span<uint16_t> pixels) {
  return Decode(packed, pixels);
}

DecodeError DecodeRvl(std::span<const uint8_t> packed, std::span<uint8_t> pixels) {
  return Decode(packed, pixels);
}

}  // namespace vs::wire
