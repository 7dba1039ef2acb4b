#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/image/remap.h"
#include "engine/stereo/depth.h"
#include "engine/stereo/sgm_settings.h"
#include "engine/stereo/stereo_plan.h"

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

  // As uploaded, raw_width x raw_height; without rectification these are `input`.
  uint8_t* uploaded[2] = {};
  int raw_width = 0;
  int raw_height = 0;
  uint8_t* halved[2] = {};  // null unless they are to be halved
  // Where the pixels of `input` come from (remap.h): one of both, or neither.
  const RemapTable::Source* sources[2] = {};
  const RemapTable::Position* positions[2] = {};
  Interpolation interpolation = Interpolation::kLinear;
  uint8_t* input[2] = {};        // the rectified pair
  GreyCounts* counts = nullptr;  // cleared before each frame
  Conditioning* conditioning = nullptr;
  uint8_t* across[2] = {};  // horizontal gradients, if these are compared
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

  DepthRule depth_rule;
  float* depth_m = nullptr;    // by pixel; null if not wanted
  DeviceMap map[2] = {};       // filters read one and write the other
  uint32_t* label = nullptr;   // speckle filter: by pixel
  uint32_t* region = nullptr;  // pixels of the region, by its label

  constexpr int Pixels() const { return width * height; }
  constexpr bool Rectifies() const { return input[kLeft] != uploaded[kLeft]; }
};

// The device memory of frames of one size that go by one plan, which has no region.
class FrameMemory {
 public:
  // `base` (256-byte aligned) may be null: then only the size counts.
  // Width and height of the pictures as they are uploaded. An invalid plan is the caller's bug.
  FrameMemory(const StereoPlan& plan, int raw_width, int raw_height, std::byte* base);

  // Whose pointers lie in [base, base + Bytes()).
  const Frame& frame() const { return frame_; }
  size_t Bytes() const { return used_; }
  // So many bytes at the beginning are the same for all frames: FillKept writes them.
  size_t KeptBytes() const { return kept_; }

 private:
  void TakeMap(size_t pixels, DeviceMap* map);
  template <class T>
  void Take(size_t count, T** to);

  Frame frame_;
  std::byte* base_;
  size_t used_ = 0;
  size_t kept_ = 0;
};

// Penalties and tables, into the memory of `frame`, which is the host's.
void FillKept(const StereoPlan& plan, const Frame& frame);

}  // namespace vs::gpu
