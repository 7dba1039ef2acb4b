#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <new>
#include <random>
#include <vector>

#include "engine/image/buffer.h"
#include "engine/image/image.h"
#include "gpu/frame.h"

namespace vs::gpu {

// A frame in poisoned host memory, for kernels that are run by the emulation.
class HostFrame {
 public:
  HostFrame(const SgmSettings& settings, int width, int height)
      : HostFrame(StereoPlan{.settings = settings}, width, height) {}
  // Of raw pictures of this size. Only what is kept is filled in.
  HostFrame(const StereoPlan& plan, int raw_width, int raw_height)
      : bytes_(FrameMemory(plan, raw_width, raw_height, nullptr).Bytes()),
        memory_(bytes_ + kAlignment) {
    std::memset(memory_.data(), 0xa5, memory_.size());
    const auto address = reinterpret_cast<uintptr_t>(memory_.data());
    const size_t skip = (kAlignment - address % kAlignment) % kAlignment;
    frame_ = FrameMemory(plan, raw_width, raw_height, memory_.data() + skip).frame();
    FillKept(plan, frame_);
  }

  Frame& operator*() { return frame_; }
  Frame* operator->() { return &frame_; }

 private:
  static constexpr size_t kAlignment = 256;
  size_t bytes_;
  std::vector<std::byte> memory_;
  Frame frame_;
};

// Blocks of random greys, so that there are edges and flat parts, and a little noise.
inline GreyImage RandomGreys(int width, int height, uint32_t seed, BufferPool& pool) {
  GreyImage image(pool, width, height);
  std::minstd_rand random(seed + 1);
  std::vector<uint8_t> blocks(static_cast<size_t>(width / 5 + 1) * (height / 4 + 1));
  for (uint8_t& block : blocks) block = static_cast<uint8_t>(random() >> 8);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const int grey = blocks[static_cast<size_t>(y / 4) * (width / 5 + 1) + x / 5] +
                       static_cast<int>((random() >> 8) % 9) - 4;
      image.Row(y)[x] = static_cast<uint8_t>(grey < 0 ? 0 : grey > 255 ? 255 : grey);
    }
  }
  return image;
}

inline void CopyRows(const GreyImage& from, uint8_t* to) {
  for (int y = 0; y < from.height(); ++y) {
    std::memcpy(to + static_cast<size_t>(y) * from.width(), from.Row(y),
                static_cast<size_t>(from.width()));
  }
}

}  // namespace vs::gpu
