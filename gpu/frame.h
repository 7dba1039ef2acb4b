#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/stereo/sgm_settings.h"

namespace vs::gpu {

// Two of something, one for each view.
inline constexpr int kLeft = 0;
inline constexpr int kRight = 1;

// What is done to the greys of a pair (condition_pair.h), decided on the device from the pictures.
struct Conditioning {
  uint8_t right_greys[256];  // what each grey of the right picture becomes
  uint16_t side;             // weights of the blur, of 256; centre 256: none
  uint16_t centre;
};

// What was counted of both pictures to decide that.
struct GreyCounts {
  static constexpr int kNoiseBins = 1024;
  uint32_t noise[2][kNoiseBins];  // blocks by mask response, and how many there are in all
  uint32_t noise_blocks[2];
  uint32_t greys[2][256];
};

// A map under way: what a DisparityMap holds, dense, on the device.
struct DeviceMap {
  uint16_t* disparity;
  uint8_t* confidence;
  uint8_t* reason;
};

// Everything that kernels know of a frame: what is wanted, and where in the device's memory things
// are. All pictures are dense: pixel (x, y) at y * width + x. Plain data, given to kernels by
// value.
struct Frame {
  SgmSettings settings;
  int width = 0;
  int height = 0;
  // A volume has `pitch` bytes for each pixel: num_disparities rounded up to a multiple of 8; cell
  // (x, y, i) at (y * width + x) * pitch + i. The last few of a pixel mean nothing.
  int pitch = 0;

  const uint8_t* input[2] = {};  // as uploaded
  GreyCounts* counts = nullptr;  // cleared before each frame
  Conditioning* conditioning = nullptr;
  uint8_t* across[2] = {};  // half way through the blur
  uint8_t* grey[2] = {};    // conditioned: what costs, edges and reasons see
  // What pixels are compared by (pixel_cost.h), by view:
  //   24 bits of census: the code in the low bytes, J in the high one
  //   48 and 62 bits: low and high halves of the code; `coarse` holds J
  //   grey costs: I, then the least and greatest of I and its half-way values, a byte each
  uint32_t* code[2] = {};
  uint32_t* code_high[2] = {};
  uint8_t* coarse[2] = {};

  uint8_t* costs = nullptr;        // volume: what paths run over
  uint8_t* other_costs = nullptr;  // volume: before a window or smoothing; null if neither
  // Volumes of path costs summed over two opposite directions each.
  static constexpr int kMaxSums = 4;
  uint8_t* sums[kMaxSums] = {};
  int sum_count = 0;
  const uint8_t* p2 = nullptr;  // by grey step, 256 entries (path_cost.h)

  // By pixel, as WinnerRow has them: i, Z, N, S at i - 1 and i + 1.
  uint8_t* winner_index = nullptr;
  uint8_t* winner_best = nullptr;
  uint8_t* winner_second = nullptr;
  uint8_t* winner_before = nullptr;
  uint8_t* winner_after = nullptr;
  uint8_t* right_index = nullptr;  // by pixel of the right view

  DeviceMap map[2] = {};       // filters read one and write the other
  uint32_t* label = nullptr;   // speckle filter: by pixel
  uint32_t* region = nullptr;  // pixels of the region, by its label

  constexpr int Pixels() const { return width * height; }
};

// The device memory of frames of one size and one kind of settings.
class FrameMemory {
 public:
  // `base` (256-byte aligned) may be null: then only the size counts.
  // INVALID settings are the caller's bug.
  FrameMemory(const SgmSettings& settings, int width, int height, std::byte* base);

  // Whose pointers lie in [base, base + Bytes()).
  const Frame& frame() const { return frame_; }
  size_t Bytes() const { return used_; }

 private:
  template <class T>
  void Take(size_t count, T** to);

  Frame frame_;
  std::byte* base_;
  size_t used_ = 0;
};

}  // namespace vs::gpu
